#pragma once
// A walk over the terms of a row and the transfers that belong to each.
#include <algorithm>
#include <span>

#include "radiosity/leaf_row.hpp"

namespace deltalux::radiosity {

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

/// Takes the terms out for which goes(term), with what belongs to them; returns how many transfers that are.
template <class Goes>
std::size_t drop(TransferRow& row, const Goes& goes) {
  std::size_t from = 0, terms = 0, transfers = 0;
  for (std::size_t i = 0; i < row.terms.size(); ++i) {
    const RowTerm t = row.terms[i];
    const std::size_t begin = from;
    from += t.count;
    if (goes(t)) continue;
    if (terms < i) {
      std::copy_n(row.transfers.begin() + begin, t.count, row.transfers.begin() + transfers);
      if (!row.rays.empty()) row.rays[terms] = row.rays[i];
      row.terms[terms] = t;
    }
    ++terms, transfers += t.count;
  }
  const std::size_t gone = row.transfers.size() - transfers;
  row.terms.resize(terms), row.transfers.resize(transfers);
  if (!row.rays.empty()) row.rays.resize(terms);
  return gone;
}

}  // namespace deltalux::radiosity
