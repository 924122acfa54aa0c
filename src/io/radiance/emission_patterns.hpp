#pragma once
// Patterns of lights as the scene has them: chains of pattern functions multiplied and tabulated over directions.
//
// What a surface emits in the mean, M / pi, becomes its radiance, and the pattern's table is relative to that. A
// pattern divided by the cosine (flatcorr) becomes the intensity of a flat source. Over curved surfaces what depends on
// the normal, and over any what depends on position, is averaged as the far field sees it; colour that changes with
// direction is averaged, too. These, and what cannot be evaluated, are counted in the import's report.
#include <array>
#include <deltalux/io.hpp>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "io/radiance/modifier_table.hpp"
#include "io/radiance/pattern_function.hpp"

namespace deltalux::io::radiance {

class EmissionPatterns {
 public:
  /// `calls` bounds the work of all evaluations.
  EmissionPatterns(Scene& scene, ImportReport& report, FileAccess& files, long calls);
  ~EmissionPatterns();

  /// The material of a surface of that shape: the modifier's own, or one that emits by its patterns.
  MaterialId materialFor(const Modifier&, const Shape&);
  /// Gives a source at infinity the patterns of its modifier.
  void apply(const Modifier&, Light&);
  /// Whether a light asked for the pattern: it is read, or what is wrong with it is in the report.
  bool asked(const RadObject& pattern) const { return functions_.asked(pattern); }

 private:
  using Chain = std::vector<const RadObject*>;
  struct Product;
  struct Sampled;

  Chain readable(const Modifier&);
  Product& productOf(const Chain&);
  const PatternFunction* functionOf(const RadObject&);
  Emission emissionOver(Product&, const Shape&, const Emission& plain);
  Sampled sample(const Product&, std::span<const SurfacePoint>, bool intensity);
  double meanFactor(const DirectionTable&, const glm::dmat3& frame, std::span<const SurfacePoint>, bool intensity);
  void note(const std::string& what) { ++report_.ignored[what]; }

  Scene& scene_;
  ImportReport& report_;
  PatternFunctions functions_;
  std::map<Chain, std::unique_ptr<Product>> products_;
  std::map<std::tuple<MaterialId, Chain, std::array<double, 3>>, MaterialId> made_;  // by a flat surface's normal
};

}  // namespace deltalux::io::radiance
