#include "scene/texture_tint.hpp"

namespace deltalux::scene {

namespace {
/// Coordinates of p along the edges b - a and c - a of a triangle.
Vec2 alongEdges(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 n = glm::cross(b - a, c - a);
  const double squared = glm::dot(n, n);
  if (!(squared > 0)) return Vec2(0.0);
  return {glm::dot(glm::cross(p - a, c - a), n) / squared, glm::dot(glm::cross(b - a, p - a), n) / squared};
}
}  // namespace

TextureId diffuseTexture(const Scene& scene, PrimitiveId primitive) {
  const auto* opaque = std::get_if<Opaque>(&scene.materialOf(primitive).surface);
  const auto* mesh = std::get_if<Mesh>(&scene[primitive].shape);
  return opaque && mesh && !mesh->texcoords.empty() ? opaque->diffuseTexture : TextureId();
}

Rgb textureTint(const Scene& scene, PrimitiveId primitive, std::uint32_t triangle, const Vec3& position) {
  const TextureId texture = diffuseTexture(scene, primitive);
  if (!texture.valid()) return Rgb(1.0f);
  const auto& mesh = std::get<Mesh>(scene[primitive].shape);
  const auto& t = mesh.triangles[triangle];
  const Vec2 uv = alongEdges(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], position);
  const Vec2 a = mesh.texcoords[t[0]], b = mesh.texcoords[t[1]], c = mesh.texcoords[t[2]];
  return scene.textures[texture.index()].sample(a + uv.x * (b - a) + uv.y * (c - a));
}

}  // namespace deltalux::scene
