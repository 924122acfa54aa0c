#pragma once
// What a user may set about a solution. Everything else follows from `error` and the scene.
#include <cstdint>
#include <string>
#include <vector>

namespace deltalux {

/// How diffuse light is exchanged.
enum class SolveMethod : std::uint8_t {
  Lines,  // stored lines that count at both ends
  Paper,  // hierarchical links, refined to the error
};

/// Lights whose names match are dimmed together, as the group of that name. A pattern is a name as edits have it
/// ("lanterns" is "lanterns" and every "lanterns.*"), in which * stands for any characters.
struct LightPattern {
  std::string group, pattern;

  bool operator==(const LightPattern&) const = default;
};

struct SolveSettings {
  double error = 0.05;          // target relative error of irradiance, in (0, 1)
  std::uint64_t particles = 0;  // target count of particles; 0: from `error`
  double seconds = 0;           // solving ends after about this long; 0: when the target is met
  bool diffuseOnly = false;     // no specular lobes, no mirrors; thin glass passes light straight on
  bool causticTextures = true;  // off: the mesh shows the light of particles everywhere, refined for it
  std::uint64_t seed = 1;
  SolveMethod method = SolveMethod::Lines;
  bool byLight = false;  // the light of each lamp, of each sun and of the skies is kept apart (light_groups.hpp)
  std::vector<LightPattern> groups = {};  // of those, what is to be dimmed together
  double reemittedShare = 0.1;  // by Paper: of particle links that a motion affects, emitted again a frame, in (0, 1]
};

}  // namespace deltalux
