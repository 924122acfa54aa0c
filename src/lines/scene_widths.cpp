#include "lines/scene_widths.hpp"

#include <algorithm>
#include <cmath>

#include "lines/tuning.hpp"

namespace deltalux::lines {

SceneWidths widthsOf(const Scene& scene, const Box& box) {
  const double diagonal = box.diagonal();
  const auto least = [&](double metres, double share) {
    return std::min(metres / scene.metresPerUnit, share * diagonal);
  };
  return {diagonal > 0 ? std::exp2(0.5 * std::round(2 * std::log2(diagonal))) : 0.0,
          least(tuning::kSlotWidth, tuning::kSlotOfScene), least(tuning::kHollow, tuning::kHollowOfScene),
          least(tuning::kDimRoom, tuning::kSlotOfScene)};
}

}  // namespace deltalux::lines
