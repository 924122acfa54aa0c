#pragma once
// What a frame shows, as values: filled by the controller, read by the renderer (gl/renderer.hpp) and the panels.
#include <array>
#include <deltalux/image.hpp>
#include <deltalux/render_cache.hpp>
#include <deltalux/solution_mesh.hpp>
#include <deltalux/view.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver.hpp"

namespace deltalux::viewer {

enum class Quantity {
  Radiance,
  Illuminance,
  Luminance
};  // what is shown: the picture, or false colour of one of these

struct FalseColour {
  Quantity quantity = Quantity::Radiance;  // Radiance: no false colour
  double top = 1000;                       // lux or cd/m2
  bool logarithmic = true;
  double decades = 3;                           // of the logarithmic scale
  std::vector<double> bands = {300, 500, 750};  // with useBands: only these steps; isolines run along them
  bool useBands = false;
  bool isolines = false;
};

struct Overlays {
  bool mesh = false;            // outlines of the patches
  bool particles = false;       // corners and ways of the paths behind the point that was asked about
  bool textureRegions = false;  // where caustic textures are, each in a colour
  bool statistics = false;      // times, bytes, rays
};

/// A line in the scene, drawn over it.
struct Line {
  Vec3f from{0.0f}, to{0.0f};
  glm::vec4 colour{1.0f};
  bool onTop = true;  // otherwise hidden by what stands before it
};

struct DrawSettings {
  ToneMapping tone;  // locked: changes by hand alone
  FalseColour falseColour;
  Overlays overlays;
  std::optional<Box> section;  // what lies outside is cut away
  bool cache = true;           // rays for mirrors, gloss and glass
  bool picture = true;         // the picture that is made better at rest
};

/// Primitives that are drawn ahead of their light: the hand has moved them and the solver has not followed yet.
struct Ahead {
  std::vector<PrimitiveId> primitives;
  glm::mat4 matrix{1.0f};  // from where the mesh has them
};

struct Frame {
  View camera;
  int width = 0, height = 0;
  std::shared_ptr<const SolutionMesh> mesh;   // null: nothing yet
  std::shared_ptr<const SolutionMesh> other;  // A/B: to the right of `wipe`
  double wipe = 1;                            // share of the width that shows `mesh`
  std::optional<Ahead> ahead;
  std::shared_ptr<const Picture> picture;  // shown where camera and version fit
  DrawSettings settings;
  std::vector<PrimitiveId> selection;  // outlined
  std::vector<Line> lines;
};

/// What drawing took.
struct DrawReport {
  double milliseconds = 0;       // on the processor, with waiting for GL to finish
  double cacheMilliseconds = 0;  // of it, projecting and filling the Render Cache
  std::uint64_t uploadedBytes = 0;
  std::uint64_t triangles = 0;
  std::size_t cacheWanted = 0, cacheHeld = 0;
};

}  // namespace deltalux::viewer
