// How rows follow moves of geometry: only those are looked at that changed links bring light to or whose rays may meet
// what moved, and of those only terms are made anew that a changed link covers or whose ray does meet it.
#include <algorithm>
#include <utility>

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "base/sort_unique.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/pull.hpp"
#include "radiosity/arriving_links.hpp"
#include "radiosity/direct_rows.hpp"
#include "radiosity/indirect_sampler.hpp"
#include "radiosity/leaf_transfers.hpp"
#include "radiosity/moved_rays.hpp"

namespace deltalux::radiosity {

namespace {

constexpr std::size_t kUpdateBlock = 64;
constexpr std::size_t kFew = 8;  // a row made from nothing takes as long as looking at fifty, and those stand together
constexpr int kByLights = 1, kByLeaves = 2;  // which row of a leaf is concerned

/// Whether what moved may have covered some of the leaf, or may cover it now.
bool uncovers(const hierarchy::Elements& elements, hierarchy::ElementId leaf, const paper::SpaceChange& space) {
  const Box beside = SurfaceReaches::beside(elements.shape(leaf));
  return space.meets(Vec3f(beside.lower), Vec3f(beside.upper));
}

/// Which rows of a leaf a move may change by itself. `hidden`: it is known to see nothing of what moves; then only rays
/// that are blocked may lead elsewhere. `inScene`: else rays to lights at infinity may go on to what moves.
int concernedBy(const hierarchy::Elements& elements, const LeafRow& row, const paper::SpaceChange& space, bool inScene,
                bool hidden) {
  if (hidden) return space.meets(row.indirect.reach.objects) ? kByLeaves : 0;
  const hierarchy::ElementGeometry& g = elements.shape(row.leaf);
  bool byLights = !inScene || meets(space, g, row.direct.reach), byLeaves = meets(space, g, row.indirect.reach);
  if ((byLights || byLeaves) && space.hiddenFrom(row.leaf))
    byLights = false, byLeaves = space.meets(row.indirect.reach.objects);
  byLights |= uncovers(elements, row.leaf, space);
  return (byLights ? kByLights : 0) | (byLeaves ? kByLeaves : 0);
}

/// Of the receiving leaves at or below `top` those that are not visited yet.
template <class Visit>
void visitLeaves(const hierarchy::Elements& elements, hierarchy::ElementId top, PagedArray<char>& visited,
                 const Visit& visit) {
  hierarchy::forEachBelow(elements, top, [&](hierarchy::ElementId e) {
    if (std::exchange(visited.at(e.index()), 1)) return false;
    if (elements.isReceivingLeaf(e)) visit(e);
    return true;
  });
}

}  // namespace

/// Rows of what is no receiving leaf any more: what new elements were split off, what sleeps, and of these `inputs`
/// what is gone.
void LeafTransfers::dropNoLeaves(const hierarchy::Elements& elements, std::span<const hierarchy::ElementId> inputs) {
  std::vector<hierarchy::ElementId> stale;
  const auto look = [&](hierarchy::ElementId e) {
    if (find(e) && !elements.isReceivingLeaf(e)) stale.push_back(e);
    return true;
  };
  for (std::size_t i = known_; i < elements.size(); ++i)
    if (const hierarchy::ElementId parent = elements.topology[i].parent; parent.valid()) look(parent);
  for (const hierarchy::ElementId input : inputs) hierarchy::forEachBelow(elements, input, look);
  for (const hierarchy::ElementId input : elements.asleep) hierarchy::forEachBelow(elements, input, look);
  sortUnique(stale);
  for (const hierarchy::ElementId e : stale) {
    const std::uint32_t row = std::exchange(rowOf_[e.index()], kNone);
    surplus_.set(e, 0);
    dropped_.push_back({e, std::move(rows_[row].indirect)});
    if (row + 1 < rows_.size()) {
      rows_[row] = std::move(rows_.back());
      setRow(rows_[row].leaf, row);
    }
    rows_.pop_back();
  }
}

/// The row of the leaf that another was split off; null where there is none, and where what moved may have covered that
/// leaf: its rays are those of the part that was not covered.
const TransferRow* LeafTransfers::inheritance(const hierarchy::Elements& elements, hierarchy::ElementId leaf,
                                              const paper::SpaceChange& space) const {
  for (hierarchy::ElementId e = leaf; e.valid() && elements.at(e).depth > 0;) {
    e = elements.at(e).parent;
    const LeafRow* kept = find(e);  // where it was split just now
    const auto at = std::lower_bound(dropped_.begin(), dropped_.end(), e,
                                     [](const Dropped& d, hierarchy::ElementId other) { return d.leaf < other; });
    const bool dropped = at != dropped_.end() && at->leaf == e;
    if (!kept && !dropped) continue;
    const TransferRow& row = kept ? kept->indirect : at->indirect;
    return row.terms.empty() || uncovers(elements, e, space) ? nullptr : &row;
  }
  return nullptr;
}

void LeafTransfers::listRows(const hierarchy::Elements& elements, const Scene& scene) {
  std::fill(rowOf_.begin(), rowOf_.end(), kNone);
  known_ = 0;
  reaches_ = {};
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    setRow(rows_[i].leaf, i);
    reaches_.add(elements, rows_[i].leaf, rows_[i].direct, rows_[i].indirect);
  }
  surplus_ = {};
  surplus_.resize(elements);
  parallelFor(rows_.size(), kUpdateBlock, [&](std::size_t i) { measure(rows_[i], elements, scene); });
  std::vector<hierarchy::ElementId> concerned;
  surplus_.follow(elements, leaves(), concerned);
}

void LeafTransfers::setRow(hierarchy::ElementId leaf, std::size_t row) {
  if (leaf.index() >= rowOf_.size()) rowOf_.resize(leaf.index() + 1, kNone);
  rowOf_[leaf.index()] = static_cast<std::uint32_t>(row);
}

ConcernedLeaves LeafTransfers::concerned(const hierarchy::Elements& elements, const hierarchy::Links& links,
                                         std::span<const hierarchy::LinkId> changedLinks,
                                         const paper::SpaceChange& space) {
  dropNoLeaves(elements, space.inputs());
  PagedArray<char> found(elements.size());  // bits: kBy
  const auto add = [&](hierarchy::ElementId leaf, int by) {
    found.at(leaf.index()) = static_cast<char>(found[leaf.index()] | by);
  };

  const ArrivingLinks arriving(elements, links, changedLinks);
  arriving.forEach([&](hierarchy::ElementId e, bool fromLights, bool fromLeaves) {
    if (elements.isReceivingLeaf(e)) add(e, (fromLights ? kByLights : 0) | (fromLeaves ? kByLeaves : 0));
  });
  PagedArray<char> visited(elements.size());
  for (const hierarchy::ElementId input : space.inputs())
    visitLeaves(elements, input, visited, [&](hierarchy::ElementId e) { add(e, kByLights | kByLeaves); });
  for (; known_ < elements.size(); ++known_)
    if (const hierarchy::ElementId e(known_); !find(e) && elements.isReceivingLeaf(e)) add(e, kByLights | kByLeaves);

  const bool inScene = space.within(elements.sceneBox);
  const std::vector<hierarchy::ElementId> surfaces = reaches_.met(space, !inScene);
  std::vector<std::vector<std::pair<hierarchy::ElementId, int>>> met((surfaces.size() + kUpdateBlock - 1) /
                                                                     kUpdateBlock);
  parallelFor(surfaces.size(), kUpdateBlock, [&](std::size_t i) {
    const bool hidden = space.hiddenFrom(surfaces[i]);
    hierarchy::forEachLeafBelow(elements, surfaces[i], [&](hierarchy::ElementId e) {
      const LeafRow* row = find(e);
      if (const int by = row ? concernedBy(elements, *row, space, inScene, hidden) : 0)
        met[i / kUpdateBlock].push_back({e, by});
    });
  });
  for (const auto& some : met)
    for (const auto& [leaf, by] : some) add(leaf, by);

  ConcernedLeaves out;
  found.forEach([&](std::size_t e, char by) {
    if (by & kByLights) out.byLights.emplace_back(e);
    if (by & kByLeaves) out.byLeaves.emplace_back(e);
  });
  return out;
}

/// What rows follow.
struct LeafTransfers::Change {
  const hierarchy::Links& links;
  const Scene& scene;
  const tracing::RayTracer& tracer;
  const LeafTransferSettings& settings;
  const paper::LinkMarks& marks;
  const ArrivingLinks& arriving;
  const paper::SpaceChange& space;
};

LeafUpdateReport LeafTransfers::update(hierarchy::Elements& elements, const hierarchy::Links& links, const Scene& scene,
                                       const tracing::RayTracer& tracer, const LeafTransferSettings& settings,
                                       const paper::LinkMarks& marks, std::span<const hierarchy::LinkId> changedLinks,
                                       const paper::SpaceChange& space, const ConcernedLeaves& leaves) {
  LeafUpdateReport report;
  const ArrivingLinks arriving(elements, links, changedLinks);
  const Change change{links, scene, tracer, settings, marks, arriving, space};
  const std::size_t known = elements.size();
  const auto inPart = [&](hierarchy::ElementId e) { return elements.shape(e).exposed < 1.0f; };
  std::vector<char> wasInPart;
  for (const hierarchy::ElementId leaf : leaves.byLights) wasInPart.push_back(inPart(leaf));
  updateDirect(elements, change, leaves.byLights, report);
  for (const hierarchy::ElementId leaf : report.leaves) gatherDirect(rows_[rowOf_[leaf.index()]], elements);
  hierarchy::pull(elements, report.leaves);

  std::vector<hierarchy::ElementId> indirect = leaves.byLeaves, reaching = report.leaves;
  for (const hierarchy::ElementId leaf : report.leaves)
    if (leaf.index() >= known) indirect.push_back(leaf);  // of a leaf that was split
  // Leaves that are covered in part draw other rays than others.
  for (std::size_t i = 0; i < wasInPart.size(); ++i)
    if (const hierarchy::ElementId leaf = leaves.byLights[i]; find(leaf) && inPart(leaf) != bool(wasInPart[i]))
      rows_[rowOf_[leaf.index()]].indirect = {}, indirect.push_back(leaf);
  std::erase_if(indirect, [&](hierarchy::ElementId e) { return !elements.isReceivingLeaf(e); });
  sortUnique(indirect);
  std::sort(dropped_.begin(), dropped_.end(), [](const Dropped& a, const Dropped& b) { return a.leaf < b.leaf; });
  updateIndirect(elements, change, indirect, report, reaching);
  for (const hierarchy::ElementId leaf : reaching)
    if (const LeafRow* row = find(leaf)) reaches_.add(elements, leaf, row->direct, row->indirect);
  dropNoLeaves(elements, space.inputs());
  std::vector<hierarchy::ElementId> others = report.leaves;
  for (const Dropped& d : std::exchange(dropped_, {})) others.push_back(d.leaf);
  surplus_.follow(elements, others, report.leaves);
  sortUnique(report.leaves);
  return report;
}

/// Rows of direct light, and the leaves that these are split into. Adds all whose row is another to the report.
void LeafTransfers::updateDirect(hierarchy::Elements& elements, const Change& change,
                                 std::span<const hierarchy::ElementId> leaves, LeafUpdateReport& report) {
  const auto isNew = [&](hierarchy::ElementId leaf) { return !find(leaf) || change.space.moved(leaf); };
  std::vector<char> anew(leaves.size(), 0);
  std::vector<DirectUpdate> renewed(leaves.size());
  std::vector<std::uint64_t> rays(leaves.size(), 0);
  {
    const DirectSampler sampler(change.scene, elements, change.links, change.tracer);
    parallelFor(leaves.size(), kFew, [&](std::size_t i) {
      const hierarchy::ElementId leaf = leaves[i];
      anew[i] = isNew(leaf) || uncovers(elements, leaf, change.space);
      if (anew[i]) return;
      renewed[i] =
          sampler.update(leaf, change.settings.shadowRays, change.marks.changes, change.arriving.changedAt(leaf, true),
                         change.space, rows_[rowOf_[leaf.index()]].direct, rays[i]);
      anew[i] = renewed[i].anew || mayVary(elements, leaf, renewed[i], change.settings);
    });
  }
  std::vector<hierarchy::ElementId> fresh;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (anew[i]) fresh.push_back(leaves[i]);
    report.rays += rays[i];
    if (!anew[i] && !renewed[i].any) continue;
    report.leaves.push_back(leaves[i]);
  }
  const std::size_t known = elements.size();
  const DirectRowsReport direct =
      sampleDirectRows(std::move(fresh), elements, change.links, change.scene, change.tracer, change.settings,
                       [&](hierarchy::ElementId leaf, TransferRow row) {
                         if (leaf.index() >= known) report.leaves.push_back(leaf);
                         if (!find(leaf)) {
                           setRow(leaf, rows_.size());
                           rows_.push_back({leaf, {}, {}});
                         }
                         rows_[rowOf_[leaf.index()]].direct = std::move(row);
                       });
  report.rays += direct.rays, report.split = direct.split;
  std::erase_if(report.leaves, [&](hierarchy::ElementId e) { return !elements.isReceivingLeaf(e); });
}

/// Rows of indirect light. Adds those that are others to the report, and to `reaching` those with rays elsewhere.
void LeafTransfers::updateIndirect(const hierarchy::Elements& elements, const Change& change,
                                   std::span<const hierarchy::ElementId> leaves, LeafUpdateReport& report,
                                   std::vector<hierarchy::ElementId>& reaching) {
  std::vector<std::uint64_t> rays(leaves.size(), 0);
  std::vector<char> other(leaves.size(), 0), elsewhere(leaves.size(), 0);
  const IndirectSampler sampler(change.scene, elements, change.links, change.tracer);
  const GatherRays gatherRays(change.settings, rows_.size(), mean_);
  surplus_.resize(elements);
  parallelFor(leaves.size(), kFew, [&](std::size_t i) {
    const hierarchy::ElementId leaf = leaves[i];
    if (i + 1 < leaves.size()) {
      const TransferRow& next = rows_[rowOf_[leaves[i + 1].index()]].indirect;
      prefetch(std::span(next.rays)), prefetch(std::span(next.terms));
    }
    const int ofLeaf = gatherRays.of(leaf, elements);
    LeafRow& whole = rows_[rowOf_[leaf.index()]];
    TransferRow& row = whole.indirect;
    const std::vector<hierarchy::LinkId> changed = change.arriving.changedAt(leaf, false);
    if (row.terms.empty()) {
      const TransferRow* from = inheritance(elements, leaf, change.space);
      row = from ? sampler.inherited(leaf, *from, change.marks.changes, changed, ofLeaf, rays[i])
                 : sampler.atLeaf(leaf, ofLeaf, rays[i]);
      other[i] = elsewhere[i] = 1;
    } else {
      const RowReach before = row.reach;
      other[i] = sampler.update(leaf, change.marks.changes, changed, change.space, ofLeaf, row, rays[i]);
      elsewhere[i] = row.reach != before;
    }
    measure(whole, elements, change.scene);
  });
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    report.rays += rays[i];
    if (elsewhere[i]) reaching.push_back(leaves[i]);
    if (!other[i]) continue;
    report.leaves.push_back(leaves[i]);
  }
}

}  // namespace deltalux::radiosity
