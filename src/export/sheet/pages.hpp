#pragma once
#include <deltalux/sheet.hpp>

#include "export/sheet/canvas.hpp"

namespace deltalux::exporting {

/// All pages of a sheet.
void drawSheet(Canvas&, const Sheet&);

}  // namespace deltalux::exporting
