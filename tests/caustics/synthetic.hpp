#pragma once
// Impacts drawn from known densities, and textures read back all over a surface.
#include <cmath>
#include <functional>

#include "base/random.hpp"
#include "caustics/caustic_texture.hpp"
#include "particles/impact.hpp"

namespace deltalux::test {

inline Shape unitSquare() { return *makePolygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}); }

/// `count` impacts of equal flux, 1 W in all, at points that `draw` makes.
inline std::vector<particles::Impact> drawImpacts(std::size_t count, std::uint64_t seed,
                                                  const std::function<SurfacePoint(Rng&)>& draw) {
  std::vector<particles::Impact> impacts;
  Rng rng(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const SurfacePoint p = draw(rng);
    particles::Impact impact;
    impact.primitive = PrimitiveId(0), impact.triangle = p.triangle;
    impact.uv = glm::vec2(p.uv);
    impact.flux = Rgb(1.0f, 0.5f, 0.25f) / static_cast<float>(count);
    impacts.push_back(impact);
  }
  return impacts;
}

inline SurfacePoint inSquare(double u, double v) {
  SurfacePoint p;
  p.position = {u, v, 0}, p.uv = {u, v};
  return p;
}

/// A disc of radius 0.12 around (0.6, 0.4) that holds 70 % of the flux, in even light.
inline SurfacePoint discInEvenLight(Rng& rng) {
  if (rng.uniform() < 0.3) return inSquare(rng.uniform(), rng.uniform());
  const double r = 0.12 * std::sqrt(rng.uniform()), phi = 2 * kPi * rng.uniform();
  return inSquare(0.6 + r * std::cos(phi), 0.4 + r * std::sin(phi));
}
inline double discInEvenLightDensity(double u, double v) {
  const double r = std::hypot(u - 0.6, v - 0.4);
  return 0.3 + (r < 0.12 ? 0.7 / (kPi * 0.12 * 0.12) : 0.0);
}

inline SurfacePoint evenly(Rng& rng) {
  const double u = rng.uniform();
  return inSquare(u, rng.uniform());
}

/// Root mean square error of the red channel over the unit square.
inline double squareError(const caustics::SurfaceCaustics& s, const std::function<double(double, double)>& truth) {
  constexpr int n = 256;
  double sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double u = (x + 0.5) / n, v = (y + 0.5) / n;
      const double d = s.irradianceAt(inSquare(u, v)).r - truth(u, v);
      sum += d * d;
    }
  return std::sqrt(sum / (n * n));
}

/// The grid over all of a shape's chart.
inline caustics::CellGrid gridOver(const Shape& shape, const caustics::Charts& charts, int width, int height,
                                   std::vector<float>* areas = nullptr);

}  // namespace deltalux::test

#include "caustics/coverage.hpp"

inline deltalux::caustics::CellGrid deltalux::test::gridOver(const Shape& shape, const caustics::Charts& charts,
                                                             int width, int height, std::vector<float>* areas) {
  const caustics::Region whole{Vec2(0), charts.all[0].size};
  std::vector<float> covered = caustics::coveredAreas(shape, charts, 0, whole, width, height);
  caustics::CellGrid grid(charts.all[0], whole, width, height, covered);
  if (areas) *areas = std::move(covered);
  return grid;
}
