#include "radiosity/direct_rows.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/parted_leaf.hpp"

namespace deltalux::radiosity {

namespace {

constexpr std::size_t kRowBlock = 8;  // a row takes a tenth of a millisecond or more, and updates make few

/// The area that variation over a leaf is weighed against.
double scaleAround(const hierarchy::ElementGeometry& g, const LeafTransferSettings& settings) {
  const double side = settings.scale * g.meanFreePath;
  return side * side;
}

/// Whether a leaf is so large that it may be split. `finer`: by which smaller leaves are, too.
bool isLarge(const hierarchy::ElementGeometry& g, const LeafTransferSettings& settings, double finer = 1) {
  return finer * g.area >= settings.finest * settings.error * scaleAround(g, settings);
}

/// Whether a variation of direct light over the leaf is more than its surroundings, where there is about as much light
/// as `level`, can stand.
bool exceeds(double variation, double level, const hierarchy::Elements& elements, hierarchy::ElementId leaf,
             const LeafTransferSettings& settings, double finer = 1) {
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  if (!isLarge(g, settings, finer)) return false;
  const double tolerated = settings.variation * settings.error * level;
  return variation * g.area > tolerated * std::max<double>(scaleAround(g, settings), g.area);
}

double levelAround(const hierarchy::ElementLight& l, double direct) {
  return std::max<double>(l.tolerance, direct + gray(l.indirect));
}

bool varies(const DirectRow& row, const hierarchy::Elements& elements, hierarchy::ElementId leaf,
            const LeafTransferSettings& settings) {
  return exceeds(row.variation, levelAround(elements.radiometry[leaf.index()], row.mean), elements, leaf, settings);
}

/// Whether light on a part of the leaf would shine where there is none of it, behind what stands on the leaf.
bool leaks(const DirectRow& row, const hierarchy::Elements& elements, const Scene& scene,
           const tracing::RayTracer& tracer, hierarchy::ElementId leaf, const LeafTransferSettings& settings) {
  constexpr double kFiner = 16;
  const hierarchy::ElementLight& l = elements.radiometry[leaf.index()];
  const double dark = std::min<double>(l.tolerance, gray(l.indirect));
  return exceeds(row.variation, dark, elements, leaf, settings, kFiner) &&
         standsBetween(elements, scene, tracer, leaf, row.darkest, row.brightest);
}

/// Splits leaves along walls that cross them. Returns what is left whole, and the parts; adds to `split`.
std::vector<hierarchy::ElementId> alongWalls(std::vector<hierarchy::ElementId> leaves, hierarchy::Elements& elements,
                                             const Scene& scene, const LeafTransferSettings& settings,
                                             std::size_t& split) {
  std::vector<hierarchy::ElementId> whole;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const hierarchy::ElementId leaf = leaves[i];
    if (!isLarge(elements.shape(leaf), settings) || !hierarchy::wallsAcross(elements, scene, leaf) ||
        !hierarchy::subdivide(elements, scene, leaf)) {
      whole.push_back(leaf);
      continue;
    }
    ++split;
    for (std::size_t c = 0; c < elements.at(leaf).childCount; ++c) leaves.push_back(elements.child(leaf, c));
  }
  return whole;
}

}  // namespace

DirectRowsReport sampleDirectRows(std::vector<hierarchy::ElementId> leaves, hierarchy::Elements& elements,
                                  const hierarchy::Links& links, const Scene& scene, const tracing::RayTracer& tracer,
                                  const LeafTransferSettings& settings,
                                  const std::function<void(hierarchy::ElementId, TransferRow)>& keep) {
  DirectRowsReport report;
  std::vector<DirectRow> rows;
  std::vector<char> splits;
  while (!leaves.empty()) {
    leaves = alongWalls(std::move(leaves), elements, scene, settings, report.split);
    rows.assign(leaves.size(), {}), splits.assign(leaves.size(), 0);
    {
      const DirectSampler sampler(scene, elements, links, tracer);
      parallelFor(leaves.size(), kRowBlock, [&](std::size_t i) {
        rows[i] = sampler.at(leaves[i], settings.shadowRays);
        splits[i] = varies(rows[i], elements, leaves[i], settings) ||
                    leaks(rows[i], elements, scene, tracer, leaves[i], settings);
      });
    }
    std::vector<hierarchy::ElementId> parts;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      report.rays += rows[i].rays;
      if (!splits[i] || !hierarchy::subdivide(elements, scene, leaves[i])) {
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

bool mayVary(const hierarchy::Elements& elements, hierarchy::ElementId leaf, const DirectUpdate& update,
             const LeafTransferSettings& settings) {
  constexpr double kOneOfFour = 1.7320508;  // standard deviation over quadrants, per mean, of what one of them has
  constexpr double kBesides = 2;            // the lights that are what they were vary, too
  const double most = kOneOfFour * update.change + kBesides * update.variation;
  return most > 0 && exceeds(most / elements.shape(leaf).exposed, levelAround(elements.radiometry[leaf.index()], 0.0),
                             elements, leaf, settings);
}

}  // namespace deltalux::radiosity
