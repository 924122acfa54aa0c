#include "scene/light_sampling_dome.hpp"

#include <algorithm>

#include "base/sobol.hpp"
#include "base/tuning.hpp"
#include "base/unit_circle.hpp"

namespace deltalux::scene {

DomeTable::DomeTable(const DomeLight& dome) : frame_(dome.axis), depth_(1.0 - std::cos(dome.halfAngle)) {
  std::vector<double> weights(kRings * kSectors);
  double sum = 0;
  for (int cell = 0; cell < kRings * kSectors; ++cell) {
    const ScrambledSobol looks(static_cast<std::uint64_t>(cell));
    for (std::uint32_t k = 0; k < deltalux::tuning::kPilots; ++k) {
      const UnitPair look = looks(k);
      weights[cell] += gray(
          skyRadiance(dome, direction((cell % kSectors + look.x) / kSectors, (cell / kSectors + look.y) / kRings)));
    }
    sum += weights[cell];
  }
  const double cells = kRings * kSectors;
  double total = 0;
  for (double w : weights) {
    total +=
        sum > 0 ? deltalux::tuning::kDefensive / cells + (1.0 - deltalux::tuning::kDefensive) * w / sum : 1.0 / cells;
    cumulative_.push_back(total);
  }
  for (double& c : cumulative_) c /= total;
}

Vec3 DomeTable::direction(double azimuth, double height) const {
  const double down = height * depth_, radius = std::sqrt(std::max(0.0, down * (2.0 - down)));
  return frame_.toWorld(Vec3(radius * onUnitCircle(azimuth), 1.0 - down));
}

DomeTable::Sample DomeTable::sample(const Vec2& u) const {
  const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u.x);
  const int cell = static_cast<int>(it - cumulative_.begin());
  const double below = cell > 0 ? cumulative_[cell - 1] : 0.0, chance = *it - below;
  const double within = std::clamp((u.x - below) / chance, 0.0, 1.0);
  const Vec3 towards = direction((cell % kSectors + within) / kSectors, (cell / kSectors + u.y) / kRings);
  return {towards, chance * kRings * kSectors / (2.0 * kPi * depth_)};
}

double DomeTable::pdf(const Vec3& towards) const {
  const Vec3 local = frame_.toLocal(towards);
  const double height = (1.0 - local.z) / depth_;
  if (!(height <= 1.0)) return 0.0;
  const double azimuth = std::atan2(local.y, local.x) / (2.0 * kPi);
  const int ring = std::clamp(static_cast<int>(height * kRings), 0, kRings - 1);
  const int sector = std::clamp(static_cast<int>((azimuth < 0 ? azimuth + 1.0 : azimuth) * kSectors), 0, kSectors - 1);
  const int cell = ring * kSectors + sector;
  const double chance = cumulative_[cell] - (cell > 0 ? cumulative_[cell - 1] : 0.0);
  return chance * kRings * kSectors / (2.0 * kPi * depth_);
}

}  // namespace deltalux::scene
