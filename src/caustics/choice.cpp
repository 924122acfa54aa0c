#include "caustics/choice.hpp"

#include <algorithm>

#include "base/tuning.hpp"
#include "caustics/heat_flow.hpp"
#include "caustics/tuning.hpp"
#include "hierarchy/tuning.hpp"

namespace deltalux::caustics {

Departure& Departure::operator+=(const Departure& o) {
  excess += o.excess, precision += o.precision;
  squares += o.squares, flux += o.flux, area += o.area;
  return *this;
}

void Departure::add(double difference, const CellNoise& noise) {
  if (!(noise.expected > 0) || !(noise.variance > 0)) return;
  const double z2 = difference * difference / noise.variance;
  // The second is never more than the first, but for rounding where next to nothing is expected.
  const double kurtosis =
      std::max(noise.fourth / (noise.variance * noise.variance), noise.variance / (noise.expected * noise.expected));
  const double varianceOfZ2 = 2 + kurtosis;
  excess += (z2 - 1) / varianceOfZ2;
  precision += 1 / varianceOfZ2;
}

Departure departure(const CellGrid& grid, const CellLight& light) {
  Departure result;
  result.area = grid.totalArea(), result.flux = gray(light.flux);
  const double grain = light.grain();
  if (!(result.area > 0) || !(grain > 0)) return result;

  const CellRaster raster(grid);
  Channels smoothed(3);  // flux, its squares and fourth powers, in grains, over area
  const auto inGrains = [&](const auto& perArea, double unit) {
    std::vector<float> values;
    for (const double v : perArea) values.push_back(static_cast<float>(v / unit));
    return raster.laidOut(values);
  };
  smoothed[0] = inGrains(light.gray, grain);
  smoothed[1] = inGrains(light.squares, grain * grain);
  smoothed[2] = inGrains(light.fourths, grain * grain * grain * grain);
  const double reach = std::sqrt(result.area) / hierarchy::tuning::kGrid;
  HeatFlow(raster, {}).apply(smoothed, 0.5 * reach * reach);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double area = grid.area(i);
    const auto smooth = [&](int channel) {
      return std::max<double>(smoothed[channel][raster.slotOf(static_cast<std::uint32_t>(i))], 0.0);
    };
    const double difference = light.gray[i] / grain - smooth(0);
    result.add(difference * area, {smooth(0) * area, smooth(1) * area, smooth(2) * area});
    result.squares += grain * grain * (area * difference * difference - smooth(1));
  }
  return result;
}

Departure departureBetween(std::span<const PartLight> parts) {
  Departure result;
  PartLight all;
  for (const PartLight& p : parts)
    all.flux += p.flux, all.squares += p.squares, all.fourths += p.fourths, all.area += p.area;
  for (const PartLight& p : parts) {
    if (!(p.area > 0) || !(all.flux > 0)) continue;
    const double share = p.area / all.area, difference = p.flux - share * all.flux;
    result.add(difference, {share * all.flux, share * all.squares, share * all.fourths});
    result.squares += (difference * difference - share * all.squares) / p.area;
  }
  return result;
}

bool tooFew(double flux, double squaredFlux) { return flux * flux <= deltalux::tuning::kPilots * squaredFlux; }

bool deservesTexture(const Departure& d, double error, double background) {
  if (!(d.area > 0) || d.excess <= tuning::kSignificance * std::sqrt(d.precision)) return false;
  const double spread = std::sqrt(std::max(d.squares, 0.0) / d.area);
  return spread > error * (d.flux / d.area + background);
}

}  // namespace deltalux::caustics
