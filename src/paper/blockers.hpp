#pragma once
// Candidate blockers of a link: handed down from parent to child link and shrunk by the child's shaft. An empty list
// proves that the ends see each other in full; one polygon across the whole shaft proves that they do not. Both without
// a ray, and both hold until something moves.
#include <vector>

#include "hierarchy/element.hpp"
#include "paper/shaft.hpp"

namespace deltalux::paper {

/// Clusters and input-level patches that may stand between the ends of a link.
using Blockers = std::vector<hierarchy::ElementId>;

/// What is left of `candidates` between receiver and sender. Clusters that meet the shaft are opened while the list is
/// short. Appends to `out`.
void shrinkBlockers(const hierarchy::Elements&, const Scene&, hierarchy::ElementId receiver,
                    hierarchy::ElementId sender, const hierarchy::ElementId* candidates, std::size_t count,
                    Blockers& out);

/// Whether one opaque polygon of `candidates` separates every point of the receiver's box from every point of the
/// sender's box.
bool provablyBlocked(const hierarchy::Elements&, const Scene&, hierarchy::ElementId receiver,
                     hierarchy::ElementId sender, const hierarchy::ElementId* candidates, std::size_t count);

}  // namespace deltalux::paper
