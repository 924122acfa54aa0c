#pragma once
// The row of one leaf patch: E(leaf) = sum of T B(sender), and which part of it samples which link, so that a part can
// be made anew alone when what it crosses has changed.
#include <limits>
#include <vector>

#include "hierarchy/link.hpp"
#include "radiosity/direction_code.hpp"

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

/// A box that holds the leaf and all that the rays of a row pass through, or more.
struct RowReach {
  Vec3f lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

  void add(const Vec3f& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  void add(const ElementGeometry& g) { add(g.lower), add(g.upper); }
};

/// Transfers by term, in the order of the terms.
struct TransferRow {
  std::vector<RowTerm> terms;
  std::vector<LeafTransfer> transfers;
  std::vector<DirectionCode> directions;  // indirect, by term: of its ray, or to the sender where there is none
  RowReach reach;
  float weightPerRay = 0;  // how rays are shared out: by what a term may bring [W/m2]; indirect: relative to the level
                           // of light around the leaf
};

struct LeafTransferSettings {
  double error = 0.05;   // target relative error of irradiance
  double variation = 2;  // of direct light over a leaf that is let stand, relative to `error`
  double scale = 0.15;   // of the mean free path: side of the area that variation is weighed against, as in the oracle
  double finest = 1.0;   // least area of a leaf that is still split: finest * error * that area
  int shadowRays = 64;   // of a leaf
  int gatherRays = 128;  // of a leaf
};

}  // namespace deltalux
