#pragma once
#include <deltalux/view.hpp>
#include <string_view>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// The view that a line of view options means: -vtv -vtl -vp -vd -vu -vh -vv, starting from rvu's defaults. Shifts and
/// clipping planes of zero are taken; others, and other projections, are InputErrors.
View parseView(std::string_view options, const SourceLine& where);

}  // namespace deltalux::io::radiance
