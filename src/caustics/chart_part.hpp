#pragma once
// A part of a chart with the particles deposited on it: what one texture is made of. A chart starts as one part; lit
// regions are taken out of it, each a part of its own, until every place and every particle is in exactly one.
#include "caustics/caustic_texture.hpp"
#include "caustics/cell_light.hpp"
#include "caustics/restriction.hpp"

namespace deltalux::caustics {

struct ChartPart {
  Region region;
  glm::ivec2 texels{1};
  std::vector<float> areas;  // of the surface under each texel that is this part's
  std::vector<ChartImpact> impacts;
};

/// How many of the part's particles lie under each box of its grid.
std::vector<std::size_t> particlesUnder(const ChartPart&, const CellGrid&, std::span<const TexelBox>);

/// One chart of a surface, which must outlive this.
class ChartSurface {
 public:
  ChartSurface(const Shape& shape, const Charts& charts, std::uint32_t chart)
      : shape_(shape), charts_(charts), chart_(chart) {}

  const Chart& chart() const { return charts_.all[chart_]; }
  ChartPart whole(glm::ivec2 texels, std::vector<ChartImpact>) const;
  /// The same region and particles in `texels`. Not for parts that something was taken out of.
  void recut(ChartPart&, glm::ivec2 texels) const;
  /// Joins texels two by two each way; false on closed charts that do not come out even.
  bool halve(ChartPart&) const;
  /// The part under a box of `grid`, which is `from`'s: with its particles removed from `from`, and its texels.
  ChartPart takeOut(ChartPart& from, const CellGrid& grid, const TexelBox&, glm::ivec2 texels) const;

  CellGrid grid(const ChartPart& part) const {
    return CellGrid(chart(), part.region, part.texels.x, part.texels.y, part.areas);
  }
  /// The part's texture, with E of the cells of its grid.
  CausticTexture texture(const ChartPart&, const CellGrid&, const CellLight&, const std::vector<Rgb>& E) const;

 private:
  const Shape& shape_;
  const Charts& charts_;
  std::uint32_t chart_;
};

}  // namespace deltalux::caustics
