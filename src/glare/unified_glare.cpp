#include <cmath>

#include "base/parallel.hpp"
#include "glare/background_meter.hpp"
#include "glare/luminaires.hpp"
#include "render/reconstruction.hpp"
#include "render/work_progress.hpp"
#include "solution/solution.hpp"

namespace deltalux {

std::vector<Eye> eyesAllRound(const Vec3& position, const Vec3& along, const Vec3& up, int directions) {
  const Vec3 across = glm::cross(up, along);
  std::vector<Eye> eyes;
  for (int d = 0; d < directions; ++d) {
    const double angle = 2 * kPi * d / directions;
    eyes.push_back({position, std::cos(angle) * along + std::sin(angle) * across, up});
  }
  return eyes;
}

std::vector<UnifiedGlare> unifiedGlare(const SolutionView& solution, std::span<const Eye> eyes,
                                       const GlareSettings& settings, Progress* progress) {
  const Solution& s = solution.get();
  const rendering::Reconstruction reconstruction(s);
  const glare::LuminaireMeter luminaires(s.scene, *s.tracer);
  const glare::BackgroundMeter background(s, reconstruction);
  std::vector<UnifiedGlare> all(eyes.size());
  rendering::WorkProgress work(progress, "glare", eyes.size());
  parallelFor(eyes.size(), 1, [&](std::size_t i) {
    work.begin();
    UnifiedGlare& g = all[i];
    g.eye = eyes[i];
    g.luminaires = luminaires.seen(g.eye);
    g.background = background.lux(g.eye, settings, combineKeys(settings.seed, i)) / kPi;
    std::vector<GlareSource> sources;
    for (const LuminaireSeen& l : g.luminaires) sources.push_back(l.source);
    g.rating = unifiedGlareRating(sources, g.background);
    work.done();
  });
  return all;
}

}  // namespace deltalux
