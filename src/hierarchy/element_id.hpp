#pragma once
#include <deltalux/ids.hpp>

namespace deltalux {

using ElementId = Id<struct ElementTag>;

}  // namespace deltalux
