#include "export/page_refine.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace deltalux::exporting {

namespace {

LitSide litSideOf(const PageMesh& mesh, const PageMesh::Side& side, SideTriangles triangles,
                  const std::vector<std::vector<Rgb>>& layers, const std::vector<std::vector<Rgb>>& direct) {
  LitSide out;
  const auto part = [&](const auto& values) {
    return std::vector(values.begin() + side.first, values.begin() + side.first + side.count);
  };
  out.vertices = part(mesh.vertices), out.triangles = std::move(triangles);
  for (auto& t : out.triangles)
    for (std::uint32_t& v : t) v -= side.first;
  for (const auto& layer : layers) out.all.push_back(part(layer));
  for (const auto& layer : direct) out.direct.push_back(part(layer));
  return out;
}

/// Light has come to it from somewhere.
bool isLitAnywhere(const LitSide& side) {
  return std::ranges::any_of(side.all, [](const std::vector<Rgb>& layer) {
    return std::ranges::any_of(layer, [](const Rgb& E) { return !isBlack(E); });
  });
}

}  // namespace

std::vector<double> floorsOf(const PageMesh& mesh, const std::vector<std::vector<Rgb>>& layers) {
  LightFloors floors(layers.size());
  for (const SideTriangles& of : trianglesOfSides(mesh))
    for (const auto& t : of) floors.add({&mesh.vertices[t[0]], &mesh.vertices[t[1]], &mesh.vertices[t[2]]}, t, layers);
  return floors.floors();
}

void refineDirect(PageMesh& mesh, std::vector<std::vector<Rgb>>& layers, const std::vector<std::vector<Rgb>>& direct,
                  const Scene& scene, const DirectLight& light, const Refinement& settings,
                  const std::vector<char>& whole) {
  if (!light.any()) return;
  std::vector<SideTriangles> triangles = trianglesOfSides(mesh);
  std::vector<LitSide> sides(mesh.sides.size());
  parallelFor(sides.size(), 1, [&](std::size_t s) {
    sides[s] = litSideOf(mesh, mesh.sides[s], std::move(triangles[s]), layers, direct);
  });
  std::vector<SideToRefine> lit;
  for (std::size_t s = 0; s < sides.size(); ++s)
    if (isLitAnywhere(sides[s]))
      lit.push_back(
          {&sides[s], &scene[PrimitiveId(mesh.sides[s].side / 2)].shape, mesh.sides[s].side % 2 == 0, whole[s] != 0});
  refine(lit, light, settings);
  std::vector<std::uint32_t> firsts;
  std::uint32_t next = 0;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    triangles[s] = std::move(sides[s].triangles);
    firsts.push_back(next), next += static_cast<std::uint32_t>(sides[s].vertices.size());
  }
  replaceTriangles(mesh, triangles, firsts);
  mesh.vertices.clear(), mesh.source.clear();
  for (auto& layer : layers) layer.clear();
  for (std::size_t s = 0; s < sides.size(); ++s) {
    mesh.sides[s].first = firsts[s], mesh.sides[s].count = static_cast<std::uint32_t>(sides[s].vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), sides[s].vertices.begin(), sides[s].vertices.end());
    for (std::size_t g = 0; g < layers.size(); ++g)
      layers[g].insert(layers[g].end(), sides[s].all[g].begin(), sides[s].all[g].end());
  }
}

}  // namespace deltalux::exporting
