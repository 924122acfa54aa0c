#include "render/leaf_irradiance.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "radiosity/row_terms.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 512;

/// Rays that bring so much each are as good as independent: their number varies by its root.
float noiseOf(const TransferRow& row, const Elements& elements) {
  double squares = 0;
  forEachTerm(row, [&](std::uint32_t, const RowTerm& t, std::span<const LeafTransfer> transfers) {
    if (t.clear || transfers.empty()) return;
    const double brings = gray(transfers[0].T * elements.radiometry[transfers[0].leaf.index()].B);
    squares += brings * brings;
  });
  return static_cast<float>(std::sqrt(squares));
}

}  // namespace

std::vector<LeafIrradiance> meshIrradiance(const Elements& elements, const Caustics& caustics,
                                           const LeafTransfers& transfers) {
  std::vector<LeafIrradiance> values(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementLight& l = elements.radiometry[i];
    const bool textured = elements.isPatch(ElementId(i)) && elements.domain[i].primitive.valid() &&
                          caustics.of(elements.domain[i].primitive, elements.topology[i].front) != nullptr;
    values[i] = {l.direct, textured ? l.indirect : l.indirect + l.particle};
  }
  const std::span<const LeafRow> rows = transfers.rows();
  parallelFor(rows.size(), kBlock,
              [&](std::size_t i) { values[rows[i].leaf.index()].noise = noiseOf(rows[i].indirect, elements); });
  return values;
}

}  // namespace deltalux
