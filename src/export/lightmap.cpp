#include "export/lightmap.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "export/lightmap_caustics.hpp"
#include "export/lightmap_side_light.hpp"

namespace deltalux::exporting {

namespace {

constexpr int kMostSamples = 8;        // a side of a texel, of caustic textures [limit]
constexpr float kOffTriangle = 1e-3f;  // how far a caustic's triangles may lie off the side's, of their size [rounding]

constexpr double kOffTexel = 0.5;  // texels that measured triangles of curved sides may lie off the mesh's [layout]

/// By triangle of a chart: whether light falls on it.
std::vector<char> litTriangles(const AtlasChart& chart, const SurfaceMesh& side) {
  std::vector<char> lit;
  for (const std::uint32_t t : chart.triangles) {
    const std::uint32_t* v = &side.triangles[3 * t];
    lit.push_back(std::any_of(v, v + 3, [&](std::uint32_t i) { return !isBlack(irradianceOf(side.vertices[i])); }));
  }
  return lit;
}

std::array<std::uint32_t, 3> cornersOf(const AtlasChart& chart, const SurfaceMesh& side, std::uint32_t triangle) {
  const std::uint32_t* v = &side.triangles[3 * chart.triangles[triangle]];
  return {v[0], v[1], v[2]};
}

/// The point of the triangle that the weights mean, or one of its edges nearby.
glm::vec2 heldInside(glm::vec2 weights) {
  weights = glm::max(weights, glm::vec2(0.0f));
  const float sum = weights.x + weights.y;
  return sum > 1 ? weights / sum : weights;
}

/// The mean over texels of what caustic textures show.
class TexelCaustics {
 public:
  TexelCaustics(const LightmapCaustics& caustics, const Atlas& atlas, std::size_t chart, const SurfaceMesh& side)
      : caustics_(caustics), atlas_(atlas), chart_(chart), side_(side) {
    const double texel = 1 / atlas.texelsPerUnit, finer = caustics.texelSize();
    samples_ = finer > 0 ? static_cast<int>(std::clamp(std::ceil(texel / finer) + 1, 1.0, double(kMostSamples))) : 1;
  }

  Rgb mean(const LightmapTexel& texel) const {
    const AtlasChart& chart = atlas_.charts[chart_];
    const std::array<std::uint32_t, 3> corners = cornersOf(chart, side_, texel.triangle);
    const Vec3f a = side_.vertices[corners[0]].position, b = side_.vertices[corners[1]].position,
                c = side_.vertices[corners[2]].position;
    const float reach = kOffTriangle * std::max(glm::length(b - a), glm::length(c - a));
    const auto [perX, perY] = slopes(texel.triangle);
    Rgb sum(0.0f);
    for (int y = 0; y < samples_; ++y)
      for (int x = 0; x < samples_; ++x) {
        const glm::vec2 off = (glm::vec2(x, y) + 0.5f) / static_cast<float>(samples_) - 0.5f;
        const glm::vec2 weights = heldInside(texel.nearest + off.x * perX + off.y * perY);
        sum += caustics_.at(within(a, b, c, weights), reach);
      }
    return sum / static_cast<float>(samples_ * samples_);
  }

 private:
  /// How the weights of a triangle's corners change from texel to texel.
  std::pair<glm::vec2, glm::vec2> slopes(std::uint32_t triangle) const {
    const AtlasChart& chart = atlas_.charts[chart_];
    Vec2 p[3];
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = texelOf(chart, atlas_.places[chart_], chart.places[chart.corners[3 * triangle + k]]);
    const glm::dmat2 edges(p[1] - p[0], p[2] - p[0]);
    if (!(std::abs(glm::determinant(edges)) > 0)) return {glm::vec2(0.0f), glm::vec2(0.0f)};
    const glm::dmat2 inverse = glm::inverse(edges);
    return {glm::vec2(inverse[0]), glm::vec2(inverse[1])};
  }

  const LightmapCaustics& caustics_;
  const Atlas& atlas_;
  std::size_t chart_;
  const SurfaceMesh& side_;
  int samples_ = 1;
};

/// Writes one chart onto its page.
void bakeChart(const Atlas& atlas, std::size_t index, const SolutionMesh& whole, const MeasuredLight& light,
               const LightmapCaustics* caustics, const std::function<Rgb(const BakedTexel&)>& colour, Image& page,
               std::vector<char>* covered) {
  const AtlasChart& chart = atlas.charts[index];
  const ChartPlace& place = atlas.places[index];
  const SurfaceMesh& side = *light.mesh.surfaces[chart.side];
  const SideDirect* measured = light.sides[chart.side].get();
  const auto reach = static_cast<float>(kOffTexel / atlas.texelsPerUnit);
  const std::vector<LightmapTexel> texels =
      texelsOf(chart, place, atlas.gutter, litTriangles(chart, *whole.surfaces[chart.side]));
  std::optional<TexelCaustics> texelCaustics;
  if (caustics) texelCaustics.emplace(*caustics, atlas, index, side);
  std::vector<Rgb> pixels(texels.size(), Rgb(0.0f));
  std::vector<char> known(texels.size(), 0);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (texels[i].triangle == LightmapTexel::kNone) continue;
    BakedTexel baked{index, side, texels[i], cornersOf(chart, side, texels[i].triangle), Rgb(0.0f), Vec3f(0.0f)};
    const MeshVertex &a = side.vertices[baked.corners[0]], &b = side.vertices[baked.corners[1]],
                     &c = side.vertices[baked.corners[2]];
    baked.irradiance = carriedOn(irradianceOf(a), irradianceOf(b), irradianceOf(c), texels[i]);
    if (texelCaustics) baked.irradiance += texelCaustics->mean(texels[i]);
    baked.position = within(a.position, b.position, c.position, texels[i].nearest);
    if (measured) baked.irradiance += measured->at(baked.position, reach).value_or(Rgb(0.0f));
    pixels[i] = colour(baked), known[i] = 1;
  }
  const int width = place.texels.x + 2 * atlas.gutter;
  dilate(pixels, known, width, atlas.gutter);
  const glm::ivec2 corner = place.first - atlas.gutter;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int x = corner.x + static_cast<int>(i) % width, y = corner.y + static_cast<int>(i) / width;
    page.at(x, y) = pixels[i];
    if (covered) (*covered)[static_cast<std::size_t>(y) * page.width + static_cast<std::size_t>(x)] = known[i];
  }
}

}  // namespace

bool isLit(const SolutionMesh& mesh, std::size_t side) {
  const auto& surface = mesh.surfaces[side];
  if (!surface || surface->triangles.empty()) return false;
  if (mesh.caustics[side] && !mesh.caustics[side]->textures.empty()) return true;
  return std::any_of(surface->vertices.begin(), surface->vertices.end(),
                     [](const MeshVertex& v) { return !isBlack(irradianceOf(v)); });
}

std::vector<AtlasChart> litCharts(const SolutionMesh& mesh, double crease) {
  std::vector<std::vector<AtlasChart>> bySide(mesh.surfaces.size());
  parallelFor(mesh.surfaces.size(), 1, [&](std::size_t side) {
    if (isLit(mesh, side))
      bySide[side] = chartsOf(*mesh.surfaces[side], (*mesh.scene)[mesh.surfaces[side]->primitive].shape, crease);
  });
  std::vector<AtlasChart> charts;
  for (std::vector<AtlasChart>& of : bySide)
    charts.insert(charts.end(), std::make_move_iterator(of.begin()), std::make_move_iterator(of.end()));
  return charts;
}

void groupByBrightness(std::vector<AtlasChart>& charts, const SolutionMesh& mesh, double range) {
  std::vector<float> values;
  for (AtlasChart& chart : charts) {
    values.clear();
    for (const std::uint32_t v : chart.vertices) {
      const float E = maxChannel(irradianceOf(mesh.surfaces[chart.side]->vertices[v]));
      if (E > 0) values.push_back(E);
    }
    if (values.empty()) continue;  // lit by caustic textures alone
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    chart.group = static_cast<int>(std::floor(std::log(*middle) / std::log(range)));
  }
}

double finestTexel(const SolutionMesh& mesh, const std::vector<AtlasChart>& charts) {
  std::vector<double> sizes;
  for (const AtlasChart& c : charts)
    for (std::size_t t = 0; t + 2 < c.corners.size(); t += 3) {
      const Vec2 u = c.places[c.corners[t + 1]] - c.places[c.corners[t]],
                 v = c.places[c.corners[t + 2]] - c.places[c.corners[t]];
      sizes.push_back(std::sqrt(std::abs(u.x * v.y - u.y * v.x)));
    }
  if (sizes.empty()) return 0;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  double finest = sizes[sizes.size() / 2] / 4;
  for (const auto& caustics : mesh.caustics)
    if (caustics && !caustics->textures.empty())
      if (const double size = LightmapCaustics(*caustics).texelSize(); size > 0) finest = std::min(finest, size);
  return finest;
}

std::vector<Image> bake(const Atlas& atlas, const SolutionMesh& whole, const MeasuredLight& light,
                        const std::function<Rgb(const BakedTexel&)>& colour, std::vector<std::vector<char>>* covered) {
  std::vector<Image> pages;
  for (const glm::ivec2& size : atlas.pages) {
    Image page;
    page.width = size.x, page.height = size.y;
    page.pixels.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), Rgb(0.0f));
    page.luminousEfficacy = whole.scene->luminousEfficacy;
    pages.push_back(std::move(page));
  }
  if (covered) {
    covered->clear();
    for (const Image& page : pages) covered->emplace_back(page.pixels.size(), 0);
  }
  std::vector<std::unique_ptr<const LightmapCaustics>> caustics(light.mesh.caustics.size());
  parallelFor(caustics.size(), 1, [&](std::size_t side) {
    if (const auto& of = light.mesh.caustics[side]; of && !of->textures.empty())
      caustics[side] = std::make_unique<const LightmapCaustics>(*of);
  });
  parallelFor(atlas.charts.size(), 1, [&](std::size_t i) {
    const std::uint32_t page = atlas.places[i].page;
    bakeChart(atlas, i, whole, light, caustics[atlas.charts[i].side].get(), colour, pages[page],
              covered ? &(*covered)[page] : nullptr);
  });
  return pages;
}

}  // namespace deltalux::exporting
