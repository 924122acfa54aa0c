#pragma once
// What is seen from a point among axis-parallel rectangles under a sky, integrated numerically: the references of
// CIE 171's daylight cases. Nothing of it is the library's.
//
// E = integral over azimuth and elevation of L (n . w) cos(elevation). At every azimuth each rectangle fills one
// interval of elevations; between their ends one thing is seen, and Gauss's rule is applied there. Azimuth is divided
// where rectangles have corners. What a grey facet sends is its own irradiance, by the same integral, times rho / pi:
// once (`bounces` = 1), which is all where grey facets do not see each other. A pane passes light on, and mirrors the
// sky to those outside. Cost: some 10^3 luminances of the sky a bounce, squared for two.
#include <functional>
#include <vector>

#include "support/cie171/facets.hpp"

namespace deltalux::test::cie171 {

/// Nodes of Gauss-Legendre's rule on (0, 1), with their weights.
struct GaussRule {
  explicit GaussRule(int order);
  std::vector<double> nodes, weights;
};

class Panorama {
 public:
  /// `sky`: luminance by direction, smooth but for `sun`. `transmittance`: of panes, by cosine.
  Panorama(std::vector<Facet> facets, std::function<double(const Vec3&)> sky, const Vec3& sun, int order = 8,
           std::function<double(double)> transmittance = {});

  /// Illuminance on the side of `normal`, which is parallel to an axis.
  double illuminance(const Vec3& point, const Vec3& normal, int bounces = 1) const;

 private:
  struct Interval;
  struct Receiver;

  double alongAzimuth(const Receiver&, double azimuth) const;
  double seenThrough(const Receiver&, const Vec3& w, const std::vector<const Facet*>& seen) const;

  std::vector<Facet> facets_;
  std::function<double(const Vec3&)> sky_;
  Vec3 sun_;
  GaussRule rule_;
  std::function<double(double)> transmittance_;
};

}  // namespace deltalux::test::cie171
