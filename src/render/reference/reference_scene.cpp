#include "render/reference/reference_scene.hpp"

#include "scene/texture_tint.hpp"

namespace deltalux::rendering {

namespace {

Scene prepare(const Scene& scene, bool diffuseOnly) {
  Scene copy = diffuseOnly ? diffuseOnlyScene(scene) : scene;
  addAreaLights(copy);
  return copy;
}

const Texture* textureOf(const Scene& scene, PrimitiveId p) {
  const TextureId texture = scene::diffuseTexture(scene, p);
  return texture.valid() ? &scene.textures[texture.index()] : nullptr;
}

/// Barycentric coordinates of the point of triangle a b c nearest to p in its plane.
Vec3 barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 n = glm::cross(b - a, c - a);
  const double squared = glm::dot(n, n);
  if (!(squared > 0.0)) return {1, 0, 0};
  const double v = glm::dot(glm::cross(p - a, c - a), n) / squared;
  const double w = glm::dot(glm::cross(b - a, p - a), n) / squared;
  return {1 - v - w, v, w};
}

}  // namespace

Scene diffuseOnlyScene(Scene scene) {
  for (Material& material : scene.materials) {
    if (auto* opaque = std::get_if<Opaque>(&material.surface)) {
      opaque->specular = {};
    } else if (auto* trans = std::get_if<Trans>(&material.surface)) {
      trans->reflection = trans->transmission = {};
    } else if (!std::holds_alternative<ThinGlass>(material.surface)) {
      material.surface = Opaque{};
    }
  }
  return scene;
}

ReferenceScene::ReferenceScene(const Scene& scene, bool diffuseOnly, std::shared_ptr<const tracing::RayTracer> rays)
    : scene_(prepare(scene, diffuseOnly)),
      lights_(scene_),
      rays_(rays ? std::move(rays) : tracing::makeEmbreeTracer(scene_)) {
  for (const Material& material : scene_.materials) {
    for (bool front : {false, true}) {
      bsdfs_.push_back(scene::makeBsdf(material, front));
      bsdfs_.back().paneReflects = !diffuseOnly;
    }
  }
  for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
    textured_.push_back(textureOf(scene_, PrimitiveId(i)) != nullptr);
  }
}

Rgb ReferenceScene::tint(PrimitiveId p, std::uint32_t triangle, const Vec3& position) const {
  const Texture* texture = textureOf(scene_, p);
  if (!texture) return Rgb(1.0f);
  const Mesh& mesh = std::get<Mesh>(scene_[p].shape);
  const auto& t = mesh.triangles[triangle];
  const Vec3 w = barycentric(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], position);
  return texture->sample(w.x * mesh.texcoords[t[0]] + w.y * mesh.texcoords[t[1]] + w.z * mesh.texcoords[t[2]]);
}

}  // namespace deltalux::rendering
