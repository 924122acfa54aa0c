#include "radiosity/leaf_transfers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/parallel.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/pull.hpp"
#include "radiosity/direct_rows.hpp"
#include "radiosity/indirect_sampler.hpp"

namespace deltalux::radiosity {

namespace {

constexpr std::size_t kBlock = 64;

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

void validateRow(const TransferRow& row, bool ofEmitters, const hierarchy::Elements& elements,
                 const hierarchy::Links& links) {
  std::size_t count = 0;
  for (const RowTerm& t : row.terms) {
    require(t.link.index() < links.size() && t.sender.index() < elements.size(), "transfer: link and sender");
    require(std::isfinite(t.gain) && t.gain > 0, "transfer: gain");
    count += t.count;
  }
  require(row.rays.size() == (ofEmitters ? 0 : row.terms.size()), "transfers: a ray a term");
  require(count == row.transfers.size() && std::isfinite(row.weightPerRay), "transfers: by term");
  for (const LeafTransfer& t : row.transfers) {
    require(t.leaf.index() < elements.size(), "transfer: sender");
    const hierarchy::ElementTopology& s = elements.at(t.leaf);
    require(ofEmitters == (s.emitter || s.kind != hierarchy::ElementKind::Patch),
            "transfer: direct from lights, indirect not");
    for (int c = 0; c < 3; ++c) require(std::isfinite(t.T[c]) && t.T[c] >= 0, "transfer: finite and not negative");
  }
}

/// Rows are of whole leaves, irradiance is that of the part that is not covered.
Rgb gatheredFromLights(const LeafRow& row, const hierarchy::Elements& elements) {
  Rgb sum(0.0f);
  for (const LeafTransfer& t : row.direct.transfers) sum += t.T * elements.radiometry[t.leaf.index()].B;
  return sum / elements.shape(row.leaf).exposed;
}

}  // namespace

LeafTransferReport LeafTransfers::build(hierarchy::Elements& elements, const hierarchy::Links& links,
                                        const Scene& scene, const tracing::RayTracer& tracer,
                                        const LeafTransferSettings& settings) {
  LeafTransferReport report;
  std::vector<hierarchy::ElementId> fresh;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements.isReceivingLeaf(hierarchy::ElementId(i))) fresh.push_back(hierarchy::ElementId(i));
  rows_.clear();
  const DirectRowsReport direct = sampleDirectRows(std::move(fresh), elements, links, scene, tracer, settings,
                                                   [&](hierarchy::ElementId leaf, TransferRow row) {
                                                     rows_.push_back({leaf, std::move(row), {}});
                                                   });
  report.rays = direct.rays, report.split = direct.split;
  std::sort(rows_.begin(), rows_.end(), [](const LeafRow& a, const LeafRow& b) { return a.leaf < b.leaf; });
  gatherDirect(elements);
  hierarchy::pull(elements);

  const IndirectSampler sampler(scene, elements, links, tracer);
  std::vector<std::uint64_t> rays((rows_.size() + kBlock - 1) / kBlock, 0);
  mean_ = meanOf(leaves(), elements);
  const GatherRays gatherRays(settings, rows_.size(), mean_);
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) {
    const hierarchy::ElementId leaf = rows_[i].leaf;
    rows_[i].indirect = sampler.atLeaf(leaf, gatherRays.of(leaf, elements), rays[i / kBlock]);
  });
  for (const std::uint64_t n : rays) report.rays += n;
  listRows(elements, scene);
  known_ = elements.size();
  return report;
}

std::vector<hierarchy::ElementId> LeafTransfers::leaves() const {
  std::vector<hierarchy::ElementId> leaves;
  for (const LeafRow& row : rows_) leaves.push_back(row.leaf);
  return leaves;
}

std::size_t LeafTransfers::memoryBytes() const {
  std::size_t bytes = rows_.capacity() * sizeof(LeafRow) + rowOf_.capacity() * sizeof rowOf_[0] +
                      reaches_.memoryBytes() + surplus_.memoryBytes();
  for (const LeafRow& r : rows_)
    for (const TransferRow* row : {&r.direct, &r.indirect})
      bytes += row->terms.capacity() * sizeof(RowTerm) + row->transfers.capacity() * sizeof(LeafTransfer) +
               row->rays.capacity() * sizeof(RayCode);
  return bytes;
}

void LeafTransfers::gatherDirect(const LeafRow& row, hierarchy::Elements& elements) const {
  elements.radiometry[row.leaf.index()].direct = gatheredFromLights(row, elements);
}

void LeafTransfers::gatherIndirect(const LeafRow& row, hierarchy::Elements& elements, const std::vector<Rgb>& B) const {
  Rgb sum(0.0f);
  for (const LeafTransfer& t : row.indirect.transfers) sum += t.T * B[t.leaf.index()];
  elements.radiometry[row.leaf.index()].indirect = surplus_.scale(row.leaf) * sum;
}

void LeafTransfers::gatherDirect(hierarchy::Elements& elements) const {
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) { gatherDirect(rows_[i], elements); });
}

void LeafTransfers::gatherIndirect(hierarchy::Elements& elements) const {
  // Close together, since rows read them in no order.
  std::vector<Rgb> B(elements.size());
  for (std::size_t i = 0; i < B.size(); ++i) B[i] = elements.radiometry[i].B;
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) { gatherIndirect(rows_[i], elements, B); });
  const RowSurplus::Pools pools = surplus_.pools(elements);
  parallelFor(rows_.size(), kBlock, [&](std::size_t i) {
    elements.radiometry[rows_[i].leaf.index()].indirect += surplus_.share(elements, rows_[i].leaf, pools);
  });
}

/// The sum of a row's form factors. Of what is seen through a sender it is the sender's no more.
void LeafTransfers::measure(const LeafRow& row, const hierarchy::Elements& elements, const Scene& scene) {
  Rgb factors(0.0f);
  for (const LeafTransfer& t : row.indirect.transfers) {
    const Material& material = scene.materialOf(elements.domain[t.leaf.index()].primitive);
    factors += passesStraight(material) ? t.T * (Rgb(1.0f) - straightTransmittance(material, 1.0)) : t.T;
  }
  surplus_.set(row.leaf, maxChannel(factors));
}

void LeafTransfers::followReflectance(const hierarchy::Elements& elements,
                                      std::span<const hierarchy::ElementId> painted,
                                      std::vector<hierarchy::ElementId>& leaves) {
  const std::size_t known = leaves.size();
  for (const hierarchy::ElementId e : painted)
    hierarchy::forEachLeafBelow(elements, e, [&](hierarchy::ElementId leaf) {
      if (find(leaf)) leaves.push_back(leaf);
    });
  const std::vector<hierarchy::ElementId> others(leaves.begin() + static_cast<std::ptrdiff_t>(known), leaves.end());
  surplus_.follow(elements, others, leaves);
}

void LeafTransfers::validate(const hierarchy::Elements& elements, const hierarchy::Links& links) const {
  std::vector<char> has(elements.size(), 0);
  if (!rowOf_.empty()) surplus_.validate(elements);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const hierarchy::ElementId leaf = rows_[i].leaf;
    require(leaf.index() < elements.size() && elements.isReceivingLeaf(leaf), "transfers: of leaves");
    require(!has[leaf.index()], "transfers: each leaf once");
    has[leaf.index()] = 1;
    validateRow(rows_[i].direct, true, elements, links);
    validateRow(rows_[i].indirect, false, elements, links);
    if (rowOf_.empty()) continue;  // just read
    require(find(leaf) == &rows_[i], "transfers: leaves know their rows");
    for (const TransferRow* row : {&rows_[i].direct, &rows_[i].indirect})
      require(reaches_.holds(elements, leaf, *row), "transfers: surfaces know what their rows reach");
  }
}

}  // namespace deltalux::radiosity
