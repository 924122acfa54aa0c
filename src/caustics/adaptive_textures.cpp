#include "caustics/adaptive_textures.hpp"

#include <algorithm>

#include "base/tuning.hpp"
#include "caustics/adaptive_kernel.hpp"
#include "caustics/chart_part.hpp"
#include "caustics/choice.hpp"
#include "caustics/low_frequency_layer.hpp"
#include "caustics/resolution.hpp"
#include "caustics/surface_impacts.hpp"
#include "caustics/tuning.hpp"

namespace deltalux::caustics {

namespace {

constexpr int squared(int side) { return side * side; }

/// Counts of texels are of a few: light that differs a little is cut alike, so that it compares.
int steady(double texels) {
  return static_cast<int>(
      std::exp2(deltalux::tuning::kOctaveStep * std::round(std::log2(texels) / deltalux::tuning::kOctaveStep)));
}

/// Cuts the part into texels that hold `perTexel` particles where they are dense, no more than of a square of `most`
/// across. [GD01 3.2]
void resolve(const ChartSurface& surface, ChartPart& part, double perTexel, int most) {
  const double area = part.region.size().x * part.region.size().y;
  for (int count = squared(deltalux::tuning::kPilots);;) {
    surface.recut(part, squareTexels(part.region.size(), area / count, squared(most)));
    const int wanted = steady(std::min(area / texelArea(part, perTexel), 2.0 * squared(most)));
    if (wanted <= count || count >= squared(most)) return;
    count = std::min(wanted, squared(most));  // peaks show themselves as texels shrink
  }
}

/// Makes do with as few texels as what is left asks for. How often they were halved.
int coarsen(const ChartSurface& surface, ChartPart& part) {
  const auto count = [&] { return double(part.texels.x) * part.texels.y; };
  const auto wanted = [&] {
    const Vec2 size = part.region.size();
    return std::max(size.x * size.y / texelArea(part, deltalux::tuning::kPilots),
                    double(squared(deltalux::tuning::kPilots)));
  };
  int halvings = 0;
  while (count() >= 4 * wanted() && surface.halve(part)) ++halvings;
  return halvings;
}

bool fewDeposits(std::span<const particles::Impact> impacts) {
  double flux = 0, squares = 0;
  for (const particles::Impact& i : impacts) {
    const double w = gray(i.flux);
    flux += w, squares += w * w;
  }
  return tooFew(flux, squares);
}

class AdaptiveTextures {
 public:
  AdaptiveTextures(const Shape& shape, const CausticSettings& settings)
      : shape_(shape), rule_{settings.error, settings.background, settings.darkest} {
    result_.charts = chartsOf(shape);
  }

  /// Places the particles and cuts coarse textures. What they show that a mesh would not.
  Departure place(std::span<const particles::Impact> impacts) {
    auto placed = placeImpacts(shape_, result_.charts, impacts);
    parts_.resize(placed.size());
    Departure total;
    std::vector<PartLight> charts(placed.size());
    for (std::uint32_t c = 0; c < placed.size(); ++c) {
      if (placed[c].empty()) continue;
      const ChartSurface surface(shape_, result_.charts, c);
      parts_[c] = surface.whole(glm::ivec2(1), std::move(placed[c]));
      resolve(surface, parts_[c], deltalux::tuning::kPilots, tuning::kCoarseSide);
      const CellGrid grid = surface.grid(parts_[c]);
      const CellLight light = collect(grid, parts_[c].impacts);
      total += departure(grid, light);
      charts[c] = {gray(light.flux), light.squaredFlux, 0, grid.totalArea()};
      for (std::size_t i = 0; i < grid.size(); ++i) charts[c].fourths += light.fourths[i] * grid.area(i);
    }
    if (placed.size() < 2) return total;
    const std::vector<double> dark = darkAreas(charts);
    for (std::size_t c = 0; c < charts.size(); ++c)
      if (charts[c].area == 0) charts[c].area = dark[c], total.area += dark[c];
    return total += departureBetween(charts);
  }

  SurfaceCaustics restricted() {
    for (std::uint32_t c = 0; c < parts_.size(); ++c) {
      if (parts_[c].impacts.empty()) continue;
      const ChartSurface surface(shape_, result_.charts, c);
      const std::size_t first = result_.textures.size();
      putAll(surface, parts_[c]);
      keepFlux(std::span(result_.textures).subspan(first));
    }
    return std::move(result_);
  }

  SurfaceCaustics unrestricted(int texels) {
    for (std::uint32_t c = 0; c < parts_.size(); ++c) {
      if (parts_[c].impacts.empty()) continue;
      const ChartSurface surface(shape_, result_.charts, c);
      const Vec2 size = parts_[c].region.size();
      surface.recut(parts_[c], squareTexels(size, size.x * size.y / texels, texels));
      put(surface, parts_[c]);
    }
    return std::move(result_);
  }

 private:
  /// Areas of a mesh's charts that no particle met; 0 for the others.
  std::vector<double> darkAreas(const std::vector<PartLight>& lit) const {
    const Mesh& mesh = std::get<Mesh>(shape_);
    std::vector<double> areas(lit.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t chart = result_.charts.ofTriangle[t];
      if (lit[chart].area == 0) areas[chart] += mesh.cumulativeArea[t] - (t > 0 ? mesh.cumulativeArea[t - 1] : 0.0);
    }
    return areas;
  }

  /// Textures of all regions that deserve one, and of what is left.
  void putAll(const ChartSurface& surface, ChartPart& whole) {
    const CellGrid grid = surface.grid(whole);
    const CellLight light = collect(grid, whole.impacts);
    const AdaptiveEstimate coarse = reconstructAdaptive(grid, light, rule_);
    ChartPart all{whole.region, whole.texels, whole.areas, {}};
    std::vector<FadingBorder> borders;
    std::vector<ChartPart> regions = takeRegionsOut(surface, whole, grid, coarse, borders);
    const int halvings = coarsen(surface, whole);
    if (regions.empty()) return put(surface, whole);
    const LowFrequencyLayer layer(surface, std::move(all), grid, coarse, borders, halvings);
    for (std::size_t i = 0; i < regions.size(); ++i) putRegion(surface, regions[i], borders[i], layer);
    const auto isSurface = [](float area) { return area > 0; };
    if (std::any_of(whole.areas.begin(), whole.areas.end(), isSurface))
      result_.textures.push_back(layer.shownOn(whole));
  }

  std::vector<ChartPart> takeRegionsOut(const ChartSurface& surface, ChartPart& whole, const CellGrid& grid,
                                        const AdaptiveEstimate& coarse, std::vector<FadingBorder>& borders) const {
    const std::vector<float> E = grayOf(coarse.E);
    const double difference = tuning::kMatters * rule_.error * (medianOfFlux(grid.areas(), E) + rule_.background);
    const std::vector<TexelBox> boxes = markedBoxes(grid, cellsOffMedian(grid, E, difference), tuning::kMargin);
    const std::vector<std::size_t> particles = particlesUnder(whole, grid, boxes);
    std::vector<ChartPart> regions;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (particles[i] < static_cast<std::size_t>(deltalux::tuning::kFewestEstimates)) continue;
      regions.push_back(surface.takeOut(whole, grid, boxes[i], glm::ivec2(1)));
      borders.emplace_back(grid, boxes[i], tuning::kMargin);
    }
    return regions;
  }

  void put(const ChartSurface& surface, const ChartPart& part) {
    const CellGrid grid = surface.grid(part);
    if (grid.size() == 0) return;
    const CellLight light = collect(grid, part.impacts);
    result_.textures.push_back(surface.texture(part, grid, light, reconstructAdaptive(grid, light, rule_).E));
  }

  void putRegion(const ChartSurface& surface, ChartPart& region, const FadingBorder& border,
                 const LowFrequencyLayer& layer) {
    resolve(surface, region, tuning::kStray, kFineSide);
    const CellGrid grid = surface.grid(region);
    if (grid.size() == 0) return;
    const CellLight light = collect(grid, region.impacts);
    AdaptiveEstimate reconstruction = reconstructAdaptive(grid, light, rule_);
    layer.over(grid, border, rule_, reconstruction);
    result_.textures.push_back(surface.texture(region, grid, light, reconstruction.E));
  }

  /// What went from one texture of a chart to another is theirs; together they show all particles.
  static void keepFlux(std::span<CausticTexture> textures) {
    RgbSum deposited(0.0), shown(0.0);
    for (const CausticTexture& t : textures) deposited += t.flux, shown += t.integral();
    Rgb factor(1.0f);
    for (int c = 0; c < 3; ++c)
      if (shown[c] > 0) factor[c] = static_cast<float>(deposited[c] / shown[c]);
    for (CausticTexture& t : textures)
      for (Rgb& E : t.texels) E *= factor;
  }

  const Shape& shape_;
  BandwidthRule rule_;
  SurfaceCaustics result_;
  std::vector<ChartPart> parts_;  // by chart
};

}  // namespace

bool deservesTextures(const Shape& shape, std::span<const particles::Impact> impacts, const CausticSettings& settings) {
  if (fewDeposits(impacts)) return false;
  AdaptiveTextures textures(shape, settings);
  return deservesTexture(textures.place(impacts), settings.error, settings.background);
}

std::optional<SurfaceCaustics> makeCausticTextures(const Shape& shape, std::span<const particles::Impact> impacts,
                                                   const CausticSettings& settings) {
  if (fewDeposits(impacts)) return std::nullopt;
  AdaptiveTextures textures(shape, settings);
  if (!deservesTexture(textures.place(impacts), settings.error, settings.background)) return std::nullopt;
  return textures.restricted();
}

SurfaceCaustics makeUnrestrictedTextures(const Shape& shape, std::span<const particles::Impact> impacts,
                                         const CausticSettings& settings, int texels) {
  AdaptiveTextures textures(shape, settings);
  textures.place(impacts);
  return textures.unrestricted(texels);
}

}  // namespace deltalux::caustics
