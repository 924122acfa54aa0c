// How rows follow moves of geometry: only those are looked at that touched or changed links bring light to, and of
// those only terms are made anew that a changed link covers or whose ray meets what moved.
#include <algorithm>
#include <array>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/direct_rows.hpp"
#include "radiosity/indirect_sampler.hpp"
#include "radiosity/leaf_transfers.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 64;
constexpr std::uint32_t kNone = Id<void>::kNone;

/// Changed links by what they arrive at, kept apart: from lights, and from surfaces.
class ChangedLinks {
 public:
  ChangedLinks(const Elements& elements, const Links& links, std::span<const LinkId> changed) : elements_(elements) {
    for (auto& next : next_) next.assign(elements.size(), {});
    nextOfLink_.resize(changed.size(), kNone), ids_.assign(changed.begin(), changed.end());
    for (std::uint32_t i = 0; i < changed.size(); ++i) {
      const Link& l = links[changed[i]];
      std::uint32_t& first = next_[elements.at(l.sender).emitter][l.receiver.index()].first;
      nextOfLink_[i] = std::exchange(first, i);
    }
    for (auto& next : next_)
      for (std::size_t e = 0; e < elements.size(); ++e) {
        const ElementId up = elements.topology[e].parent;  // parents stand before their children
        next[e].nearest = next[e].first != kNone ? ElementId(e) : up.valid() ? next[up.index()].nearest : ElementId();
      }
  }

  bool any(ElementId leaf, bool ofEmitters) const { return next_[ofEmitters][leaf.index()].nearest.valid(); }

  /// Those that arrive at the leaf or above it.
  std::vector<LinkId> at(ElementId leaf, bool ofEmitters) const {
    std::vector<LinkId> out;
    const auto& next = next_[ofEmitters];
    for (ElementId e = next[leaf.index()].nearest; e.valid();) {
      for (std::uint32_t i = next[e.index()].first; i != kNone; i = nextOfLink_[i]) out.push_back(ids_[i]);
      const ElementId up = elements_.at(e).parent;
      e = up.valid() ? next[up.index()].nearest : ElementId();
    }
    return out;
  }

 private:
  struct Arriving {
    std::uint32_t first = kNone;  // in ids_
    ElementId nearest;            // the element or the nearest above it that any arrive at
  };
  const Elements& elements_;
  std::array<std::vector<Arriving>, 2> next_;
  std::vector<std::uint32_t> nextOfLink_;
  std::vector<LinkId> ids_;
};

/// Whether what moved may have covered some of the leaf, or may cover it now.
bool uncovers(const Elements& elements, ElementId leaf, const SpaceChange& space) {
  constexpr float kNear = 0.1f;  // of the leaf's radius
  const ElementGeometry& g = elements.shape(leaf);
  return space.meets(g.lower - kNear * g.radius, g.upper + kNear * g.radius);
}

}  // namespace

void LeafTransfers::dropNoLeaves(const Elements& elements) {
  std::erase_if(rows_, [&](const LeafRow& r) { return !elements.isReceivingLeaf(r.leaf); });
}

std::vector<std::uint32_t> LeafTransfers::rowsByElement(const Elements& elements) const {
  std::vector<std::uint32_t> rowOf(elements.size(), kNone);
  for (std::size_t i = 0; i < rows_.size(); ++i) rowOf[rows_[i].leaf.index()] = static_cast<std::uint32_t>(i);
  return rowOf;
}

ConcernedLeaves LeafTransfers::concerned(const Elements& elements, const Links& links, const LinkMarks& marks,
                                         std::span<const LinkId> changedLinks, const SpaceChange& space) {
  dropNoLeaves(elements);
  const auto rowOf = rowsByElement(elements);
  const ChangedLinks changed(elements, links, changedLinks);
  // By element: whether touched links arrive at it or above it, from surfaces and from lights.
  std::array<std::vector<char>, 2> touched;
  for (auto& t : touched) t.assign(elements.size(), 0);
  for (const LinkId id : marks.touched)
    if (links[id].state != LinkState::Free)
      touched[elements.at(links[id].sender).emitter][links[id].receiver.index()] = 1;
  const bool inScene = space.within(elements.sceneBox);  // else rays to lights at infinity may go on to it
  ConcernedLeaves out;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementId e(i), up = elements.at(e).parent;  // parents stand before their children
    for (auto& t : touched) t[i] |= up.valid() && t[up.index()];
    if (!elements.isReceivingLeaf(e)) continue;
    const bool anew = rowOf[i] == kNone || space.moved(e);
    const auto reached = [&](bool ofLights) {
      const LeafRow& row = rows_[rowOf[i]];
      const RowReach& r = ofLights ? row.direct.reach : row.indirect.reach;
      return touched[ofLights][i] && ((ofLights && !inScene) || space.meets(r.lower, r.upper));
    };
    if (anew || reached(true) || changed.any(e, true) || uncovers(elements, e, space)) out.byLights.push_back(e);
    if (anew || reached(false) || changed.any(e, false)) out.byLeaves.push_back(e);
  }
  return out;
}

LeafUpdateReport LeafTransfers::update(Elements& elements, const Links& links, const Scene& scene,
                                       const RayTracer& tracer, const LeafTransferSettings& settings,
                                       const LinkMarks& marks, std::span<const LinkId> changedLinks,
                                       const SpaceChange& space, const ConcernedLeaves& leaves) {
  LeafUpdateReport report;
  std::vector<std::uint32_t> rowOf = rowsByElement(elements);
  const std::size_t known = elements.size();
  const ChangedLinks changed(elements, links, changedLinks);
  const auto isNew = [&](ElementId leaf) { return rowOf[leaf.index()] == kNone || space.moved(leaf); };

  std::vector<char> anew(leaves.byLights.size(), 0);
  std::vector<DirectUpdate> renewed(anew.size());
  std::vector<std::uint64_t> rays(anew.size(), 0);
  {
    const DirectSampler sampler(scene, elements, links, tracer);
    parallelFor(anew.size(), kBlock, [&](std::size_t i) {
      const ElementId leaf = leaves.byLights[i];
      anew[i] = isNew(leaf) || uncovers(elements, leaf, space);
      if (anew[i]) return;
      renewed[i] = sampler.update(leaf, settings.shadowRays, marks.changes, changed.at(leaf, true), space,
                                  rows_[rowOf[leaf.index()]].direct, rays[i]);
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
                                                     if (leaf.index() >= known) {
                                                       rowOf.resize(elements.size(), kNone);
                                                       grown.push_back(leaf);
                                                     }
                                                     std::uint32_t& at = rowOf[leaf.index()];
                                                     if (at == kNone) {
                                                       at = static_cast<std::uint32_t>(rows_.size());
                                                       rows_.push_back({leaf, {}, {}});
                                                     }
                                                     rows_[at].direct = std::move(row);
                                                   });
  report.rays += direct.rays, report.split = direct.split;
  for (std::size_t i = 0; i < anew.size(); ++i)
    if (anew[i] || renewed[i].any) report.leaves.push_back(leaves.byLights[i]);
  report.leaves.insert(report.leaves.end(), grown.begin(), grown.end());
  std::erase_if(report.leaves, [&](ElementId e) { return !elements.isReceivingLeaf(e); });
  for (const ElementId leaf : report.leaves) gatherDirect(rows_[rowOf[leaf.index()]], elements);
  pull(elements, report.leaves);

  std::vector<ElementId> indirect = leaves.byLeaves;
  indirect.insert(indirect.end(), grown.begin(), grown.end());
  std::erase_if(indirect, [&](ElementId e) { return !elements.isReceivingLeaf(e); });
  rays.assign(indirect.size(), 0);
  std::vector<char> done(indirect.size(), 0);
  const IndirectSampler sampler(scene, elements, links, tracer);
  parallelFor(indirect.size(), kBlock, [&](std::size_t i) {
    const ElementId leaf = indirect[i];
    TransferRow& row = rows_[rowOf[leaf.index()]].indirect;
    if (row.terms.empty()) {
      row = sampler.atLeaf(leaf, settings.gatherRays, rays[i]);
      done[i] = 1;
    } else {
      done[i] = sampler.update(leaf, marks.changes, changed.at(leaf, false), space, settings.gatherRays, row, rays[i]);
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
