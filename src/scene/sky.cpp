#include "scene/sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.hpp"

namespace deltalux {

namespace {

double angleOf(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

double clearSky(const RadianceSky& sky, double cosZenith, double cosSun) {
  const double indicatrix = 0.91 + 10 * std::exp(-3 * angleOf(cosSun)) + 0.45 * cosSun * cosSun;
  const double gradation = cosZenith > 0.01 ? 1 - std::exp(-0.32 / cosZenith) : 1;
  return sky.zenith * indicatrix * gradation / sky.normalization;
}

double overcastSky(const RadianceSky& sky, double cosZenith) { return sky.zenith * (1 + 2 * cosZenith) / 3; }

/// [Matsuura87], as skybright.cal has it.
double intermediateSky(const RadianceSky& sky, double cosZenith, double cosSun, double cosSunZenith) {
  const double eta = angleOf(cosZenith), sunZenith = angleOf(cosSunZenith);
  const double zenithPart = (1.35 * std::sin(5.631 - 3.59 * eta) + 3.12) * std::sin(4.396 - 2.6 * sunZenith);
  const double decay = -0.563 * ((2.629 - eta) * (1.562 - sunZenith) + 0.812);
  const double relative = (zenithPart + 6.37 - eta) / 2.326 * std::exp(angleOf(cosSun) * decay);
  return sky.zenith * relative / sky.normalization;
}

double skyPart(const RadianceSky& sky, double cosZenith, double cosSun, double cosSunZenith) {
  switch (sky.kind) {
    case RadianceSky::Kind::Clear:
      return clearSky(sky, cosZenith, cosSun);
    case RadianceSky::Kind::Overcast:
      return overcastSky(sky, cosZenith);
    case RadianceSky::Kind::Uniform:
      return sky.zenith;
    case RadianceSky::Kind::Intermediate:
      return intermediateSky(sky, cosZenith, cosSun, cosSunZenith);
  }
  return 0;
}

struct CieParameters {
  double a, b, c, d, e;

  double gradation(double cosZenith) const { return 1 + a * std::exp(b / cosZenith); }
  double indicatrix(double cosSun) const {
    return 1 + c * (std::exp(d * angleOf(cosSun)) - std::exp(d * kPi / 2)) + e * cosSun * cosSun;
  }
};

constexpr std::array<CieParameters, 15> kCieSkies{{{4, -0.7, 0, -1, 0},
                                                   {4, -0.7, 2, -1.5, 0.15},
                                                   {1.1, -0.8, 0, -1, 0},
                                                   {1.1, -0.8, 2, -1.5, 0.15},
                                                   {0, -1, 0, -1, 0},
                                                   {0, -1, 2, -1.5, 0.15},
                                                   {0, -1, 5, -2.5, 0.3},
                                                   {0, -1, 10, -3, 0.45},
                                                   {-1, -0.55, 2, -1.5, 0.15},
                                                   {-1, -0.55, 5, -2.5, 0.3},
                                                   {-1, -0.55, 10, -3, 0.45},
                                                   {-1, -0.32, 10, -3, 0.45},
                                                   {-1, -0.32, 16, -3, 0.3},
                                                   {-1, -0.15, 16, -3, 0.3},
                                                   {-1, -0.15, 24, -2.8, 0.15}}};  // [defined]

}  // namespace

}  // namespace deltalux

namespace deltalux::scene {

double radiance(const RadianceSky& sky, const Vec3& towards, const Vec3& up) {
  const double cosZenith = std::clamp(glm::dot(towards, up), -1.0, 1.0);
  const double above = skyPart(sky, cosZenith, glm::dot(towards, sky.sunDirection), glm::dot(up, sky.sunDirection));
  const double x = cosZenith + 1.01, x2 = x * x, x4 = x2 * x2, weight = x4 * x4 * x2;
  return std::max(0.0, (weight * above + sky.ground / weight) / (weight + 1 / weight));
}

double radiance(const CieSky& sky, const Vec3& towards, const Vec3& up) {
  DELTALUX_CHECK(sky.type >= 1 && sky.type <= 15, "CIE sky types are 1 to 15");
  const double cosZenith = glm::dot(towards, up);
  if (cosZenith <= 0) return sky.ground;
  const CieParameters& p = kCieSkies[static_cast<std::size_t>(sky.type - 1)];
  const double relative = p.indicatrix(glm::dot(towards, sky.sunDirection)) * p.gradation(cosZenith) /
                          (p.indicatrix(glm::dot(up, sky.sunDirection)) * p.gradation(1));
  return sky.zenith * relative;
}

double radiance(const PerezSky& sky, const Vec3& towards, const Vec3& up) {
  constexpr double kLowest = 0.01;  // the gradation is held constant below, where it would divide by 0 [defined]
  const double cosZenith = glm::dot(towards, up);
  if (cosZenith <= 0) return std::max(0.0, sky.ground);
  const auto& [a, b, c, d, e] = sky.coefficients;
  const double cosSun = glm::dot(towards, sky.sunDirection);
  const double gradation = 1 + a * std::exp(b / std::max(cosZenith, kLowest));
  const double indicatrix = 1 + c * std::exp(d * angleOf(cosSun)) + e * cosSun * cosSun;
  const double value = sky.diffuse * gradation * indicatrix;
  return std::isfinite(value) ? std::max(0.0, value) : 0.0;
}

}  // namespace deltalux::scene

namespace deltalux {

Rgb skyRadiance(const DomeLight& dome, const Vec3& towards) {
  constexpr double kRim = 1e-12;  // the rim of a hemisphere is inside: sky and ground meet without a gap [rounding]
  if (glm::dot(towards, dome.axis) < std::cos(dome.halfAngle) - kRim) return Rgb(0.0f);
  struct Visitor {
    const Vec3 &towards, &up;
    double operator()(const UniformSky& sky) const { return sky.radiance; }
    double operator()(const RadianceSky& sky) const { return scene::radiance(sky, towards, up); }
    double operator()(const CieSky& sky) const { return scene::radiance(sky, towards, up); }
    double operator()(const PerezSky& sky) const { return scene::radiance(sky, towards, up); }
    double operator()(const TabulatedSky& sky) const {
      return valueAt(*sky.table, glm::transpose(sky.frame) * towards);
    }
  };
  return static_cast<float>(std::visit(Visitor{towards, dome.up}, dome.distribution)) * dome.scale;
}

}  // namespace deltalux
