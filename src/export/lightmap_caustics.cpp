#include "export/lightmap_caustics.hpp"

#include <algorithm>
#include <optional>

#include "export/lightmap_side_light.hpp"

namespace deltalux::exporting {

namespace {

std::vector<BoxF> boxesOf(const SurfaceCausticMesh& caustics) {
  std::vector<BoxF> boxes;
  for (const CausticMesh& mesh : caustics.textures)
    for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
      BoxF box;
      for (std::size_t k = 0; k < 3; ++k) box.extend(mesh.vertices[mesh.triangles[i + k]].position);
      boxes.push_back(box);
    }
  return boxes;
}

/// What a texture shows at a texture coordinate: bilinear, its edges held; nullopt: another shows the point, or none.
std::optional<Rgb> shownAt(const CausticMesh& mesh, const glm::vec2& texcoord) {
  const glm::ivec2 size(mesh.width, mesh.height);
  const auto texel = [&](const glm::ivec2& p) {
    const glm::ivec2 q = glm::clamp(p, glm::ivec2(0), size - 1);
    return mesh
        .texels[static_cast<std::size_t>(q.y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(q.x)];
  };
  const glm::vec2 place = texcoord * glm::vec2(size);
  if (texel(glm::ivec2(glm::floor(place))).a < 0.5f) return std::nullopt;
  const glm::vec2 corner = glm::floor(place - 0.5f), f = place - 0.5f - corner;
  const glm::ivec2 i(corner);
  return Rgb(glm::mix(glm::mix(texel(i), texel(i + glm::ivec2(1, 0)), f.x),
                      glm::mix(texel(i + glm::ivec2(0, 1)), texel(i + glm::ivec2(1, 1)), f.x), f.y));
}

/// Side of a square as large as a texel of the texture [scene units]; 0: it shows nothing.
double texelSizeOf(const CausticMesh& mesh) {
  double area = 0, share = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const auto& a = mesh.vertices[mesh.triangles[i]];
    const auto& b = mesh.vertices[mesh.triangles[i + 1]];
    const auto& c = mesh.vertices[mesh.triangles[i + 2]];
    area += double(glm::length(glm::cross(b.position - a.position, c.position - a.position)));
    const glm::vec2 u = b.texcoord - a.texcoord, v = c.texcoord - a.texcoord;
    share += std::abs(double(u.x) * v.y - double(u.y) * v.x);
  }
  return share > 0 ? std::sqrt(area / (share * mesh.width * mesh.height)) : 0;
}

}  // namespace

LightmapCaustics::LightmapCaustics(const SurfaceCausticMesh& caustics) : caustics_(caustics), tree_(boxesOf(caustics)) {
  std::vector<double> sizes;
  for (std::uint32_t t = 0; t < caustics.textures.size(); ++t) {
    for (std::uint32_t i = 0; i + 2 < caustics.textures[t].triangles.size(); i += 3) triangles_.push_back({t, i});
    if (const double size = texelSizeOf(caustics.textures[t]); size > 0) sizes.push_back(size);
  }
  if (sizes.empty()) return;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  texelSize_ = sizes[sizes.size() / 2];
}

Rgb LightmapCaustics::at(const Vec3f& position, float reach) const {
  std::optional<Rgb> found;
  tree_.overlapping({position - reach, position + reach}, [&](std::uint32_t i) {
    if (found) return;
    const CausticMesh& mesh = caustics_.textures[triangles_[i].texture];
    const std::uint32_t* corners = &mesh.triangles[triangles_[i].first];
    const auto &a = mesh.vertices[corners[0]], &b = mesh.vertices[corners[1]], &c = mesh.vertices[corners[2]];
    if (const auto w = weightsOn(a.position, b.position, c.position, position, reach))
      found = shownAt(mesh, a.texcoord + w->x * (b.texcoord - a.texcoord) + w->y * (c.texcoord - a.texcoord));
  });
  return found.value_or(Rgb(0.0f));
}

}  // namespace deltalux::exporting
