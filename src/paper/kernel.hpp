#pragma once
// The unoccluded transfer K of a link, and how much it varies over both ends, from the same evaluations [SIL95 II.C;
// BW96]. What K multiplies depends on the kind of sender:
//
//   patch     radiosity B [W/m2]       K = form factor from receiver to sender
//   cluster   intensity I(w) [W/sr]    K = mean of cos / d^2
//   point     intensity [W/sr]         K = mean of (relative intensity) cos / d^2
//   distant   radiance [W/(sr m2)]     K = integral of cos over the solid angle
//
// A cluster receiver has no cosine: K then gives the irradiance of a plane that faces the sender, and each surface
// below takes its own cosine when the light is pushed down. Near flat senders use Lambert's formula, exact however
// close; everything else is quadrature over the nodes, with the kernel of a disc where points nearly touch.
#include "hierarchy/element.hpp"

namespace deltalux::paper {

struct Kernel {
  float K = 0;
  float receiverSpread = 0;  // bound on |K(x) - K| over the receiver
  float senderSpread = 0;    // bound on |K(y) - K| over the sender
  bool averted = false;      // provably nothing passes between the ends, whatever stands between them
  bool overlapping = false;  // the boxes of the ends overlap and one is a cluster: must be refined
};

Kernel kernel(const hierarchy::Elements&, const Scene&, hierarchy::ElementId receiver, hierarchy::ElementId sender);

/// Kernel between two surface points, per sender area (patch), or whole for point senders; for distant senders `y` is
/// the direction towards them. Weights of visibility samples.
double pointKernel(const hierarchy::Elements&, const Scene&, const Vec3f& x, const Vec3f& n,
                   hierarchy::ElementId sender, const Vec3f& y, const Vec3f& m);

}  // namespace deltalux::paper
