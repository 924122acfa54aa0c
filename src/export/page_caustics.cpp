#include "export/page_caustics.hpp"

#include <algorithm>
#include <cmath>

#include "export/rgb9e5.hpp"

namespace deltalux::exporting {

namespace {

constexpr int kBorder = 1;      // texels round each texture [layout]
constexpr float kShown = 0.5f;  // of a texel's fourth channel, which is 0 or 1 [layout]

struct Place {
  const CausticMesh* texture;
  std::uint32_t material;
  int x = 0, y = 0;  // of its border's corner on the sheet
};

int outer(int size) { return size + 2 * kBorder; }

std::vector<Place> placesOf(const PageMesh& page, const SolutionMesh& mesh) {
  std::vector<Place> places;
  for (const PageMesh::Side& side : page.sides) {
    if (side.side >= mesh.caustics.size() || !mesh.caustics[side.side]) continue;
    for (const CausticMesh& texture : mesh.caustics[side.side]->textures)
      if (!texture.triangles.empty()) places.push_back({&texture, side.material});
  }
  return places;
}

/// In rows, the highest first. Returns the sheet's size.
glm::ivec2 layOut(std::vector<Place>& places) {
  double area = 0;
  int widest = 1;
  for (const Place& p : places)
    area += double(outer(p.texture->width)) * outer(p.texture->height),
        widest = std::max(widest, outer(p.texture->width));
  const int width = std::max(widest, static_cast<int>(std::ceil(std::sqrt(area))));
  std::ranges::stable_sort(places, std::greater<>(), [](const Place& p) { return p.texture->height; });
  int x = 0, y = 0, row = 0;
  for (Place& p : places) {
    if (x + outer(p.texture->width) > width) x = 0, y += row, row = 0;
    p.x = x, p.y = y;
    x += outer(p.texture->width), row = std::max(row, outer(p.texture->height));
  }
  return {width, y + row};
}

void copyTexels(const Place& p, PageCaustics& sheet) {
  const CausticMesh& t = *p.texture;
  for (int j = 0; j < outer(t.height); ++j)
    for (int i = 0; i < outer(t.width); ++i) {
      const int u = std::clamp(i - kBorder, 0, t.width - 1), v = std::clamp(j - kBorder, 0, t.height - 1);
      const glm::vec4& texel = t.texels[std::size_t(v) * t.width + u];
      const std::size_t at = std::size_t(p.y + j) * sheet.width + p.x + i;
      sheet.texels[at] = packRgb9e5(Rgb(texel));
      sheet.shows[at] = texel.a > kShown ? 255 : 0;
    }
}

void copyTriangles(const Place& p, PageCaustics& sheet) {
  const CausticMesh& t = *p.texture;
  const auto first = static_cast<std::uint32_t>(sheet.positions.size());
  const glm::vec2 size(sheet.width, sheet.height);
  for (const CausticMesh::Vertex& v : t.vertices) {
    sheet.positions.push_back(v.position);
    sheet.texcoords.push_back((glm::vec2(p.x + kBorder, p.y + kBorder) + v.texcoord * glm::vec2(t.width, t.height)) /
                              size);
    sheet.materials.push_back(p.material);
  }
  for (const std::uint32_t i : t.triangles) sheet.triangles.push_back(first + i);
}

}  // namespace

std::optional<PageCaustics> pageCaustics(const PageMesh& page, const SolutionMesh& mesh) {
  std::vector<Place> places = placesOf(page, mesh);
  if (places.empty()) return std::nullopt;
  PageCaustics sheet;
  const glm::ivec2 size = layOut(places);
  sheet.width = size.x, sheet.height = size.y;
  sheet.texels.assign(std::size_t(size.x) * size.y, 0), sheet.shows.assign(std::size_t(size.x) * size.y, 0);
  for (const Place& p : places) copyTexels(p, sheet), copyTriangles(p, sheet);
  return sheet;
}

}  // namespace deltalux::exporting
