#include "solution/solution.hpp"

#include <bit>

#include "base/random.hpp"
#include "hierarchy/leaf_table.hpp"

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

SolutionHashes hashesOf(const Solution& s) {
  SolutionHashes hashes;
  for (const hierarchy::ElementId leaf : hierarchy::LeafTable(s.elements).leaves)
    hashes.mesh +=
        combineKeys(s.elements.key[leaf.index()], std::bit_cast<std::uint32_t>(s.elements.shape(leaf).exposed));
  if (!s.lines.empty()) hashes.lines = s.lines.hash(s.elements.key);
  hashes.particles = s.particles.hash();
  return hashes;
}

}  // namespace deltalux
