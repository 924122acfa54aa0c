#pragma once
// The scene as the reference integrator wants it: a copy with its lights listed, scattering looked up per material and
// side, and the rays.
#include <deltalux/scene.hpp>
#include <memory>
#include <vector>

#include "scene/bsdf.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::rendering {

/// `scene` with speculars off: lobes dropped, mirrors and refracting bodies black; panes stay.
Scene diffuseOnlyScene(Scene scene);

class ReferenceScene {
 public:
  /// `rays`: over a scene of the same primitives; made here where there are none.
  ReferenceScene(const Scene&, bool diffuseOnly, std::shared_ptr<const tracing::RayTracer> rays = nullptr);

  const Scene& scene() const { return scene_; }
  const tracing::RayTracer& rays() const { return *rays_; }
  const scene::LightSampler& lights() const { return lights_; }
  /// Scattering of a primitive's side, textures left out.
  const scene::Bsdf& bsdf(PrimitiveId p, bool front) const {
    return bsdfs_[2 * scene_[p].material.index() + (front ? 1 : 0)];
  }
  /// The diffuse colour's factor at a point of a textured mesh; 1 elsewhere.
  Rgb tint(PrimitiveId, std::uint32_t triangle, const Vec3& position) const;
  bool isTextured(PrimitiveId p) const { return textured_[p.index()]; }
  /// Whether connections may go over that side's mirror: not inside refracting bodies, where light is absorbed.
  bool isConnectableMirror(PrimitiveId p, bool front) const { return front || !body(p); }
  /// Medium behind the front of a dielectric; null for all else.
  const Dielectric* body(PrimitiveId p) const { return std::get_if<Dielectric>(&scene_.materialOf(p).surface); }

 private:
  Scene scene_;
  scene::LightSampler lights_;
  std::shared_ptr<const tracing::RayTracer> rays_;
  std::vector<scene::Bsdf> bsdfs_;
  std::vector<char> textured_;
};

}  // namespace deltalux::rendering
