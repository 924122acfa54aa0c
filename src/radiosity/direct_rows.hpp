#pragma once
// Direct rows of leaves, and the leaves that they need: where direct light varies over a leaf by more than the error
// allows, the leaf is split and its parts sampled in turn.
#include <functional>

#include "radiosity/direct_sampler.hpp"

namespace deltalux::radiosity {

struct DirectRowsReport {
  std::uint64_t rays = 0, split = 0;
};

/// Samples the direct rows of `leaves`, splitting those of `elements` where light varies; calls keep(leaf, row) with
/// each that stays, and sets its exposure.
DirectRowsReport sampleDirectRows(std::vector<hierarchy::ElementId> leaves, hierarchy::Elements& elements,
                                  const hierarchy::Links&, const Scene&, const tracing::RayTracer&,
                                  const LeafTransferSettings&,
                                  const std::function<void(hierarchy::ElementId, TransferRow)>& keep);

/// Whether what an update has found of the leaf's direct light may be worth a split.
bool mayVary(const hierarchy::Elements&, hierarchy::ElementId leaf, const DirectUpdate&, const LeafTransferSettings&);

}  // namespace deltalux::radiosity
