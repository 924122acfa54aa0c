#pragma once
// Axis-parallel rectangles: what the rooms of CIE 171 and their surroundings are made of.
#include <deltalux/scene.hpp>
#include <vector>

namespace deltalux::test::cie171 {

/// A rectangle in the plane where coordinate `axis` is `at`; `lower`, `upper` of the other two, in the order x, y, z.
struct Facet {
  enum class Kind { Opaque, Pane };

  int axis = 2;
  double at = 0;
  Vec2 lower{0}, upper{0};
  double reflectance = 0;  // of both sides
  double luminance = 0;    // given [cd/m2]; of a reference alone
  Kind kind = Kind::Opaque;
  Vec3 outward{0};  // of a pane: where the sky is
};

/// Clear glass of 6 mm as ThinGlass has it: .879 at normal incidence, as the polynomial of [CIE 171, 5.10].
constexpr double kGlassIndex = 1.52, kGlassTransmissivity = 0.957;

struct Pane {
  double transmittance, reflectance;
};
/// Unpolarised light on such a pane, by all reflections between its faces.
Pane paneAt(double cosine);
/// Directional transmittance of 6 mm of clear glass as CIE 171 prescribes it. [CIE 171, 5.10; TS93 2.34]
double polynomialTransmittance(double cosine);

/// The rest of a facet around a rectangle of it: up to four.
std::vector<Facet> around(const Facet&, const Vec2& lower, const Vec2& upper);
/// A surface of the scene for each.
void addFacets(Scene&, const std::vector<Facet>&);

}  // namespace deltalux::test::cie171
