#include "radiosity/leaf_transfers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/direct_sampler.hpp"
#include "radiosity/indirect_sampler.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 64;
constexpr float kMostReturned = 0.98f;  // of what a closed cavity of this leaf's kind would send to it

bool receives(const Elements& elements, std::size_t e) {
  const ElementTopology& t = elements.topology[e];
  return t.kind == ElementKind::Patch && t.childCount == 0 && !t.emitter && !t.blocker;
}

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

/// Whether the leaf is to be split for its direct light.
bool varies(const Elements& elements, ElementId leaf, const DirectRow& s, const LeafTransferSettings& settings) {
  return exceeds(s.variation, s.mean, elements, leaf, settings);
}

/// Whether a change of the leaf's direct light may be worth a split: all of it may come to one quadrant.
bool mayVary(const Elements& elements, ElementId leaf, double change, const LeafTransferSettings& settings) {
  constexpr double kOneOfFour = 1.7320508;  // standard deviation over quadrants, per mean, of what one of them has
  return change > 0 && exceeds(kOneOfFour * change, 0.0, elements, leaf, settings);
}

/// Whether what moved may have covered some of the leaf, or may cover it now.
bool uncovers(const Elements& elements, ElementId leaf, const SpaceChange& space) {
  constexpr float kNear = 0.1f;  // of the leaf's radius
  const ElementGeometry& g = elements.shape(leaf);
  return space.meets(g.lower - kNear * g.radius, g.upper + kNear * g.radius);
}

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

void validateRow(const TransferRow& row, bool ofEmitters, const Elements& elements, const Links& links) {
  std::size_t count = 0;
  for (const RowTerm& t : row.terms) {
    require(t.link.index() < links.size() && t.sender.index() < elements.size(), "transfer: link and sender");
    require(std::isfinite(t.gain) && t.gain > 0, "transfer: gain");
    count += t.count;
  }
  require(count == row.transfers.size() && std::isfinite(row.weightPerRay), "transfers: by term");
  for (const LeafTransfer& t : row.transfers) {
    require(t.leaf.index() < elements.size(), "transfer: sender");
    const ElementTopology& s = elements.at(t.leaf);
    require(ofEmitters == (s.emitter || s.kind != ElementKind::Patch), "transfer: direct from lights, indirect not");
    for (int c = 0; c < 3; ++c) require(std::isfinite(t.T[c]) && t.T[c] >= 0, "transfer: finite and not negative");
  }
}

/// Rows are of whole leaves, irradiance is that of the part that is not covered.
Rgb gatheredFromLights(const LeafRow& row, const Elements& elements) {
  Rgb sum(0.0f);
  for (const LeafTransfer& t : row.direct.transfers) sum += t.T * elements.radiometry[t.leaf.index()].B;
  return sum / elements.shape(row.leaf).exposed;
}

/// Form factors sum to no more than one; by chance a row may exceed it. Where that would send back more than comes,
/// light between such leaves would grow without end: the row is scaled down.
Rgb gatheredFromLeaves(const LeafRow& row, const Elements& elements) {
  Rgb sum(0.0f), factors(0.0f);
  for (const LeafTransfer& t : row.indirect.transfers) {
    sum += t.T * elements.radiometry[t.leaf.index()].B;
    factors += t.T;
  }
  const ElementLight& light = elements.radiometry[row.leaf.index()];
  const float limit = std::max(1.0f, kMostReturned / std::max(maxChannel(light.rho + light.tau), 1e-3f));
  const float most = maxChannel(factors), exposed = elements.shape(row.leaf).exposed;
  return sum / std::max(exposed, most / limit);
}

}  // namespace

template <class Keep>
void LeafTransfers::sampleDirect(std::vector<ElementId> fresh, Elements& elements, const Links& links,
                                 const Scene& scene, const RayTracer& tracer, const LeafTransferSettings& settings,
                                 LeafTransferReport& report, const Keep& keep) {
  std::vector<DirectRow> rows;
  while (!fresh.empty()) {
    rows.assign(fresh.size(), {});
    {
      const DirectSampler sampler(scene, elements, links, tracer);
      parallelFor(fresh.size(), kBlock, [&](std::size_t i) { rows[i] = sampler.at(fresh[i], settings.shadowRays); });
    }
    std::vector<ElementId> next;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      report.rays += rows[i].rays;
      if (!varies(elements, fresh[i], rows[i], settings) || !subdivide(elements, scene, fresh[i])) {
        elements.geometry[fresh[i].index()].exposed = rows[i].exposed;
        keep(fresh[i], std::move(rows[i].row));
        continue;
      }
      ++report.split;
      for (std::size_t c = 0; c < elements.at(fresh[i]).childCount; ++c) next.push_back(elements.child(fresh[i], c));
    }
    fresh = std::move(next);
  }
}

LeafTransferReport LeafTransfers::build(Elements& elements, const Links& links, const Scene& scene,
                                        const RayTracer& tracer, const LeafTransferSettings& settings) {
  LeafTransferReport report;
  std::vector<ElementId> fresh;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (receives(elements, i)) fresh.push_back(ElementId(i));
  rows_.clear();
  sampleDirect(std::move(fresh), elements, links, scene, tracer, settings, report,
               [&](ElementId leaf, TransferRow row) {
                 rows_.push_back({leaf, std::move(row), {}});
               });
  std::sort(rows_.begin(), rows_.end(), [](const LeafRow& a, const LeafRow& b) { return a.leaf < b.leaf; });
  gatherDirect(elements);
  pull(elements);

  const IndirectSampler sampler(scene, elements, links, tracer);
  std::vector<std::uint64_t> rays((rows_.size() + kBlock - 1) / kBlock, 0);
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) {
    rows_[i].indirect = sampler.atLeaf(rows_[i].leaf, settings.gatherRays, rays[i / kBlock]);
  });
  for (const std::uint64_t n : rays) report.rays += n;
  return report;
}

LeafUpdateReport LeafTransfers::update(Elements& elements, const Links& links, const Scene& scene,
                                       const RayTracer& tracer, const LeafTransferSettings& settings,
                                       const LinkMarks& marks, std::span<const LinkId> changed,
                                       const SpaceChange& space) {
  LeafUpdateReport report;
  // Rows of patches that are leaves no more go; their children have none yet.
  std::erase_if(rows_, [&](const LeafRow& r) { return !receives(elements, r.leaf.index()); });
  constexpr std::uint32_t kNone = Id<void>::kNone;
  std::vector<std::uint32_t> rowOf(elements.size(), kNone);
  for (std::size_t i = 0; i < rows_.size(); ++i) rowOf[rows_[i].leaf.index()] = static_cast<std::uint32_t>(i);

  // What a change of a link can reach lies below its receiver.
  std::vector<char> below(elements.size(), 0);
  for (const LinkId id : marks.touched)
    if (links[id].receiver.valid()) below[links[id].receiver.index()] = 1;
  std::unordered_map<std::uint32_t, std::vector<LinkId>> arriving;
  for (const LinkId id : changed) {
    below[links[id].receiver.index()] = 1;
    arriving[links[id].receiver.value].push_back(id);
  }
  std::vector<ElementId> candidates;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementTopology& t = elements.topology[i];
    if (t.parent.valid() && below[t.parent.index()]) below[i] = 1;  // parents stand before their children
    if (receives(elements, i) && (below[i] || rowOf[i] == kNone || space.moved(ElementId(i))))
      candidates.emplace_back(i);
  }
  report.examined = candidates.size();
  const auto isNew = [&](ElementId leaf) {
    return leaf.index() >= rowOf.size() || rowOf[leaf.index()] == kNone || space.moved(leaf);
  };
  const auto changedAt = [&](ElementId leaf, bool ofEmitters) {
    std::vector<LinkId> out;
    for (ElementId e = leaf; e.valid(); e = elements.at(e).parent) {
      const auto at = arriving.find(e.value);
      if (at == arriving.end()) continue;
      for (const LinkId id : at->second)
        if (elements.at(links[id].sender).emitter == ofEmitters) out.push_back(id);
    }
    return out;
  };

  std::vector<char> anew(candidates.size(), 0);
  std::vector<DirectUpdate> renewed(candidates.size());
  std::vector<std::uint64_t> directRays(candidates.size(), 0);
  {
    const DirectSampler sampler(scene, elements, links, tracer);
    parallelFor(candidates.size(), kBlock, [&](std::size_t i) {
      const ElementId leaf = candidates[i];
      anew[i] = isNew(leaf) || !changedAt(leaf, true).empty() || uncovers(elements, leaf, space);
      if (anew[i]) return;
      renewed[i] = sampler.update(leaf, marks.changes, space, rows_[rowOf[leaf.index()]].direct, directRays[i]);
      anew[i] = renewed[i].anew || mayVary(elements, leaf, renewed[i].change, settings);
    });
  }

  std::vector<ElementId> fresh;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (anew[i]) fresh.push_back(candidates[i]);
    report.direct += renewed[i].any && !anew[i];
    report.rays += directRays[i];
  }
  report.direct += fresh.size();
  LeafTransferReport direct;
  sampleDirect(std::move(fresh), elements, links, scene, tracer, settings, direct,
               [&](ElementId leaf, TransferRow row) {
                 rowOf.resize(elements.size(), kNone);
                 if (rowOf[leaf.index()] == kNone) {
                   rowOf[leaf.index()] = static_cast<std::uint32_t>(rows_.size());
                   rows_.push_back({leaf, {}, {}});
                   if (leaf.index() >= below.size() || !below[leaf.index()]) candidates.push_back(leaf);
                 }
                 rows_[rowOf[leaf.index()]].direct = std::move(row);
               });
  report.rays += direct.rays, report.split = direct.split;
  gatherDirect(elements);
  pull(elements);
  const IndirectSampler sampler(scene, elements, links, tracer);
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::erase_if(candidates, [&](ElementId e) { return !receives(elements, e.index()); });
  std::vector<std::uint64_t> rays(candidates.size(), 0);
  std::vector<char> done(candidates.size(), 0);
  parallelFor(candidates.size(), kBlock, [&](std::size_t i) {
    const ElementId leaf = candidates[i];
    TransferRow& row = rows_[rowOf[leaf.index()]].indirect;
    if (isNew(leaf) || row.terms.empty()) {
      row = sampler.atLeaf(leaf, settings.gatherRays, rays[i]);
      done[i] = 1;
    } else {
      done[i] = sampler.update(leaf, marks.changes, changedAt(leaf, false), space, row, rays[i]);
    }
  });
  for (std::size_t i = 0; i < candidates.size(); ++i) report.rays += rays[i], report.indirect += done[i] != 0;
  std::erase_if(rows_, [&](const LeafRow& r) { return !receives(elements, r.leaf.index()); });
  return report;
}

std::size_t LeafTransfers::memoryBytes() const {
  std::size_t bytes = rows_.capacity() * sizeof(LeafRow);
  for (const LeafRow& r : rows_)
    for (const TransferRow* row : {&r.direct, &r.indirect})
      bytes += row->terms.capacity() * sizeof(RowTerm) + row->transfers.capacity() * sizeof(LeafTransfer);
  return bytes;
}

void LeafTransfers::gatherDirect(Elements& elements) const {
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) {
    elements.radiometry[rows_[i].leaf.index()].direct = gatheredFromLights(rows_[i], elements);
  });
}

void LeafTransfers::gatherIndirect(Elements& elements) const {
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) {
    elements.radiometry[rows_[i].leaf.index()].indirect = gatheredFromLeaves(rows_[i], elements);
  });
}

void LeafTransfers::validate(const Elements& elements, const Links& links) const {
  std::vector<char> has(elements.size(), 0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ElementId leaf = rows_[i].leaf;
    require(leaf.index() < elements.size() && receives(elements, leaf.index()), "transfers: of leaves");
    require(!has[leaf.index()], "transfers: each leaf once");
    has[leaf.index()] = 1;
    validateRow(rows_[i].direct, true, elements, links);
    validateRow(rows_[i].indirect, false, elements, links);
  }
}

}  // namespace deltalux
