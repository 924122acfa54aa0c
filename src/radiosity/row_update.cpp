// How rows follow moves of geometry: only those are looked at that touched or changed links bring light to, and of
// those only terms are made anew that a changed link covers or whose ray meets what moved.
#include <algorithm>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/arriving_links.hpp"
#include "radiosity/direct_rows.hpp"
#include "radiosity/indirect_sampler.hpp"
#include "radiosity/leaf_transfers.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 64;

/// Whether what moved may have covered some of the leaf, or may cover it now.
bool uncovers(const Elements& elements, ElementId leaf, const SpaceChange& space) {
  constexpr float kNear = 0.1f;  // of the leaf's radius
  const ElementGeometry& g = elements.shape(leaf);
  return space.meets(g.lower - kNear * g.radius, g.upper + kNear * g.radius);
}

}  // namespace

void LeafTransfers::dropNoLeaves(const Elements& elements) {
  if (std::erase_if(rows_, [&](const LeafRow& r) { return !elements.isReceivingLeaf(r.leaf); }) > 0) listRows();
}

void LeafTransfers::listRows() {
  std::fill(rowOf_.begin(), rowOf_.end(), kNone);
  for (std::size_t i = 0; i < rows_.size(); ++i) setRow(rows_[i].leaf, i);
}

void LeafTransfers::setRow(ElementId leaf, std::size_t row) {
  if (leaf.index() >= rowOf_.size()) rowOf_.resize(leaf.index() + 1, kNone);
  rowOf_[leaf.index()] = static_cast<std::uint32_t>(row);
}

ConcernedLeaves LeafTransfers::concerned(const Elements& elements, const Links& links, const LinkMarks& marks,
                                         std::span<const LinkId> changedLinks, const SpaceChange& space) {
  dropNoLeaves(elements);
  const ArrivingLinks arriving(elements, links, marks, changedLinks);
  const bool inScene = space.within(elements.sceneBox);  // else rays to lights at infinity may go on to it
  std::vector<char> byLights(elements.size(), 0), byLeaves(elements.size(), 0);
  parallelFor(elements.size(), 1024, [&](std::size_t i) {
    const ElementId e(i);
    if (!elements.isReceivingLeaf(e)) return;
    const LeafRow* row = find(e);
    const bool anew = !row || space.moved(e);
    const auto reached = [&](bool ofLights) {
      if (!arriving.touched(e, ofLights)) return false;
      return (ofLights && !inScene) ||
             space.meets(elements.shape(e), ofLights ? row->direct.reach : row->indirect.reach);
    };
    byLights[i] = anew || arriving.changed(e, true) || uncovers(elements, e, space) || reached(true);
    byLeaves[i] = anew || arriving.changed(e, false) || reached(false);
  });
  ConcernedLeaves out;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (byLights[i]) out.byLights.emplace_back(i);
    if (byLeaves[i]) out.byLeaves.emplace_back(i);
  }
  return out;
}

LeafUpdateReport LeafTransfers::update(Elements& elements, const Links& links, const Scene& scene,
                                       const RayTracer& tracer, const LeafTransferSettings& settings,
                                       const LinkMarks& marks, std::span<const LinkId> changedLinks,
                                       const SpaceChange& space, const ConcernedLeaves& leaves) {
  LeafUpdateReport report;
  const std::size_t known = elements.size();
  const ArrivingLinks arriving(elements, links, marks, changedLinks);
  const auto isNew = [&](ElementId leaf) { return !find(leaf) || space.moved(leaf); };

  std::vector<char> anew(leaves.byLights.size(), 0);
  std::vector<DirectUpdate> renewed(anew.size());
  std::vector<std::uint64_t> rays(anew.size(), 0);
  {
    const DirectSampler sampler(scene, elements, links, tracer);
    parallelFor(anew.size(), kBlock, [&](std::size_t i) {
      const ElementId leaf = leaves.byLights[i];
      anew[i] = isNew(leaf) || uncovers(elements, leaf, space);
      if (anew[i]) return;
      renewed[i] = sampler.update(leaf, settings.shadowRays, marks.changes, arriving.changedAt(leaf, true), space,
                                  rows_[rowOf_[leaf.index()]].direct, rays[i]);
      anew[i] = renewed[i].anew || mayVary(elements, leaf, renewed[i], settings);
    });
  }
  std::vector<ElementId> fresh, grown;
  for (std::size_t i = 0; i < anew.size(); ++i) {
    if (anew[i]) fresh.push_back(leaves.byLights[i]);
    report.direct += anew[i] || renewed[i].any;
    report.rays += rays[i];
  }
  const DirectRowsReport direct = sampleDirectRows(std::move(fresh), elements, links, scene, tracer, settings,
                                                   [&](ElementId leaf, TransferRow row) {
                                                     if (leaf.index() >= known) grown.push_back(leaf);
                                                     if (!find(leaf)) {
                                                       setRow(leaf, rows_.size());
                                                       rows_.push_back({leaf, {}, {}});
                                                     }
                                                     rows_[rowOf_[leaf.index()]].direct = std::move(row);
                                                   });
  report.rays += direct.rays, report.split = direct.split;
  for (std::size_t i = 0; i < anew.size(); ++i)
    if (anew[i] || renewed[i].any) report.leaves.push_back(leaves.byLights[i]);
  report.leaves.insert(report.leaves.end(), grown.begin(), grown.end());
  std::erase_if(report.leaves, [&](ElementId e) { return !elements.isReceivingLeaf(e); });
  for (const ElementId leaf : report.leaves) gatherDirect(rows_[rowOf_[leaf.index()]], elements);
  pull(elements, report.leaves);

  std::vector<ElementId> indirect = leaves.byLeaves;
  indirect.insert(indirect.end(), grown.begin(), grown.end());
  std::erase_if(indirect, [&](ElementId e) { return !elements.isReceivingLeaf(e); });
  rays.assign(indirect.size(), 0);
  std::vector<char> done(indirect.size(), 0);
  const IndirectSampler sampler(scene, elements, links, tracer);
  const int ofLeaf = gatherRaysOfLeaf(settings, rows_.size());
  parallelFor(indirect.size(), kBlock, [&](std::size_t i) {
    const ElementId leaf = indirect[i];
    TransferRow& row = rows_[rowOf_[leaf.index()]].indirect;
    if (row.terms.empty()) {
      row = sampler.atLeaf(leaf, ofLeaf, rays[i]);
      done[i] = 1;
    } else {
      done[i] = sampler.update(leaf, marks.changes, arriving.changedAt(leaf, false), space, ofLeaf, row, rays[i]);
    }
  });
  for (std::size_t i = 0; i < indirect.size(); ++i) {
    report.rays += rays[i];
    if (!done[i]) continue;
    ++report.indirect;
    report.leaves.push_back(indirect[i]);
  }
  std::sort(report.leaves.begin(), report.leaves.end());
  report.leaves.erase(std::unique(report.leaves.begin(), report.leaves.end()), report.leaves.end());
  dropNoLeaves(elements);
  return report;
}

}  // namespace deltalux
