// Cases 5.9 to 5.14 [CIE 171]. The room stands on a ground of 60 x 60 m before its southern wall, y = 0; what of the
// ground is beside or behind it is seen from nowhere. Walls have no thickness. The sun, which does not shine, stands 60
// degrees high in the south-west. Ground and masks that reflect do so by 30 %.
#include <cmath>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "support/cie171/cases.hpp"
#include "support/cie171/panorama.hpp"
#include "support/rooms.hpp"

namespace deltalux::test::cie171 {

namespace {

constexpr double kReflectance = 0.3;
constexpr double kOutside = 10000;                    // diffuse illuminance of open ground [lx]
constexpr double kEast = 32, kWest = -28;             // ends of ground and masks
constexpr double kMaskDepth = 1;                      // of the horizontal mask, at the head of the opening
constexpr double kMaskDistance = 6, kMaskHeight = 3;  // of the vertical mask

constexpr double kTilesWest = -8, kTilesEast = 12, kTilesSouth = -16;

const Vec3 kSun(-std::cos(kPi / 3) * std::sqrt(0.5), -std::cos(kPi / 3) * std::sqrt(0.5), std::sin(kPi / 3));

/// Of the roof or the southern wall.
struct Opening {
  std::string variant;
  Vec2 lower, upper;
};
const Opening kRoof[] = {{"1x1", {1.5, 1.5}, {2.5, 2.5}}, {"4x4", {0, 0}, {4, 4}}};
const Opening kFacade[] = {{"2x1", {1, 1}, {3, 2}}, {"4x3", {0, 0}, {4, 3}}};

std::vector<Facet> room(bool roof, const Opening& opening, bool glazed) {
  Facet south{1, 0, {0, 0}, {4, 3}}, ceiling{2, 3, {0, 0}, {4, 4}};
  std::vector<Facet> facets{
      {2, 0, {0, 0}, {4, 4}}, {0, 0, {0, 0}, {4, 3}}, {0, 4, {0, 0}, {4, 3}}, {1, 4, {0, 0}, {4, 3}}};
  facets.push_back(roof ? south : ceiling);
  Facet& open = roof ? ceiling : south;
  for (const Facet& part : around(open, opening.lower, opening.upper)) facets.push_back(part);
  if (!glazed) return facets;
  open.lower = opening.lower, open.upper = opening.upper;
  open.kind = Facet::Kind::Pane;
  open.outward = roof ? Vec3(0, 0, 1) : Vec3(0, -1, 0);
  facets.push_back(open);
  return facets;
}

Facet ground(double reflectance) { return {2, 0, {kWest, -60}, {kEast, 0}, reflectance}; }
Facet horizontalMask(double height) { return {2, height, {kWest, -kMaskDepth}, {kEast, 0}}; }
Facet verticalMask(double reflectance) { return {1, -kMaskDistance, {kWest, 0}, {kEast, kMaskHeight}, reflectance}; }

Daylight facade(const char* name, const std::string& variant, const Opening& opening, bool glazed,
                std::vector<Facet> outside) {
  Daylight d{name, variant, room(false, opening, glazed)};
  d.facets.insert(d.facets.end(), outside.begin(), outside.end());
  return d;
}

std::vector<ProbePoint> pointsOf(const Daylight& d) {
  std::vector<ProbePoint> points;
  for (int i = 0; i < 6; ++i) {
    const double z = 2.75 - 0.5 * i;
    points.push_back(d.roof ? ProbePoint{{2, 0, z}, {0, 1, 0}} : ProbePoint{{2, 4, z}, {0, -1, 0}});
  }
  for (int i = 0; i < 8; ++i) points.push_back({{2, 0.25 + 0.5 * i, 0}, {0, 0, 1}});
  return points;
}

/// Of the zenith, for kOutside on open ground [cd/m2].
double zenithLuminance(const GeneralSky& sky) {
  return kOutside / Panorama({}, sky, sky.sun, 24).illuminance(Vec3(0), {0, 0, 1});
}

}  // namespace

std::vector<Daylight> daylightVariants() {
  std::vector<Daylight> all;
  for (const bool glazed : {false, true})
    for (const Opening& o : kRoof) all.push_back({glazed ? "5.10" : "5.9", o.variant, room(true, o, glazed), true});
  for (const bool glazed : {false, true})
    for (const Opening& o : kFacade)
      all.push_back(facade(glazed ? "5.12" : "5.11", o.variant, o, glazed, {ground(kReflectance)}));
  for (const Opening& o : kFacade)
    all.push_back(facade("5.13", o.variant, o, false, {ground(kReflectance), horizontalMask(o.upper.y)}));
  for (const Opening& o : kFacade) {
    all.push_back(facade("5.14", o.variant, o, false, {ground(kReflectance), verticalMask(0)}));
    all.push_back(facade("5.14", o.variant + " grey mask", o, false, {ground(0), verticalMask(kReflectance)}));
  }
  return all;
}

Daylight findDaylight(const std::string& name, const std::string& variant) {
  for (Daylight& d : daylightVariants())
    if (d.name == name && d.variant == variant) return d;
  DELTALUX_CHECK(false, "no such case");
  return {};
}

Daylight inTiles(Daylight d) {
  std::vector<Facet> whole = std::move(d.facets);
  d.facets.clear();
  for (const Facet& facet : whole) {
    if (!(facet.reflectance > 0)) {
      d.facets.push_back(facet);
      continue;
    }
    const Vec2 lower = glm::max(facet.lower, Vec2(kTilesWest, kTilesSouth));
    const Vec2 upper = glm::min(facet.upper, Vec2(kTilesEast, facet.upper.y));
    for (const Facet& part : around(facet, lower, upper)) d.facets.push_back(part);
    for (double x = lower.x; x < upper.x; ++x)
      for (double y = lower.y; y < upper.y; ++y) {
        d.facets.push_back(facet);
        d.facets.back().lower = {x, y}, d.facets.back().upper = {x + 1, y + 1};
      }
  }
  return d;
}

void cutIntoTiles(Case& c, const Daylight& d) {
  std::vector<Light> lights = std::move(c.scene.lights);
  c.scene = {};
  addFacets(c.scene, inTiles(d).facets);
  c.scene.lights = std::move(lights);
}

std::vector<double> daylightReference(const Daylight& d, int type, int order, bool polynomialGlass) {
  const GeneralSky sky{type, kSun};
  const double zenith = zenithLuminance(sky);
  const Panorama panorama(
      d.facets, [&](const Vec3& w) { return zenith * sky(w); }, kSun, order,
      polynomialGlass ? polynomialTransmittance : std::function<double(double)>());
  const std::vector<ProbePoint> points = pointsOf(d);
  std::vector<double> values(points.size());
  parallelFor(points.size(), 1,
              [&](std::size_t i) { values[i] = panorama.illuminance(points[i].position, points[i].normal); });
  return values;
}

Case daylightCase(const Daylight& d, int type) {
  const GeneralSky sky{type, kSun};
  Case c{d.name, d.variant, {}, pointsOf(d), daylightReference(d, type)};
  addFacets(c.scene, d.facets);
  addLight(c.scene, skyLight(sky, zenithLuminance(sky)));
  return c;
}

}  // namespace deltalux::test::cie171
