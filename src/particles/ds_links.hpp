#pragma once
// The links that particles travel: pairs of a sender node and a receiver node that together cover every pair of cells
// once, refined from the roots where there is much flux and where the ends are large against their distance, see each
// other partly, or reflect unevenly [GD01 2.1]. Diffuse-to-diffuse links know only of diffuse light; these are a tree
// of their own, because the particles must depend on the scene alone and not on how its solution came about.
//
// A link's flux is estimated by a few first segments of its own, followed over one event (other numbers than the
// particles': deciding and measuring by the same would lose the links that they happen to underrate), its senders'
// exitance by coarse_exitance. Refinement does not know how many particles are asked for, so more of them contain the
// fewer. Cost: 8 pilots a node of the link tree, 24 where the ends are near, up to 2048 where much may be hidden
// (flux_estimate.hpp); 0.4 microseconds each.
#include "particles/coarse_exitance.hpp"
#include "particles/emission.hpp"

namespace deltalux::particles {

struct DsLink {
  LinkEnds ends;
  std::uint64_t key = 0;  // of both ends: names the particles
  float flux = 0;         // estimate of what passes on other than diffusely, gray [W]; never 0
  float passing = 0;      // estimate of the share of samples that arrive
  float albedo = 1;       // greatest of the receiver
};

struct DsLinks {
  std::vector<DsLink> all;  // ascending by key
  double flux = 0;          // summed
  std::uint64_t rays = 0, evaluated = 0;
};

struct DsSettings {
  double share = 0x1p-14;  // of all flux: links with less are not refined
  double otherFlux = 0;    // of links besides these, gray [W]
  std::uint64_t seed = 1;
};

/// From the given sender nodes to all receivers.
DsLinks refineDsLinks(const Scene&, const tracing::RayTracer&, const ParticleEmission&, const Senders&,
                      const Receivers&, const CoarseExitance&, std::span<const std::uint32_t> senderRoots,
                      const DsSettings& = {});

}  // namespace deltalux::particles
