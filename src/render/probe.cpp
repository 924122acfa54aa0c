#include "base/check.hpp"
#include "render/light_meter.hpp"
#include "solution/solution.hpp"

namespace deltalux {

std::vector<ProbeResult> probe(const SolutionView& solution, std::span<const ProbePoint> points,
                               const ProbeSettings& settings, Progress* progress) {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the error is a fraction between 0 and 1");
  const rendering::Reconstruction reconstruction(solution.get());
  return rendering::measureAll(rendering::LightMeter(solution.get(), reconstruction), points, settings, progress);
}

}  // namespace deltalux
