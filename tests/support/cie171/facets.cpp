#include "support/cie171/facets.hpp"

#include <cmath>
#include <map>

#include "support/rooms.hpp"

namespace deltalux::test::cie171 {

Pane paneAt(double cosine) {
  const double inside = std::sqrt(1 - (1 - cosine * cosine) / (kGlassIndex * kGlassIndex));
  const double amplitudes[] = {(cosine - kGlassIndex * inside) / (cosine + kGlassIndex * inside),
                               (inside - kGlassIndex * cosine) / (inside + kGlassIndex * cosine)};
  const double a = std::pow(kGlassTransmissivity, 1 / inside);  // of one crossing
  Pane pane{0, 0};
  for (const double amplitude : amplitudes) {
    const double r = amplitude * amplitude, t = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
    pane.transmittance += t / 2, pane.reflectance += r * (1 + a * t) / 2;
  }
  return pane;
}

double polynomialTransmittance(double cosine) {
  constexpr double k[] = {-0.028378, 3.156075, -3.058376, -1.428919, 4.014235, -1.775827};
  double sum = 0;
  for (int i = 5; i >= 0; --i) sum = sum * cosine + k[i];
  return std::max(0.0, sum);
}

std::vector<Facet> around(const Facet& whole, const Vec2& lower, const Vec2& upper) {
  std::vector<Facet> parts;
  const auto add = [&](const Vec2& a, const Vec2& b) {
    if (!(b.x > a.x && b.y > a.y)) return;
    parts.push_back(whole);
    parts.back().lower = a, parts.back().upper = b;
  };
  add(whole.lower, {whole.upper.x, lower.y});
  add({whole.lower.x, upper.y}, whole.upper);
  add({whole.lower.x, lower.y}, {lower.x, upper.y});
  add({upper.x, lower.y}, {whole.upper.x, upper.y});
  return parts;
}

void addFacets(Scene& scene, const std::vector<Facet>& facets) {
  std::map<double, MaterialId> matt;  // by reflectance
  MaterialId glass;
  for (const Facet& facet : facets) {
    const bool pane = facet.kind == Facet::Kind::Pane;
    if (pane && !glass.valid())
      glass = addMaterial(scene, "glass", ThinGlass{Rgb(float(kGlassTransmissivity)), float(kGlassIndex)});
    if (!pane && !matt.contains(facet.reflectance))
      matt[facet.reflectance] =
          addMaterial(scene, "matt" + std::to_string(matt.size()), lambert(static_cast<float>(facet.reflectance)));
    const int i = facet.axis == 0 ? 1 : 0, j = facet.axis == 2 ? 1 : 2;
    std::vector<Vec3> corners(4, Vec3(facet.at));
    for (int k = 0; k < 4; ++k) {
      corners[k][i] = k == 1 || k == 2 ? facet.upper.x : facet.lower.x;
      corners[k][j] = k >= 2 ? facet.upper.y : facet.lower.y;
    }
    addPolygon(scene, pane ? glass : matt[facet.reflectance], std::move(corners));
  }
}

}  // namespace deltalux::test::cie171
