#pragma once
// Tracing the particles of a scene, and following its edits: a motion retraces the paths that it can touch and no
// others, and leaves the very particles that tracing everything anew would. [GD01 4]
//
// A path is touched when one of its segments meets the surface of a thing that moved where that is now; when it met the
// thing where it was, or, blocked, was blocked by it; when it starts on the thing; and when its link goes to that
// alone. Paths know what they met, so where things were is no question of geometry; a blocked path knows one thing that
// blocks it, and stays blocked, unasked, as long as that stays. So next to all paths that are touched do change.
// (Departure: the paper keeps an octree whose cells know their links, and emits whole links anew, as
// paper/incremental_particles.hpp does. Here every segment of every path is held against a box, and then against the
// surfaces in it: exact for each path, and no memory.)
// Dimmed lights and new diffuse colours change no path; other lights, other speculars and new things change all.
// Cost: some nanoseconds a path, and the rays of what is touched.
#include <deltalux/edit.hpp>
#include <memory>
#include <optional>

#include "particles/particles.hpp"
#include "particles/path_watch.hpp"

namespace deltalux::particles {

struct ParticlePlan;

/// A path that was traced anew, and what it was: its range still holds that, until particles are made compact.
struct RetracedPath {
  std::uint32_t path = 0;
  std::uint32_t sender = 0, originTriangle = 0;
  PathRange range;
};

struct ParticleUpdate {
  bool all = false;  // everything was traced anew: `paths` is empty, and links, senders and ranges are others
  std::vector<RetracedPath> paths;  // ascending
  std::uint64_t particles = 0;      // of them, those that arrive or did before
  std::uint64_t rays = 0;
};

class ParticleTracing {
 public:
  /// Both must outlive this.
  ParticleTracing(const Scene&, const tracing::RayTracer&, const ParticleSettings&);

  Particles trace();
  /// As many particles as about so much time allows, at most those of the settings: a few are traced first, which tells
  /// what each costs. count() is then theirs: what trace() gives for that count.
  Particles traceWithin(double seconds);
  std::uint64_t count() const { return settings_.count; }

  /// Brings `particles`, which were right before, up to an edit that scene and tracer have taken in.
  ParticleUpdate follow(Particles&, const SceneChange&);

  // The parts of follow(), for who chooses by himself what to trace again.

  /// Whether an edit that the scene has taken in leaves all paths as they are but those that a motion can touch.
  bool looksAsBefore(const SceneChange&) const;
  /// All particles, of the scene as it is.
  ParticleUpdate traceAnew(Particles&);
  /// Which ends of links have moved.
  struct MovedEnds {
    std::vector<char> senders;                 // by cell
    std::vector<Receivers::Motion> receivers;  // by node
  };
  /// Takes in where these primitives are now.
  MovedEnds moveEnds(const Particles&, std::span<const PrimitiveId>);
  /// Traces paths (ascending) again; by the same numbers, so those that nothing touched come out the same.
  ParticleUpdate retrace(Particles&, const std::vector<std::uint32_t>& paths);
  /// By how much paths may be off what they join [scene units].
  double margin() const;

  /// PilotSamples for the paths that motion from here can touch, so that follow() need not.
  void expectMotion(const Particles&, const Box& ofObject);
  /// Of what knows the paths near the motion: the place of the paper's octree.
  std::size_t watchBytes() const { return watch_ ? watch_->memoryBytes() : 0; }

 private:
  /// What first segments are drawn from.
  struct Ends {
    scene::LightSampler lights;
    Senders senders;
    Receivers receivers;
    ParticleEmission emission;

    Ends(const Scene&, const tracing::RayTracer&);
  };
  /// What particles depend on besides shapes.
  struct Look {
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<MaterialId> materialOf;  // by primitive
    double far = 0;

    explicit Look(const Scene&);
  };

  Particles trace(const ParticlePlan&);
  void weigh(const Particles&);
  void watch(const Particles&, std::span<const SceneChange::Moved>);
  void watchAround(const Particles&, const Box&);
  /// The paths that a motion touches, ascending.
  std::vector<std::uint32_t> touched(const Particles&, std::span<const SceneChange::Moved>);

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  ParticleSettings settings_;
  std::unique_ptr<Ends> ends_;
  Look look_;
  bool weighed_ = false;
  std::optional<PathWatch> watch_;
};

}  // namespace deltalux::particles
