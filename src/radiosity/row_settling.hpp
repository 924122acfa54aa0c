#pragma once
// Light settles over rows again after a few of them have changed: only rows are gathered whose senders have changed
// since, and only what stands above changed leaves is averaged anew. A row knows the regions of its senders as a set of
// 64 bits, so that the rest of a street is passed over in a nanosecond a row. Gauss-Seidel would converge no faster
// here: two or three passes do.
// Cost: one look at each row a pass, and rows whose senders' light changed by more than kSeen; 30 bytes an element.
#include "radiosity/leaf_transfers.hpp"

namespace deltalux {

class RowSettling {
 public:
  /// From settled light: rows were last gathered with the radiosities that there are.
  RowSettling(const LeafTransfers&, const Elements&);

  /// Gathers, after the rows of `changed` leaves have, or are gone (their direct light is up to date), until rows
  /// have heard of all radiosity but for `tolerated` [W, gray] or `most` passes are done. Returns what they have not
  /// heard of, which the next call takes up; adds to `passes`.
  RgbSum settle(const LeafTransfers&, Elements&, std::span<const ElementId> changed, double tolerated, int most,
                std::uint64_t& passes);

 private:
  void label(const Elements&);
  RgbSum unheard(const Elements&) const;
  std::uint64_t regionsOf(const LeafRow&) const;

  std::vector<std::uint8_t> region_;  // by element; a label that it keeps, wherever it moves
  std::vector<std::uint64_t> from_;   // by element: regions that its row reads; none: it has no row
  std::vector<Rgb> seen_;             // by element: radiosity that rows were gathered with
  std::vector<ElementId> unheard_;    // leaves whose radiosity may be another by now; ascending
};

}  // namespace deltalux
