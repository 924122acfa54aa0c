#include "radiosity/leaf_transfers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/direct_sampler.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 64;

bool receives(const Elements& elements, std::size_t e) {
  const ElementTopology& t = elements.topology[e];
  return t.kind == ElementKind::Patch && t.childCount == 0 && !t.emitter && !t.blocker;
}

/// Whether direct light varies over the leaf by more than its surroundings can stand.
bool varies(const Elements& elements, ElementId leaf, const DirectRow& s, const LeafTransferSettings& settings) {
  const ElementGeometry& g = elements.shape(leaf);
  const ElementLight& l = elements.radiometry[leaf.index()];
  const double side = settings.scale * g.meanFreePath, area = side * side;
  if (g.area < settings.finest * settings.error * area) return false;
  const double tolerated =
      settings.variation * settings.error * std::max<double>(l.tolerance, s.mean + gray(l.indirect));
  return s.variation * g.area > tolerated * std::max<double>(area, g.area);
}

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// Rows of one kind: where each begins, and what they hold.
template <class Index>
void validateRows(const std::vector<Index>& begin, const std::vector<LeafTransfer>& transfers, std::size_t leaves,
                  bool ofEmitters, const Elements& elements) {
  if (leaves == 0 && begin.empty()) return require(transfers.empty(), "transfers: rows of leaves");
  require(begin.size() == leaves + 1 && begin.front() == 0 && begin.back() == transfers.size() &&
              std::is_sorted(begin.begin(), begin.end()),
          "transfers: rows");
  for (const LeafTransfer& t : transfers) {
    require(t.leaf.index() < elements.size(), "transfer: sender");
    const ElementTopology& s = elements.at(t.leaf);
    require(ofEmitters == (s.emitter || s.kind != ElementKind::Patch), "transfer: direct from lights, indirect not");
    for (int c = 0; c < 3; ++c) require(std::isfinite(t.T[c]) && t.T[c] >= 0, "transfer: finite and not negative");
  }
}

}  // namespace

LeafTransferReport LeafTransfers::build(Elements& elements, const Links& links, const Scene& scene,
                                        const RayTracer& tracer, const LeafTransferSettings& settings) {
  LeafTransferReport report;
  std::vector<DirectRow> rows(elements.size());
  std::vector<ElementId> fresh;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (receives(elements, i)) fresh.push_back(ElementId(i));
  while (!fresh.empty()) {
    {
      const DirectSampler sampler(scene, elements, links, tracer);
      rows.resize(elements.size());
      parallelFor(fresh.size(), kBlock,
                  [&](std::size_t i) { rows[fresh[i].index()] = sampler.at(fresh[i], settings.shadowRays); });
    }
    std::vector<ElementId> next;
    for (const ElementId leaf : fresh) {
      DirectRow& s = rows[leaf.index()];
      report.rays += s.rays;
      if (!varies(elements, leaf, s, settings) || !subdivide(elements, scene, leaf)) continue;
      ++report.split;
      s = {};
      for (std::size_t c = 0; c < elements.at(leaf).childCount; ++c) next.push_back(elements.child(leaf, c));
    }
    fresh = std::move(next);
  }

  leaves_.clear(), lights_.clear(), transfers_.clear();
  rows.resize(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (receives(elements, i)) leaves_.push_back(ElementId(i));
  lightBegin_.assign(1, 0);
  for (const ElementId leaf : leaves_) {
    const DirectRow& row = rows[leaf.index()];
    lights_.insert(lights_.end(), row.lights.begin(), row.lights.end());
    elements.geometry[leaf.index()].exposed = row.exposed;
    lightBegin_.push_back(static_cast<std::uint32_t>(lights_.size()));
  }
  gatherDirect(elements);
  pull(elements);

  const IndirectSampler sampler(scene, elements, links, tracer);
  std::vector<std::vector<LeafTransfer>> blocks((leaves_.size() + kBlock - 1) / kBlock);
  std::vector<std::uint32_t> counts(leaves_.size());
  std::vector<std::uint64_t> rays(blocks.size(), 0);
  parallelBlocks(leaves_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    auto& block = blocks[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = block.size();
      rays[begin / kBlock] += sampler.atLeaf(leaves_[i], settings.gatherRays, block);
      counts[i] = static_cast<std::uint32_t>(block.size() - before);
    }
  });
  begin_.assign(1, 0);
  for (const std::uint32_t n : counts) begin_.push_back(begin_.back() + n);
  transfers_.reserve(begin_.back());
  for (auto& block : blocks) {
    transfers_.insert(transfers_.end(), block.begin(), block.end());
    std::vector<LeafTransfer>().swap(block);
  }
  for (const std::uint64_t n : rays) report.rays += n;
  return report;
}

std::size_t LeafTransfers::memoryBytes() const {
  return transfers_.capacity() * sizeof(LeafTransfer) + lights_.capacity() * sizeof(LeafTransfer) +
         leaves_.capacity() * (sizeof(ElementId) + sizeof(std::uint64_t) + sizeof(std::uint32_t));
}

void LeafTransfers::gatherDirect(Elements& elements) const {
  parallelFor(leaves_.size(), kBlock, [&](std::size_t i) {
    Rgb sum(0.0f);
    for (std::uint32_t k = lightBegin_[i]; k < lightBegin_[i + 1]; ++k)
      sum += lights_[k].T * elements.radiometry[lights_[k].leaf.index()].B;
    elements.radiometry[leaves_[i].index()].direct = sum;
  });
}

void LeafTransfers::gatherIndirect(Elements& elements) const {
  parallelFor(leaves_.size(), kBlock, [&](std::size_t i) {
    Rgb sum(0.0f);
    for (std::uint64_t k = begin_[i]; k < begin_[i + 1]; ++k)
      sum += transfers_[k].T * elements.radiometry[transfers_[k].leaf.index()].B;
    elements.radiometry[leaves_[i].index()].indirect = sum;
  });
}

void LeafTransfers::validate(const Elements& elements) const {
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    require(leaves_[i].index() < elements.size() && receives(elements, leaves_[i].index()), "transfers: of leaves");
    require(i == 0 || leaves_[i - 1].index() < leaves_[i].index(), "transfers: each leaf once, in order");
  }
  validateRows(lightBegin_, lights_, leaves_.size(), true, elements);
  validateRows(begin_, transfers_, leaves_.size(), false, elements);
}

}  // namespace deltalux
