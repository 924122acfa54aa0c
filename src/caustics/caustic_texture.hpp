#pragma once
// A caustic texture: irradiance of the particles deposited on a part of a surface's side, for display [GD01 3]. It is
// a reconstruction of the particles' flux and never feeds back into the transport.
//
// The textures of one side share its surface out among them: at every point exactly one shows the particles, and
// together they hold all of the side's particle flux.
#include <deltalux/ids.hpp>
#include <deltalux/units.hpp>

#include "caustics/cell_grid.hpp"

namespace deltalux::caustics {

struct CausticTexture {
  std::uint32_t chart = 0;  // of the surface
  Region region;            // of the chart
  int width = 0, height = 0;
  bool closed = false, poleAtStart = false, poleAtEnd = false;  // how it continues beyond its rims
  std::vector<Rgb> texels;                                      // E [W/m2], row by row from the region's lower t
  std::vector<float> areas;  // of the surface that each texel shows [unit^2]; 0: none, or another texture shows it:
                             // its E then is what this one's light goes on with beyond the border
  RgbSum flux{0.0};          // of its particles
  std::uint64_t particles = 0;

  /// E at a chart point of the region, bilinear between the texels that know. [W/m2]
  Rgb sample(const Vec2& st) const;
  /// Whether a chart point lies in the region, over texels that show surface. `turn`: the chart's width, when closed.
  bool shows(const Vec2& st, double turn) const;
  /// The integral of E over the surface [W].
  RgbSum integral() const;
};

/// E of a grid's cells as a texture.
CausticTexture makeTexture(std::uint32_t chart, const CellGrid&, const std::vector<float>& texelAreas,
                           const std::vector<Rgb>& E);

/// The caustic textures of one side of a surface.
struct SurfaceCaustics {
  PrimitiveId primitive;
  bool front = true;
  Charts charts;
  std::vector<CausticTexture> textures;  // the finer ones first

  /// Irradiance of the particles at a surface point [W/m2].
  Rgb irradianceAt(const SurfacePoint&) const;
  RgbSum flux() const;
};

/// Checks that every texture's numbers are sound, and that the integral of all of a side is its particles' flux within
/// 0.5 %. Throws std::logic_error with the first violation.
void validate(const CausticTexture&);
void validate(const SurfaceCaustics&);

}  // namespace deltalux::caustics
