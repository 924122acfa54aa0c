#pragma once
// What a solve over lines has found besides the solution, by which an update finds the same without asking again. It is
// cheaper to find again than to read, so files do not have it.
#include <memory>

#include "direct/leaf_direct.hpp"
#include "lines/first_lines.hpp"
#include "lines/leaf_scale.hpp"

namespace deltalux {

/// How the direct light of a patch came about.
struct EvaluatedLight {
  direct::LeafDirect found;  // by the rays that its choice was made by
  direct::LampSight above;   // what was known of lamps then
  direct::DirectSampler::Choice choice = direct::DirectSampler::Choice::Whole;
};

/// What is known of patches before their lines: by element.
struct PatchSamples {
  std::vector<lines::LeafScale> scale;
  std::vector<direct::LeafDirect> direct;
  std::vector<std::unique_ptr<lines::FirstLines>> first;
  std::vector<std::unique_ptr<EvaluatedLight>> evaluated;  // where a choice was made
  std::vector<std::unique_ptr<direct::LeafDirect>> whole;  // where light was asked for without a choice

  void resize(std::size_t elements) {
    scale.resize(elements), direct.resize(elements), first.resize(elements), evaluated.resize(elements),
        whole.resize(elements);
  }
};

/// What stays of a solve.
struct SolveMemory {
  PatchSamples samples;
  std::vector<char> enclosed;               // by element of the input level
  std::vector<lines::EscapedLine> escaped;  // of the solution's lines
  std::vector<char> plain;                  // by material: SurfaceResponses::plain()
};

}  // namespace deltalux
