#pragma once
// Why it is bright here: what of the irradiance at a point of a surface comes from which lamp, which surface, and along
// which paths of particles.
#include <deltalux/probe.hpp>
#include <vector>

namespace deltalux {

struct ContributionSettings {
  std::size_t most = 8;      // of each list: the strongest
  double error = 0.02;       // relative standard error of the direct light of all lamps together
  int maxSamples = 1 << 12;  // shadow rays of it at most
  std::uint64_t seed = 1;
};

/// All irradiance in W/m2. Lists are in falling order of what they bring (by luminance), and hold the strongest; the
/// sums hold all.
struct Contributions {
  bool onSurface = false;  // false: there is no surface at the point, and all else is empty
  glm::dvec3 direct{0}, indirect{0}, particle{0};

  struct Lamp {
    LightId light;
    glm::dvec3 E{0};  // straight from it, with what stands between
  };
  struct Surface {
    ObjectId object;  // invalid: of none
    Vec3 centre{0};   // of the patches that send, weighted by what they bring
    glm::dvec3 E{0};  // reflected there, last
  };
  struct Path {
    std::vector<Vec3> corners;  // from where the light left diffusely, or its lamp, to the point
    glm::dvec3 E{0};            // of all particles that came this way: over the same surfaces
    std::uint64_t particles = 0;
  };
  std::vector<Lamp> lamps;
  std::vector<Surface> surfaces;
  std::vector<Path> paths;
};

}  // namespace deltalux
