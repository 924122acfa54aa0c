#pragma once
// Light meters: where irradiance is asked for, and what was found there.
#include <cstdint>
#include <deltalux/scene.hpp>
#include <optional>
#include <vector>

namespace deltalux {

/// Irradiance is measured on the side the normal points to.
struct ProbePoint {
  Vec3 position{0};
  Vec3 normal{0, 0, 1};  // unit
};

struct ProbeResult {
  glm::dvec3 irradiance{0};     // E [W/m2]
  glm::dvec3 standardError{0};  // of E, per channel [W/m2]; 0 where the method has none to give
  std::uint64_t samples = 0;    // paths behind the value
};

/// The surface points seen through the centres of a view's pixels, on the side that is seen, row by row from the top;
/// nullopt where there is no surface. Thin glass is looked through.
std::vector<std::optional<ProbePoint>> visiblePoints(const Scene&, const View&, int width, int height);

}  // namespace deltalux
