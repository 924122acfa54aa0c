#include "solution/solution.hpp"

namespace deltalux {

const Scene& SolutionView::scene() const { return solution_->scene; }
const SolveSettings& SolutionView::settings() const { return solution_->settings; }
const SolveReport& SolutionView::report() const { return solution_->report; }

std::vector<CausticReport> SolutionView::caustics() const {
  std::vector<CausticReport> reports;
  const double unit = scene().metresPerUnit * scene().metresPerUnit;
  for (const caustics::SurfaceCaustics& s : solution_->caustics.surfaces) {
    CausticReport& report = reports.emplace_back();
    const ObjectId object = scene()[s.primitive].object;
    if (object.valid()) report.surface = scene()[object].name;
    report.primitive = s.primitive.index();
    report.front = s.front;
    for (const caustics::CausticTexture& t : s.textures)
      report.textures.push_back(
          {static_cast<std::uint64_t>(t.width), static_cast<std::uint64_t>(t.height), t.particles});
    report.fluxW = unit * gray(s.flux());
  }
  return reports;
}

}  // namespace deltalux
