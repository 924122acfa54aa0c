#pragma once
// Patterns and mixtures on surfaces that reflect: brightfunc, colorfunc, brightdata, colordata and colorpict multiply
// the colour of plastic and metal, mixfunc mixes two of those. [Radiance reference manual, "Patterns", "Mixtures"]
//
// Polygons on which they vary become meshes with a texture of the diffuse colour, as values at the texels' centres have
// it; on all other shapes, and for specular parts, the mean counts. A function that asks for the ray is told one
// straight onto the surface. What would reflect more than arrives reflects all.
#include <deltalux/io.hpp>
#include <map>
#include <memory>
#include <utility>

#include "io/radiance/modifier_table.hpp"
#include "io/radiance/pattern_function.hpp"

namespace deltalux::io::radiance {

class SurfacePatterns {
 public:
  /// `calls` bounds the work of all evaluations.
  SurfacePatterns(Scene& scene, ImportReport& report, FileAccess& files, long calls);
  ~SurfacePatterns();

  /// The surface as its modifier has it: the shape, or a mesh in its place, and its material.
  std::pair<Shape, MaterialId> apply(const Modifier&, Shape);
  /// Whether a surface has the pattern or mixture, or what is wrong with it is in the report.
  bool asked(const RadObject& pattern) const { return functions_.asked(pattern); }

 private:
  struct Look;
  struct Paint;

  std::shared_ptr<const Paint> paintOf(const Modifier&);
  const PatternFunction* functionOf(const RadObject&);
  Material painted(const Paint&, MaterialId base, const Look& mean) const;
  std::pair<Shape, MaterialId> textured(const Paint&, MaterialId base, const Polygon&, const Look& mean);
  void note(const std::string& what) { ++report_.ignored[what]; }

  Scene& scene_;
  ImportReport& report_;
  std::size_t texels_ = 0;
  PatternFunctions functions_;
  using Key = std::pair<MaterialId, std::vector<const RadObject*>>;
  std::map<Key, MaterialId> made_;  // of paints that are everywhere the same
};

}  // namespace deltalux::io::radiance
