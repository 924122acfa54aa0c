#include "export/measured_direct.hpp"

#include <algorithm>
#include <deltalux/solution_reader.hpp>

#include "base/parallel.hpp"
#include "export/lightmap_side_light.hpp"
#include "solution/solution.hpp"

namespace deltalux::exporting {

namespace {

std::vector<BoxF> boxesOver(const std::vector<Vec3f>& corners,
                            const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<BoxF> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t v : triangles[i]) boxes[i].extend(corners[v]);
  return boxes;
}

bool isSkyLight(const Light& light) {
  return std::holds_alternative<DomeLight>(light.emitter) && !isBlack(light.scale);
}

/// Direct light that stays with the mesh: that of skies. nullopt: nobody knows how much of it that is.
std::optional<SolutionMesh> skyLight(const SolutionView& view, Rgb& weight) {
  const Solution& s = view.get();
  if (std::ranges::none_of(s.scene.lights, isSkyLight)) return SolutionMesh{};
  const auto weights = s.columns.empty() ? std::nullopt : weightsOf(s.columns, s.scene);
  if (!weights) return std::nullopt;
  for (std::size_t g = 0; g < s.columns.groups.size(); ++g) {
    const auto& lights = s.columns.groups[g].lights;
    const auto skies = std::ranges::count_if(lights, [&](LightId id) { return isSkyLight(s.scene[id]); });
    if (skies == 0) continue;
    if (static_cast<std::size_t>(skies) < lights.size()) return std::nullopt;
    weight = (*weights)[g];
    return SolutionReader(lightOf(view, g)).mesh();
  }
  return std::nullopt;
}

/// By vertex of a side: direct light that stays with the mesh.
std::vector<Rgb> keptLight(const SolutionMesh& sky, const Rgb& weight, std::size_t s, const SurfaceMesh& side) {
  std::vector<Rgb> kept(side.vertices.size(), Rgb(0.0f));
  if (sky.surfaces.empty()) return kept;
  const SurfaceMesh& of = *sky.surfaces[s];
  for (std::size_t i = 0; i < side.triangles.size(); ++i)
    kept[side.triangles[i]] = weight * of.vertices[of.triangles[i]].direct;
  return kept;
}

LitSide measuredSideOf(const SurfaceMesh& mesh, const std::vector<Rgb>& kept) {
  LitSide side;
  side.vertices = mesh.vertices;
  side.all.resize(1), side.direct.resize(1);
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    side.triangles.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    side.all[0].push_back(irradianceOf(mesh.vertices[v])), side.direct[0].push_back(mesh.vertices[v].direct - kept[v]);
  return side;
}

}  // namespace

SideDirect::SideDirect(std::vector<Vec3f> corners, std::vector<std::array<std::uint32_t, 3>> triangles,
                       std::vector<Rgb> light)
    : corners_(std::move(corners)),
      triangles_(std::move(triangles)),
      light_(std::move(light)),
      tree_(boxesOver(corners_, triangles_)) {}

std::optional<Rgb> SideDirect::at(const Vec3f& position, float reach) const {
  std::optional<Rgb> found;
  float least = std::numeric_limits<float>::infinity();
  tree_.overlapping({position - reach, position + reach}, [&](std::uint32_t i) {
    const auto& t = triangles_[i];
    const Vec3f &a = corners_[t[0]], &b = corners_[t[1]], &c = corners_[t[2]];
    const auto w = weightsOn(a, b, c, position, reach);
    if (!w) return;
    const Vec3f foot = a + w->x * (b - a) + w->y * (c - a);
    const float off = glm::dot(foot - position, foot - position);
    if (!(off < least)) return;
    least = off;
    found =
        glm::max(light_[t[0]] + w->x * (light_[t[1]] - light_[t[0]]) + w->y * (light_[t[2]] - light_[t[0]]), Rgb(0.0f));
  });
  return found;
}

MeasuredLight measuredLight(const SolutionView& view, const SolutionMesh& mesh, double error) {
  MeasuredLight out{mesh, std::vector<std::shared_ptr<const SideDirect>>(mesh.surfaces.size())};
  Rgb weight(1.0f);
  const std::optional<SolutionMesh> sky = skyLight(view, weight);
  if (!sky) return out;
  const DirectLight light = DirectLight::together(view);
  std::vector<LitSide> sides(mesh.surfaces.size());
  const auto at = [&](std::size_t s) { return mesh.surfaces[s] && !mesh.surfaces[s]->triangles.empty(); };
  parallelFor(sides.size(), 1, [&](std::size_t s) {
    if (at(s)) sides[s] = measuredSideOf(*mesh.surfaces[s], keptLight(*sky, weight, s, *mesh.surfaces[s]));
  });
  LightFloors floors(1);
  for (std::size_t s = 0; s < sides.size(); ++s)
    if (at(s)) floors.add(sides[s]);
  Refinement refinement = Refinement::of(view.get().scene, error);
  refinement.floors = floors.floors();
  std::vector<SideToRefine> lit;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (!at(s) || std::ranges::all_of(sides[s].all[0], [](const Rgb& E) { return isBlack(E); })) continue;
    auto rest = std::make_shared<SurfaceMesh>(*mesh.surfaces[s]);
    for (std::size_t v = 0; v < rest->vertices.size(); ++v) rest->vertices[v].direct -= sides[s].direct[0][v];
    lit.push_back({&sides[s], &(*mesh.scene)[rest->primitive].shape, rest->front});
    out.mesh.surfaces[s] = std::move(rest);
  }
  refine(lit, light, refinement);
  for (const SideToRefine& of : lit) {
    LitSide& side = *of.side;
    std::vector<Vec3f> corners;
    for (const MeshVertex& v : side.vertices) corners.push_back(v.position);
    out.sides[static_cast<std::size_t>(&side - sides.data())] =
        std::make_shared<const SideDirect>(std::move(corners), std::move(side.triangles), std::move(side.direct[0]));
  }
  return out;
}

}  // namespace deltalux::exporting
