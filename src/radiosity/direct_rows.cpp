#include "radiosity/direct_rows.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 8;  // a row takes a tenth of a millisecond or more, and updates make few

/// Whether a variation of direct light over the leaf is more than its surroundings can stand.
bool exceeds(double variation, double mean, const Elements& elements, ElementId leaf,
             const LeafTransferSettings& settings) {
  const ElementGeometry& g = elements.shape(leaf);
  const ElementLight& l = elements.radiometry[leaf.index()];
  const double side = settings.scale * g.meanFreePath, area = side * side;
  if (g.area < settings.finest * settings.error * area) return false;
  const double tolerated = settings.variation * settings.error * std::max<double>(l.tolerance, mean + gray(l.indirect));
  return variation * g.area > tolerated * std::max<double>(area, g.area);
}

}  // namespace

DirectRowsReport sampleDirectRows(std::vector<ElementId> leaves, Elements& elements, const Links& links,
                                  const Scene& scene, const RayTracer& tracer, const LeafTransferSettings& settings,
                                  const std::function<void(ElementId, TransferRow)>& keep) {
  DirectRowsReport report;
  std::vector<DirectRow> rows;
  while (!leaves.empty()) {
    rows.assign(leaves.size(), {});
    {
      const DirectSampler sampler(scene, elements, links, tracer);
      parallelFor(leaves.size(), kBlock, [&](std::size_t i) { rows[i] = sampler.at(leaves[i], settings.shadowRays); });
    }
    std::vector<ElementId> parts;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      report.rays += rows[i].rays;
      if (!exceeds(rows[i].variation, rows[i].mean, elements, leaves[i], settings) ||
          !subdivide(elements, scene, leaves[i])) {
        elements.geometry[leaves[i].index()].exposed = rows[i].exposed;
        keep(leaves[i], std::move(rows[i].row));
        continue;
      }
      ++report.split;
      for (std::size_t c = 0; c < elements.at(leaves[i]).childCount; ++c) parts.push_back(elements.child(leaves[i], c));
    }
    leaves = std::move(parts);
  }
  return report;
}

bool mayVary(const Elements& elements, ElementId leaf, const DirectUpdate& update,
             const LeafTransferSettings& settings) {
  constexpr double kOneOfFour = 1.7320508;  // standard deviation over quadrants, per mean, of what one of them has
  constexpr double kBesides = 2;            // the lights that are what they were vary, too
  const double most = kOneOfFour * update.change + kBesides * update.variation;
  return most > 0 && exceeds(most / elements.shape(leaf).exposed, 0.0, elements, leaf, settings);
}

}  // namespace deltalux
