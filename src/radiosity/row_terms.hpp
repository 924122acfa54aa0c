#pragma once
// A walk over the terms of a row and the transfers that belong to each.
#include <span>

#include "radiosity/leaf_row.hpp"

namespace deltalux {

/// visit(index, term, its transfers) for every term, in order.
template <class Visit>
void forEachTerm(const TransferRow& row, const Visit& visit) {
  std::span<const LeafTransfer> rest(row.transfers);
  for (std::uint32_t i = 0; i < row.terms.size(); ++i) {
    const RowTerm& t = row.terms[i];
    visit(i, t, rest.first(t.count));
    rest = rest.subspan(t.count);
  }
}

}  // namespace deltalux
