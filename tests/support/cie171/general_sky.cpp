#include "support/cie171/general_sky.hpp"

#include <algorithm>
#include <cmath>

#include "support/solved.hpp"

namespace deltalux::test::cie171 {

namespace {

struct Gradation {
  double a, b;
};
struct Indicatrix {
  double c, d, e;
};
struct Groups {
  int gradation, indicatrix;  // from 0
};

constexpr Gradation kGradations[] = {{4, -.7}, {1.1, -.8}, {0, -1}, {-1, -.55}, {-1, -.32}, {-1, -.15}};
constexpr Indicatrix kIndicatrices[] = {{0, -1, 0},    {2, -1.5, .15}, {5, -2.5, .3},
                                        {10, -3, .45}, {16, -3, .3},   {24, -2.8, .15}};
constexpr Groups kTypes[] = {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}, {2, 3},
                             {3, 1}, {3, 2}, {3, 3}, {4, 3}, {4, 4}, {5, 4}, {5, 5}};  // [ISO 15469, table 1]

double overcast(double sine) { return (1 + 2 * sine) / 3; }

/// The traditional overcast sky: linear in the sine of elevation, so a degree apart is as good as closed.
DomeLight tabulatedOvercast() {
  DirectionTable table{181, 1, {}};
  for (std::size_t row = 0; row < table.rows; ++row)
    table.values.push_back(static_cast<float>(overcast(std::max(0.0, std::cos(kPi * double(row) / 180)))));
  DomeLight dome;
  dome.distribution = TabulatedSky{std::make_shared<const DirectionTable>(std::move(table))};
  return dome;
}

}  // namespace

double GeneralSky::operator()(const Vec3& w) const {
  if (!(w.z > 0)) return 0;
  if (type == kTraditionalOvercast) return overcast(w.z);
  const Groups groups = kTypes[type - 1];
  const auto [a, b] = kGradations[groups.gradation];
  const auto [c, d, e] = kIndicatrices[groups.indicatrix];
  const double right = std::exp(d * kPi / 2);
  const auto indicatrix = [&](double cosine) {
    return 1 + c * (std::exp(d * std::acos(std::clamp(cosine, -1.0, 1.0))) - right) + e * cosine * cosine;
  };
  const double gradation = (1 + a * std::exp(b / w.z)) / (1 + a * std::exp(b));
  return gradation * indicatrix(glm::dot(w, sun)) / indicatrix(sun.z);
}

DomeLight skyLight(const GeneralSky& sky, double zenith) {
  DomeLight dome = sky.type == kTraditionalOvercast ? tabulatedOvercast() : DomeLight{};
  if (sky.type != kTraditionalOvercast) dome.distribution = CieSky{sky.type, 1, 0, sky.sun};
  dome.scale = fromPhotometric(zenith);
  return dome;
}

}  // namespace deltalux::test::cie171
