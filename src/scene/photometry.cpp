#include <algorithm>
#include <deltalux/light.hpp>

namespace deltalux {

namespace {

constexpr double kDegree = kPi / 180;  // [defined]

// The interval [angles[i], angles[i + 1]] that holds `angle`, and where in it.
struct Interval {
  std::size_t index;
  double fraction;
};

Interval intervalOf(const std::vector<double>& angles, double angle) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
  const std::size_t i = static_cast<std::size_t>(above - angles.begin()) - 1;
  return {i, std::clamp((angle - angles[i]) / (angles[i + 1] - angles[i]), 0.0, 1.0)};
}

// Integral of f(t) sin t over [t0, t1], f linear from f0 to f1.
double integrateWithSine(double t0, double t1, double f0, double f1) {
  const double slope = (f1 - f0) / (t1 - t0);
  return f0 * (std::cos(t0) - std::cos(t1)) + slope * (std::sin(t1) - std::sin(t0) - (t1 - t0) * std::cos(t1));
}

}  // namespace

double candela(const Photometry& photometry, double vertical, double horizontal) {
  const auto [v, fv] = intervalOf(photometry.verticals, vertical);
  const auto [h, fh] = intervalOf(photometry.horizontals, horizontal);
  const std::size_t rows = photometry.verticals.size();
  const auto at = [&](std::size_t i, std::size_t j) { return photometry.candela[i * rows + j]; };
  const double here = (1 - fv) * at(h, v) + fv * at(h, v + 1);
  const double next = (1 - fv) * at(h + 1, v) + fv * at(h + 1, v + 1);
  return (1 - fh) * here + fh * next;
}

double luminousFlux(const Photometry& photometry) {
  const std::vector<double>& verticals = photometry.verticals;
  const auto plane = [&](std::size_t h) {
    double sum = 0;
    for (std::size_t v = 0; v + 1 < verticals.size(); ++v) {
      const std::size_t i = h * verticals.size() + v;
      sum += integrateWithSine(verticals[v] * kDegree, verticals[v + 1] * kDegree, photometry.candela[i],
                               photometry.candela[i + 1]);
    }
    return sum;
  };
  double flux = 0;
  for (std::size_t h = 0; h + 1 < photometry.horizontals.size(); ++h) {
    const double width = (photometry.horizontals[h + 1] - photometry.horizontals[h]) * kDegree;
    flux += 0.5 * width * (plane(h) + plane(h + 1));
  }
  return flux;
}

Rgb radiantIntensity(const PhotometricLight& light, const Vec3& direction) {
  const Vec3 local = glm::transpose(light.frame) * direction;
  const double vertical = std::acos(std::clamp(-local.z, -1.0, 1.0)) / kDegree;
  double horizontal = std::atan2(local.y, local.x) / kDegree;
  if (horizontal < 0) horizontal += 360;
  return static_cast<float>(candela(*light.photometry, vertical, horizontal) / kLuminousEfficacy) * light.scale;
}

}  // namespace deltalux
