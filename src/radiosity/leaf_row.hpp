#pragma once
// The row of one leaf patch: E(leaf) = sum of T B(sender), and which part of it samples which link, so that a part can
// be made anew alone when what it crosses has changed.
#include <vector>

#include "hierarchy/link.hpp"

namespace deltalux {

/// E += T * B(leaf). `leaf` is a leaf patch, or an emitter.
struct LeafTransfer {
  ElementId leaf;
  Rgb T{0.0f};
};

/// Rays from a leaf to one sender, and the transfer that they found.
struct RowTerm {
  LinkId link;             // that covers leaf and sender
  ElementId sender;        // the link's, or below it
  float gain = 1;          // by which chance weights it up
  std::uint8_t index = 0;  // indirect: of its one ray; direct: number of rays, 0 where none were needed
  std::uint8_t count = 0;  // transfers: 0 or 1
  bool clear = false;      // nothing stands between: no ray was traced
  std::uint8_t unused = 0;
};

/// Transfers by term, in the order of the terms.
struct TransferRow {
  std::vector<RowTerm> terms;
  std::vector<LeafTransfer> transfers;
  float weightPerRay = 0;  // how rays are shared out: by what a term may bring [W/m2]
};

}  // namespace deltalux
