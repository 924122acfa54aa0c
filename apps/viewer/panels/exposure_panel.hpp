#pragma once
// Exposure, tone mapping and false colour: how the picture is shown. Nothing of it solves anything.
#include "tools.hpp"

namespace deltalux::viewer {

void exposurePanel(Controller&);
void falseColourPanel(Controller&);

}  // namespace deltalux::viewer
