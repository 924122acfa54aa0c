#pragma once
// Incremental particle tracing [GD01 4.2]: a motion re-emits the links that it affects, each as a whole. Affected are
// the links that cross cells of the octree which gain or lose the object (octree.hpp), and those that end on the object
// or start there. All particles of such a link are taken back and emitted again by the same random numbers, so that
// those the motion did not touch come out as they were, and the particles are in the end those that tracing everything
// in the moved scene gives.
//
// During motion a share of the affected links is emitted again, and the others wait with the particles that they had
// (link_queue.hpp) [GD01 4.3].
// Cost: the rays of the links, and some microseconds a path that comes out changed, for the octree.
#include <optional>

#include "paper/link_queue.hpp"
#include "paper/octree.hpp"
#include "particles/particle_tracing.hpp"

namespace deltalux::paper {

class IncrementalParticles {
 public:
  /// Of the scene's particles, which `tracing` has traced or knows. Both must outlive this.
  IncrementalParticles(const Scene& scene, particles::ParticleTracing& tracing) : scene_(scene), tracing_(tracing) {}

  /// Builds the octree around an object that is to be moved. [GD01 4.1]
  void select(const particles::Particles&, std::span<const PrimitiveId> object);

  /// Takes in an edit that scene and tracer have taken in, and re-emits that share of all links that wait, in (0, 1]. A
  /// share of 1 leaves the particles of a fresh solve. The update holds the paths that have changed, and counts the
  /// particles of all that were emitted again.
  particles::ParticleUpdate follow(particles::Particles&, const SceneChange&, double share);

  /// Links that wait.
  std::size_t waiting() const { return queue_.size(); }
  std::size_t octreeBytes() const { return octree_ ? octree_->memoryBytes() : 0; }
  const std::optional<Octree>& octree() const { return octree_; }

 private:
  using Boxes = std::vector<Box>;

  void collect(const particles::Particles&, const std::vector<SceneChange::Moved>&);
  void grow(const particles::Particles&, const Boxes& object, const Boxes& around);
  particles::ParticleUpdate emit(particles::Particles&, const std::vector<std::uint32_t>& links);
  void registerAgain(const particles::Particles&, const std::vector<particles::RetracedPath>& changed);

  const Scene& scene_;
  particles::ParticleTracing& tracing_;
  std::vector<PrimitiveId> object_;  // that the octree is around, ascending
  std::optional<Octree> octree_;
  LinkQueue queue_;
};

}  // namespace deltalux::paper
