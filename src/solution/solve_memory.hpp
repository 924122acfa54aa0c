#pragma once
// What a solve over lines has found besides the solution, by which an update finds the same without asking again. It is
// cheaper to find again than to read, so files do not have it.
#include <array>
#include <memory>
#include <optional>

#include "base/tuning.hpp"
#include "direct/dim_direct.hpp"
#include "direct/leaf_direct.hpp"
#include "direct/sky_light.hpp"
#include "lines/enclosed_sides.hpp"
#include "lines/exchange.hpp"
#include "lines/first_lines.hpp"
#include "lines/leaf_scale.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/transfer.hpp"

namespace deltalux {

/// How the direct light of a patch came about.
struct EvaluatedLight {
  direct::LeafDirect found;  // by the rays that its choice was made by
  direct::LampSight above;   // what was known of lamps then
  direct::DirectSampler::Choice choice = direct::DirectSampler::Choice::Whole;
};

/// The same where no choice was made.
struct WholeLight {
  direct::LeafDirect light;
  direct::LampSight above;
};

/// What is known of patches before their lines: by element.
struct PatchSamples {
  std::vector<lines::LeafScale> scale;
  std::vector<direct::LeafDirect> direct;
  std::vector<std::unique_ptr<lines::FirstLines>> first;
  std::vector<std::unique_ptr<EvaluatedLight>> evaluated;  // where a choice was made
  std::vector<std::unique_ptr<WholeLight>> whole;          // where light was asked for without a choice
  std::vector<std::unique_ptr<WholeLight>> coarse;         // the same, of the input level: for the coarse light

  enum class Walled : std::uint8_t { Unasked, No, Yes };
  std::vector<Walled> walled;  // whether a wall crosses it

  void resize(std::size_t elements) {
    walled.resize(elements, Walled::Unasked), scale.resize(elements), direct.resize(elements), first.resize(elements),
        evaluated.resize(elements), whole.resize(elements), coarse.resize(elements);
  }
  void forget(std::size_t element) {
    walled[element] = Walled::Unasked, scale[element] = {}, direct[element] = {}, first[element].reset();
    forgetLight(element);
  }
  /// Of direct light from points that are others now what is told of them.
  void forgetLight(std::size_t element) { evaluated[element].reset(), whole[element].reset(), coarse[element].reset(); }
};

/// Sky light of a leaf, undimmed, what it followed from, and its shadow rays.
struct LeafSky {
  static constexpr std::size_t kRays = deltalux::tuning::kFewestEstimates;

  direct::SkyKey key;
  direct::SkyAtLeaf light;
  std::array<lines::LineCode, kRays> rays{};  // of those that there were not, without reach
  std::array<std::uint8_t, kRays> cells{};    // of the same
};

struct KnownSky {
  std::uint64_t skies = 0;                               // direct::Skies::key()
  std::vector<direct::SkyAtLeaf> at;                     // of the receiving leaves in order
  std::optional<direct::SkyVisibility> visibility = {};  // by the lines of those leaves
  std::vector<std::unique_ptr<LeafSky>> of;  // by element, of those leaves; of what was one once, out of date
};

/// Direct light of a leaf in the dark, from many points.
struct DimLeaf {
  hierarchy::ElementId leaf;
  std::uint64_t points = 0;  // which those were: of equal points the same
  direct::DimDirect light;
};

/// Lines and sky light of the input level, by which its coarse light came about.
struct CoarseLines {
  lines::TracedLines traced;
  KnownSky sky;
};

/// What stays of a solve.
struct SolveMemory {
  PatchSamples samples;
  particles::Details details;                        // by element
  std::vector<lines::LightWalks> walks;              // by element of the input level
  std::vector<char> enclosed;                        // the same: whether no light comes there, of walks or particles
  lines::ListsOfLeaves<lines::EscapedLine> escaped;  // of the solution's lines
  lines::ListsOfLeaves<lines::Bend> bends;           // of the same
  KnownSky sky;
  std::vector<DimLeaf> dim;                                   // ascending
  std::unique_ptr<lines::Exchange> exchange;                  // over those lines
  std::optional<particles::ParticleTransfer> coarseTransfer;  // of the particles, on the input level
  CoarseLines coarse;
  std::vector<char> plain;    // by material: SurfaceResponses::plain()
  std::vector<Rgb> nominal;   // by light: the scale that all was decided by
  direct::LampTree lampTree;  // at those
};

}  // namespace deltalux
