#include "base/check.hpp"
#include "render/light_meter.hpp"
#include "solution/light_columns.hpp"
#include "solution/solution.hpp"

namespace deltalux {

std::vector<ProbeResult> probe(const SolutionView& solution, std::span<const ProbePoint> points,
                               const ProbeSettings& settings, Progress* progress) {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the error is a fraction between 0 and 1");
  const rendering::Reconstruction reconstruction(solution.get());
  return rendering::measureAll(rendering::LightMeter(solution.get(), reconstruction), points, settings, progress);
}

std::vector<std::vector<ProbeResult>> probeByLight(const SolutionView& solution, std::span<const ProbePoint> points,
                                                   const ProbeSettings& settings, Progress* progress) {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the error is a fraction between 0 and 1");
  std::vector<std::vector<ProbeResult>> results(lightGroups(solution).size());
  GroupLight light(solution);
  std::unique_ptr<const rendering::Reconstruction> shown;
  for (std::size_t g = 0; g < results.size(); ++g) {
    light.show(g);
    const Solution& alone = light.view().get();
    shown = std::make_unique<const rendering::Reconstruction>(alone, shown.get());
    results[g] = rendering::measureAll(rendering::LightMeter(alone, *shown), points, settings, progress);
  }
  return results;
}

}  // namespace deltalux
