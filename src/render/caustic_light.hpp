#pragma once
// The particles' irradiance where caustic textures show it.
#include "caustics/caustics.hpp"

namespace deltalux::rendering {

/// E at a surface point [W/m2]; nullopt where the mesh shows the particles. `triangle`: of a mesh.
inline std::optional<Rgb> causticLight(const caustics::Caustics& caustics, const Scene& scene, PrimitiveId primitive,
                                       std::uint32_t triangle, bool front, const Vec3& position) {
  const caustics::SurfaceCaustics* s = caustics.of(primitive, front);
  if (!s) return std::nullopt;
  SurfacePoint p;
  p.position = position;
  p.triangle = triangle;
  if (!s->charts.all.empty() && s->charts.all[0].closed()) p.uv = parameterAt(scene[primitive].shape, position);
  return s->irradianceAt(p);
}

}  // namespace deltalux::rendering
