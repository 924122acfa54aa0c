#pragma once
// What a solve over lines has found besides the solution, by which an update finds the same without asking again. It is
// cheaper to find again than to read, so files do not have it.
#include <memory>

#include "direct/dim_direct.hpp"
#include "direct/leaf_direct.hpp"
#include "direct/sky_light.hpp"
#include "lines/enclosed_sides.hpp"
#include "lines/exchange.hpp"
#include "lines/first_lines.hpp"
#include "lines/leaf_scale.hpp"

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

  void resize(std::size_t elements) {
    scale.resize(elements), direct.resize(elements), first.resize(elements), evaluated.resize(elements),
        whole.resize(elements);
  }
};

/// Sky light of the receiving leaves in order, undimmed, and its shadow rays.
struct KnownSky {
  std::uint64_t skies = 0;  // direct::Skies::key()
  std::vector<direct::SkyAtLeaf> at;
  std::vector<direct::SkyKey> key;
  LargeArray<lines::LineCode> rays;  // kManyRays of each leaf; of those that there were not, without reach
  LargeArray<std::uint8_t> cells;    // of the same
};

/// Direct light of a leaf in the dark, from many points.
struct DimLeaf {
  hierarchy::ElementId leaf;
  std::uint64_t points = 0;  // which those were: of equal points the same
  direct::DimDirect light;
};

/// What stays of a solve.
struct SolveMemory {
  PatchSamples samples;
  std::vector<lines::LightWalks> walks;     // by element of the input level
  std::vector<char> enclosed;               // the same: whether no light comes there, of walks or particles
  std::vector<lines::EscapedLine> escaped;  // of the solution's lines
  std::vector<lines::Bend> bends;           // of the same
  KnownSky sky;
  std::vector<DimLeaf> dim;                   // ascending
  std::unique_ptr<lines::Exchange> exchange;  // over those lines
  std::vector<char> plain;                    // by material: SurfaceResponses::plain()
  std::vector<Rgb> nominal;                   // by light: the scale that all was decided by
};

}  // namespace deltalux
