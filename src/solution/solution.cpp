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
  const hierarchy::LeafTable leaves(s.elements);
  std::vector<std::uint64_t> keys;
  for (const hierarchy::ElementId leaf : leaves.leaves) {
    keys.push_back(s.elements.key[leaf.index()]);
    hashes.mesh += combineKeys(keys.back(), std::bit_cast<std::uint32_t>(s.elements.shape(leaf).exposed));
  }
  if (s.lines.leaves() == leaves.size()) hashes.lines = s.lines.hash(keys);
  hashes.particles = s.particles.hash();
  return hashes;
}

}  // namespace deltalux
