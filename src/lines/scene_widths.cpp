#include "lines/scene_widths.hpp"

#include <algorithm>
#include <cmath>

#include "lines/tuning.hpp"

namespace deltalux::lines {

SceneWidths widthsOf(const Scene& scene, const Box& box) {
  const double diagonal = box.diagonal();
  /// [scene units]
  const auto least = [&](double metres) {
    return metres * std::min(1 / scene.metresPerUnit, diagonal / tuning::kSmallScene);
  };
  return {diagonal > 0 ? std::exp2(0.5 * std::round(2 * std::log2(diagonal))) : 0.0, least(tuning::kHollow),
          least(tuning::kRoom)};
}

}  // namespace deltalux::lines
