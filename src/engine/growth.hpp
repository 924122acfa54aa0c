#pragma once
// Elements follow the light: sides that had none, because no light reached them when the scene was solved or because
// they were not there, get theirs when edits bring them into the light. They hang below a root of their own, with root
// links to and from everything. Elements of sides that edits left in the dark sleep until light comes again.
#include "engine/scene_update.hpp"
#include "particles/particle_tracing.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

struct Growth {
  hierarchy::ElementId root;                      // of what has grown, or none; its links are still to be made
  std::vector<hierarchy::ElementId> reactivated;  // and they, to be evaluated again
  std::vector<hierarchy::ElementId> inactive;

  bool empty() const { return !root.valid() && reactivated.empty() && inactive.empty(); }
};

/// Leaf patches of what has grown, been reactivated or become inactive.
std::vector<hierarchy::ElementId> leavesBelow(const hierarchy::Elements&, const Growth&);

/// Scene, tracer and particles are those after the edits.
Growth growInLight(Solution&, const SceneUpdate&, const particles::ParticleUpdate&);

}  // namespace deltalux::engine
