#pragma once
// Chooses pixels by priority, evenly: error diffusion [FS76], as the Render Cache has it [WDP99 4.3].
#include <cstdint>
#include <span>
#include <vector>

namespace deltalux::rendering {

/// At most `count` pixels with a priority above 0, in places in proportion to it; all of them where there are no more.
std::vector<std::uint32_t> chooseByPriority(std::span<const float> priorities, int width, std::size_t count);

}  // namespace deltalux::rendering
