#pragma once
// What surfaces do to particles: which sides take them, and where they go on by the non-diffuse part, sampled as the
// reference integrator samples it (scene/bsdf.hpp). Flux is carried, so refraction changes nothing but the direction.
#include <deltalux/scene.hpp>
#include <optional>
#include <vector>

#include "base/sobol.hpp"
#include "scene/bsdf.hpp"
#include "tracing/ray.hpp"

namespace deltalux::particles {

/// A point of a surface and the side that a particle comes to.
struct SurfaceSpot {
  PrimitiveId primitive;
  std::uint32_t triangle = 0;
  Vec3f position{0.0f}, normal{0.0f};  // of the front
  bool front = true;
};

struct EventNumbers {
  Vec3 scatter{0};
  double roulette = 0;
};

/// Numbers of event `depth` of the samples of a link's key: stratified for the first events.
class EventSequence {
 public:
  EventSequence(std::uint64_t key, int depth);
  EventNumbers operator()(std::uint32_t index) const;

 private:
  std::uint64_t own_;
  bool stratified_;
  ScrambledSobol first_, second_;
};

struct SpecularEvent {
  Vec3f direction;
  Rgb weight;  // of the flux
  bool refracted = false;
};

class ParticleSurfaces {
 public:
  explicit ParticleSurfaces(const Scene&);

  /// Whether particles land on a side: it takes light in other than passing it on or mirroring it.
  bool takes(PrimitiveId p, bool front) const { return side(p, front).takes; }
  bool passesOn(PrimitiveId p, bool front) const { return side(p, front).passesOn; }
  /// What goes straight on beside what is covered.
  const Rgb& passage(PrimitiveId p, bool front) const { return side(p, front).bsdf.passage; }
  bool isPaneAt(PrimitiveId p) const { return panes_[scene_[p].material.index()]; }
  /// Medium behind the front of a dielectric; null for all else.
  const Dielectric* body(PrimitiveId p) const { return bodies_[scene_[p].material.index()]; }

  /// The next non-diffuse event. What the first surface of a path passes straight on belongs to the segment that
  /// arrives behind it, and to diffuse links: it does not go on from there.
  std::optional<SpecularEvent> scatter(const SurfaceSpot&, const Vec3f& direction, bool first,
                                       const EventNumbers&) const;
  /// Parameters of a hit, as Impact has them.
  glm::vec2 parameters(const tracing::Hit&) const;

 private:
  struct Side {
    scene::Bsdf bsdf, first;  // at any surface of a path, and at its first
    bool takes = false, passesOn = false, rough = false;
  };
  const Side& side(PrimitiveId p, bool front) const { return sides_[2 * scene_[p].material.index() + (front ? 1 : 0)]; }

  const Scene& scene_;
  std::vector<Side> sides_;
  std::vector<const Dielectric*> bodies_;  // by material
  std::vector<char> panes_;
};

}  // namespace deltalux::particles
