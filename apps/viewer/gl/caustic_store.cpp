#include "gl/caustic_store.hpp"

#include <algorithm>
#include <limits>

#include "gl/mesh_store.hpp"

namespace deltalux::viewer::gl {

namespace {
struct CausticVertex {
  glm::vec3 position;
  std::uint32_t side;
  glm::vec2 uv, material;
};

/// Coordinates of the material's texture at a point of the side: those of the nearest triangle, at the nearest point
/// of its plane. Linear between vertices: exact where the side maps its texture by one map.
glm::vec2 materialTexcoord(const SurfaceMesh& s, const glm::vec3& p) {
  glm::vec2 result(0.0f);
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t t = 0; t + 2 < s.triangles.size(); t += 3) {
    const MeshVertex &a = s.vertices[s.triangles[t]], &b = s.vertices[s.triangles[t + 1]],
                     &c = s.vertices[s.triangles[t + 2]];
    const glm::vec3 u = b.position - a.position, v = c.position - a.position, w = p - a.position, n = glm::cross(u, v);
    const float squared = glm::dot(n, n);
    if (!(squared > 0)) continue;
    const float x = glm::dot(glm::cross(w, v), n) / squared, y = glm::dot(glm::cross(u, w), n) / squared;
    // How far it is outside the triangle, in parts of its edges, and off its plane.
    const float outside = std::max({-x, -y, x + y - 1, 0.0f});
    const float away =
        outside * outside * std::max(glm::dot(u, u), glm::dot(v, v)) + glm::dot(w, n) * glm::dot(w, n) / squared;
    if (away >= least) continue;
    least = away;
    result = a.uv + x * (b.uv - a.uv) + y * (c.uv - a.uv);
  }
  return result;
}

Extent extentOfCaustic(const CausticMesh& c) {
  Extent e;
  if (!c.vertices.empty()) e.lower = e.upper = c.vertices[0].position;
  for (const CausticMesh::Vertex& v : c.vertices)
    e.lower = glm::min(e.lower, v.position), e.upper = glm::max(e.upper, v.position);
  return e;
}

/// `surface`: of the side, where its material has a texture; otherwise null.
void showCaustic(CausticStore::Shown& shown, std::uint32_t side, const CausticMesh& c, const SurfaceMesh* surface,
                 std::uint64_t& uploaded) {
  shown.side = side;
  shown.extent = extentOfCaustic(c);
  shown.indices = c.texels.empty() ? 0 : static_cast<std::uint32_t>(c.triangles.size());
  if (shown.indices == 0) return;
  std::vector<CausticVertex> vertices;
  vertices.reserve(c.vertices.size());
  for (const CausticMesh::Vertex& v : c.vertices)
    vertices.push_back(
        {v.position, side, v.texcoord, surface ? materialTexcoord(*surface, v.position) : glm::vec2(0.0f)});
  shown.vertices.assign(vertices.data(), vertices.size() * sizeof(CausticVertex), uploaded);
  shown.triangles.assign(c.triangles.data(), c.triangles.size() * sizeof(std::uint32_t), uploaded);
  shown.texels.assign(kRgba32F, c.width, c.height, c.texels.data(), uploaded);
  shown.texels.setFilter(GL_LINEAR, GL_LINEAR);
  shown.texels.setWrap(GL_CLAMP_TO_BORDER, GL_CLAMP_TO_BORDER);  // its colour is 0 where nobody sets one
  if (shown.array) return;
  glBindVertexArray(shown.array.name());
  glBindBuffer(GL_ARRAY_BUFFER, shown.vertices.name());
  constexpr auto stride = static_cast<GLsizei>(sizeof(CausticVertex));
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, offset(offsetof(CausticVertex, position)));
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, stride, offset(offsetof(CausticVertex, side)));
  glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, stride, offset(offsetof(CausticVertex, uv)));
  glVertexAttribPointer(4, 2, GL_FLOAT, GL_FALSE, stride, offset(offsetof(CausticVertex, material)));
  for (const GLuint attribute : {0u, 1u, 2u, 4u}) glEnableVertexAttribArray(attribute);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, shown.triangles.name());
  glBindVertexArray(0);
}
}  // namespace

std::uint64_t CausticStore::update(const std::shared_ptr<const SolutionMesh>& now) {
  std::uint64_t uploaded = 0;
  if (now == mesh_) return uploaded;
  const std::shared_ptr<const SolutionMesh> before = std::exchange(mesh_, now);
  sides_.resize(mesh_->caustics.size());
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const SurfaceCausticMesh* was = before && i < before->caustics.size() ? before->caustics[i].get() : nullptr;
    const SurfaceCausticMesh* is = mesh_->caustics[i].get();
    if (was == is || (was && is && was->version == is->version)) continue;
    sides_[i].resize(is ? is->textures.size() : 0);
    const TextureId material = textureOf(*mesh_->scene, PrimitiveId(i / 2));
    const SurfaceMesh* textured = material.valid() ? mesh_->surfaces[i].get() : nullptr;
    for (std::size_t t = 0; t < sides_[i].size(); ++t) {
      sides_[i][t].material = textured ? material : TextureId();
      showCaustic(sides_[i][t], static_cast<std::uint32_t>(i), is->textures[t], textured, uploaded);
    }
  }
  return uploaded;
}

}  // namespace deltalux::viewer::gl
