#include "render/leaf_irradiance.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "radiosity/row_terms.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kLeafBlock = 512;

/// Rays that bring so much each are as good as independent: their number varies by its root.
float noiseOf(const radiosity::TransferRow& row, const hierarchy::Elements& elements) {
  double squares = 0;
  radiosity::forEachTerm(
      row, [&](std::uint32_t, const radiosity::RowTerm& t, std::span<const radiosity::LeafTransfer> transfers) {
        if (t.clear || transfers.empty()) return;
        const double brings = gray(transfers[0].T * elements.radiometry[transfers[0].leaf.index()].B);
        squares += brings * brings;
      });
  return static_cast<float>(std::sqrt(squares));
}

}  // namespace

std::vector<LeafIrradiance> meshIrradiance(const hierarchy::Elements& elements, const caustics::Caustics& caustics,
                                           const radiosity::LeafTransfers& transfers,
                                           std::span<const float> deviation) {
  std::vector<LeafIrradiance> values(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementLight& l = elements.radiometry[i];
    const bool textured = elements.isPatch(hierarchy::ElementId(i)) && elements.domain[i].primitive.valid() &&
                          caustics.of(elements.domain[i].primitive, elements.topology[i].front) != nullptr;
    values[i] = {l.direct, textured ? l.indirect : l.indirect + l.particle, 0, textured ? Rgb(0.0f) : l.particle};
  }
  std::size_t line = 0;
  for (std::size_t i = 0; i < elements.size() && line < deviation.size(); ++i)
    if (elements.isReceivingLeaf(hierarchy::ElementId(i))) values[i].noise = deviation[line++];
  const std::span<const radiosity::LeafRow> rows = transfers.rows();
  parallelFor(rows.size(), kLeafBlock,
              [&](std::size_t i) { values[rows[i].leaf.index()].noise = noiseOf(rows[i].indirect, elements); });
  return values;
}

}  // namespace deltalux::rendering
