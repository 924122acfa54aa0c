#pragma once
// The row of one leaf patch: E(leaf) = sum of T B(sender), and which part of it samples which link, so that a part can
// be made anew alone when what it crosses has changed.
#include <vector>

#include "hierarchy/link.hpp"
#include "radiosity/ray_code.hpp"
#include "radiosity/row_reach.hpp"

namespace deltalux::radiosity {

/// E += T * B(leaf). `leaf` is a leaf patch, or an emitter.
struct LeafTransfer {
  hierarchy::ElementId leaf;
  Rgb T{0.0f};
};

/// Rays from a leaf to one sender, and the transfer that they found.
struct RowTerm {
  hierarchy::LinkId link;       // that covers leaf and sender
  hierarchy::ElementId sender;  // the link's, or below it
  float gain = 1;               // by which chance weights it up
  std::uint16_t index = 0;      // indirect: of its one ray; direct: number of rays, 0 where none were needed
  std::uint8_t count = 0;       // transfers: 0 or 1
  bool clear : 1 = false;       // nothing stands between: no ray was traced
  bool measures : 1 = false;    // indirect: its ray measures the kernel, also of a flat sender
};

/// Transfers by term, in the order of the terms.
struct TransferRow {
  std::vector<RowTerm> terms;
  std::vector<LeafTransfer> transfers;
  std::vector<RayCode> rays;  // indirect, by term; of one without a ray: blocked at the leaf
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
  int gatherRays = 128;  // of a leaf, more of those that hold much area or light (gather_rays.hpp)
  int inAll = 1 << 19;   // gatherRays of all leaves together: where leaves are few, each has more, up to 64 times as
                         // many, so that the light of a small scene is as sure as that of a large one
};

}  // namespace deltalux::radiosity
