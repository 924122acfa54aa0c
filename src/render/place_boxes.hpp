#pragma once
// Few boxes for many.
#include <deltalux/math.hpp>
#include <vector>

namespace deltalux::rendering {

/// At most `most` boxes that hold all of these: groups are halved, the widest first, until there are as many.
std::vector<Box> coveringBoxes(std::vector<Box> boxes, std::size_t most);

}  // namespace deltalux::rendering
