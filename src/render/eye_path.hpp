#pragma once
// Radiance along a ray from the eye: the light that leaves the diffuse part of what it meets is read from the
// reconstruction, and mirrors, panes, lobes and glass bodies are followed by ray casting [GD01 6]. Each surface with a
// non-diffuse part continues with one sampled direction; the first pane or smooth body that a path meets with what it
// reflects and what it lets pass: by chance, a lamp mirrored in a window at night would be specks.
//
// Lights in a rough lobe: those that look smaller than the lobe is wide are met by the shadow rays of the surface,
// larger ones by the lobe's own rays; never by both.
#include "caustics/caustics.hpp"
#include "render/eye_trail.hpp"
#include "render/reconstruction.hpp"
#include "render/sight.hpp"
#include "scene/bsdf.hpp"

namespace deltalux::rendering {

struct EyeRay {
  tracing::Ray ray;
  std::uint64_t key = 0;      // names the stratified numbers of its pixel ...
  std::uint32_t index = 0;    // ... and which of them are this ray's
  EyeTrail* trail = nullptr;  // notes where the path goes
};

struct EyeSettings {
  int shadowRays = 4;  // at each diffuse surface; 0: direct light from the mesh
  int maxDepth = 24;   // non-diffuse events
};

class EyePaths {
 public:
  /// Both must outlive this.
  EyePaths(const Solution&, const Reconstruction&, EyeSettings);

  /// [W/(sr m2)]; `sights` learn what leaves they do not know.
  Rgb radiance(const EyeRay&, Sights& sights) const;
  /// What the diffuse parts of a surface send back from where it was hit [W/(sr m2)]. Direct light is the leaf's own,
  /// not blended: over small bright spots that would make light, or lose it.
  Rgb diffuse(const tracing::Hit&) const;
  /// Notes the places that radiance() would look at the lights from.
  void survey(const EyeRay&, Sights& sights) const;

 private:
  struct Vertex;
  /// A rough lobe that a path came from: which lights its surface's shadow rays have already met.
  struct Lobe {
    Vec3 position;
    float roughness = 0;
  };

  /// A path as far as it has come.
  struct Way {
    tracing::Ray ray;
    Rgb beta{1.0f};              // of its radiance, what reaches the eye
    bool clear = true;           // from a camera, by way of mirrors and clear things alone: sees what only is seen
    std::optional<Lobe> lobe{};  // of the surface before
    int depth = 0;               // non-diffuse events
    bool parted = false;         // once, into what a surface reflects and what it lets pass
    std::uint8_t corner = PixelSample::kEye;  // of the trail, that it comes from
  };
  Rgb follow(Way, const EyeRay&, Sights&) const;
  void survey(Way, const EyeRay&, Sights&) const;
  /// False where next to nothing is left.
  bool go(Way&, const Vertex&, const scene::Bsdf&, const scene::BsdfSample&, bool lightsMet) const;
  /// The way on; where there are two, the other one comes first: visit(Way).
  template <class Visit>
  bool goOn(Way&, const Vertex&, const scene::Bsdf&, const EyeRay&, bool lightsMet, const Visit&) const;
  Rgb background(const Way&) const;
  Rgb emitted(const Way&, const Vertex&) const;
  Rgb scattered(const Vertex&, const EyeRay&, int depth, Sights&, bool& lightsMet) const;
  Rgb irradiance(const Vertex&, bool front, const scene::Bsdf* lobes, const EyeRay&, int depth, Sights&,
                 Rgb& glossy) const;
  bool metByShadowRays(LightId, const Lobe&) const;
  const scene::Bsdf& bsdf(PrimitiveId p, bool front) const {
    return bsdfs_[2 * scene_[p].material.index() + (front ? 1 : 0)];
  }

  const Scene& scene_;
  const hierarchy::Elements& elements_;
  const caustics::Caustics& caustics_;
  const tracing::RayTracer& tracer_;
  const Reconstruction& reconstruction_;
  EyeSettings settings_;
  bool panesReflect_;
  std::vector<scene::Bsdf> bsdfs_;
  std::vector<char> goesOn_;  // per material: whether light goes on from there other than diffusely
};

}  // namespace deltalux::rendering
