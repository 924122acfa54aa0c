#include "support/cie171/panorama.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace deltalux::test::cie171 {

namespace {

constexpr double kTouching = 1e-9;        // of a facet's own points
constexpr double kWidestPanel = kPi / 8;  // of azimuth and elevation

struct Span {
  double low, high;
};

/// Where a ray from `p` along the horizontal `u` is above or below a horizontal rectangle.
std::optional<Span> overlap(const Vec3& p, const Vec2& u, const Facet& f) {
  Span t{0, kInfinity};
  for (int i = 0; i < 2; ++i) {
    if (u[i] == 0) {
      if (p[i] < f.lower[i] || p[i] > f.upper[i]) return std::nullopt;
      continue;
    }
    const double a = (f.lower[i] - p[i]) / u[i], b = (f.upper[i] - p[i]) / u[i];
    t.low = std::max(t.low, std::min(a, b)), t.high = std::min(t.high, std::max(a, b));
  }
  if (t.low >= t.high) return std::nullopt;
  return t;
}

/// The elevations that a facet fills at an azimuth.
std::optional<Span> elevations(const Vec3& p, const Vec2& u, const Facet& f) {
  if (std::abs(p[f.axis] - f.at) < kTouching) return std::nullopt;
  if (f.axis == 2) {
    const auto t = overlap(p, u, f);
    if (!t) return std::nullopt;
    const double a = std::atan2(f.at - p.z, t->low), b = std::atan2(f.at - p.z, t->high);
    return Span{std::min(a, b), std::max(a, b)};
  }
  const int other = 1 - f.axis;
  const double t = (f.at - p[f.axis]) / u[f.axis], across = p[other] + t * u[other];
  if (!(t > 0 && t < kInfinity) || across < f.lower.x || across > f.upper.x) return std::nullopt;
  return Span{std::atan2(f.lower.y - p.z, t), std::atan2(f.upper.y - p.z, t)};
}

double distanceTo(const Facet& f, const Vec3& p, const Vec3& w) { return (f.at - p[f.axis]) / w[f.axis]; }

/// Divides [breaks[0], breaks.back()] at the breaks between, and where panels are wide.
template <class Integrand>
double integrate(const GaussRule& rule, std::vector<double>& breaks, const Integrand& f) {
  std::sort(breaks.begin(), breaks.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double width = breaks[i + 1] - breaks[i];
    if (width < 1e-12) continue;
    const auto panel = f(0.5 * (breaks[i] + breaks[i + 1]));
    if (!panel) continue;
    const int parts = static_cast<int>(std::ceil(width / kWidestPanel));
    for (int part = 0; part < parts; ++part)
      for (std::size_t k = 0; k < rule.nodes.size(); ++k)
        sum += rule.weights[k] * width / parts * (*panel)(breaks[i] + width * (part + rule.nodes[k]) / parts);
  }
  return sum;
}

}  // namespace

GaussRule::GaussRule(int order) {
  for (int i = 0; i < order; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (order + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double p = 1, before = 0;  // Legendre's polynomials, by their recurrence [DLMF 18.9]
      for (int k = 0; k < order; ++k) {
        const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
        before = p, p = next;
      }
      slope = order * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    nodes.push_back((1 + x) / 2), weights.push_back(1 / ((1 - x * x) * slope * slope));
  }
}

struct Panorama::Interval {
  Span elevations;
  const Facet* facet;
};

struct Panorama::Receiver {
  Vec3 point, normal;
  int bounces;
};

Panorama::Panorama(std::vector<Facet> facets, std::function<double(const Vec3&)> sky, const Vec3& sun, int order,
                   std::function<double(double)> transmittance)
    : facets_(std::move(facets)),
      sky_(std::move(sky)),
      sun_(sun),
      rule_(order),
      transmittance_(transmittance ? std::move(transmittance) : [](double c) { return paneAt(c).transmittance; }) {}

double Panorama::illuminance(const Vec3& point, const Vec3& normal, int bounces) const {
  const Receiver receiver{point, normal, bounces};
  const bool level = std::abs(normal.z) > 0.5;
  const double first = level ? 0 : std::atan2(normal.y, normal.x) - kPi / 2, span = level ? 2 * kPi : kPi;
  std::vector<double> breaks{0, span};
  const auto add = [&](double x, double y) {
    if (std::hypot(x, y) < kTouching) return;
    const double turn = std::atan2(y, x) - first, azimuth = turn - 2 * kPi * std::floor(turn / (2 * kPi));
    if (azimuth < span) breaks.push_back(azimuth);
  };
  add(sun_.x, sun_.y);
  for (const Facet& f : facets_)
    for (int corner = 0; corner < 4; ++corner) {
      const double a = corner & 1 ? f.upper.x : f.lower.x, b = corner & 2 ? f.upper.y : f.lower.y;
      const Vec3 at = f.axis == 0 ? Vec3(f.at, a, b) : f.axis == 1 ? Vec3(a, f.at, b) : Vec3(a, b, f.at);
      add(at.x - point.x, at.y - point.y);
    }
  const auto along = [&](double azimuth) { return alongAzimuth(receiver, first + azimuth); };
  return integrate(rule_, breaks, [&](double) { return std::optional(along); });
}

double Panorama::alongAzimuth(const Receiver& r, double azimuth) const {
  const Vec2 u(std::cos(azimuth), std::sin(azimuth));
  const double low = r.normal.z > 0.5 ? 0 : -kPi / 2, high = r.normal.z < -0.5 ? 0 : kPi / 2;
  std::vector<double> breaks{low, high};
  std::vector<Interval> intervals;
  const auto add = [&](double elevation) {
    if (elevation > low && elevation < high) breaks.push_back(elevation);
  };
  add(0), add(std::asin(sun_.z));
  for (const Facet& f : facets_)
    if (const auto filled = elevations(r.point, u, f)) {
      intervals.push_back({*filled, &f});
      add(filled->low), add(filled->high);
    }
  const auto direction = [&](double elevation) { return Vec3(std::cos(elevation) * u, std::sin(elevation)); };
  std::vector<const Facet*> seen;
  const auto panel = [&](double middle) {
    const Vec3 w = direction(middle);
    seen.clear();
    for (const Interval& interval : intervals)
      if (interval.elevations.low < middle && middle < interval.elevations.high) seen.push_back(interval.facet);
    std::sort(seen.begin(), seen.end(),
              [&](const Facet* a, const Facet* b) { return distanceTo(*a, r.point, w) < distanceTo(*b, r.point, w); });
    const auto value = [&](double elevation) {
      const Vec3 v = direction(elevation);
      return seenThrough(r, v, seen) * std::max(0.0, glm::dot(r.normal, v)) * std::cos(elevation);
    };
    using Value = decltype(value);
    const bool black = !seen.empty() && seen[0]->kind == Facet::Kind::Opaque && !(seen[0]->luminance > 0) &&
                       !(seen[0]->reflectance > 0 && r.bounces > 0);
    const bool belowTheHorizon = seen.empty() && middle < 0;
    return black || belowTheHorizon ? std::optional<Value>() : std::optional<Value>(value);
  };
  return integrate(rule_, breaks, panel);
}

/// Luminance of the first of `seen`, through panes; of the sky where there is none.
double Panorama::seenThrough(const Receiver& r, const Vec3& w, const std::vector<const Facet*>& seen) const {
  double passed = 1;
  for (const Facet* f : seen) {
    if (f->kind == Facet::Kind::Pane) {
      const double cosine = std::abs(w[f->axis]);
      if (glm::dot(f->outward, w) < 0) {  // from outside: the room behind is black
        Vec3 mirrored = w;
        mirrored[f->axis] *= -1;
        return passed * paneAt(cosine).reflectance * sky_(mirrored);
      }
      passed *= transmittance_(cosine);
      continue;
    }
    if (f->luminance > 0) return passed * f->luminance;
    if (!(f->reflectance > 0) || r.bounces == 0) return 0;
    Vec3 normal(0);
    normal[f->axis] = w[f->axis] > 0 ? -1 : 1;
    const Vec3 at = r.point + distanceTo(*f, r.point, w) * w;
    return passed * f->reflectance / kPi * illuminance(at, normal, r.bounces - 1);
  }
  return w.z > 0 ? passed * sky_(w) : 0;
}

}  // namespace deltalux::test::cie171
