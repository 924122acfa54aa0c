#include "export/lightmap_texels.hpp"

#include <algorithm>

namespace deltalux::exporting {

namespace {

constexpr double kReach =
    1.5;  // texels: no corner of a bilinear cell is further from what it shows than sqrt(2) [layout]
constexpr double kCloser = 1e-9;  // of a squared distance [texels squared] [rounding]

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// A triangle in texels.
struct TexelTriangle {
  Vec2 a, ab, ac;
  double area = 0;  // twice

  TexelTriangle(const Vec2& p, const Vec2& q, const Vec2& r) : a(p), ab(q - p), ac(r - p), area(cross(ab, ac)) {}

  /// Weights of the second and third corner; nullopt: it has no area.
  std::optional<Vec2> weightsAt(const Vec2& p) const {
    if (!(std::abs(area) > 0)) return std::nullopt;
    return Vec2(cross(p - a, ac), cross(ab, p - a)) / area;
  }

  /// The weights of its point nearest to p.
  Vec2 nearestTo(const Vec2& p) const {
    if (const std::optional<Vec2> w = weightsAt(p); w && w->x >= 0 && w->y >= 0 && w->x + w->y <= 1) return *w;
    Vec2 best(0);
    double least = kInfinity;
    const Vec2 ends[] = {{0, 0}, {1, 0}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
      const Vec2 from = at(ends[i]), edge = at(ends[(i + 1) % 3]) - from;
      const double squared = glm::dot(edge, edge);
      const double t = squared > 0 ? std::clamp(glm::dot(p - from, edge) / squared, 0.0, 1.0) : 0.0;
      const Vec2 off = from + t * edge - p;
      if (const double d = glm::dot(off, off); d < least) least = d, best = glm::mix(ends[i], ends[(i + 1) % 3], t);
    }
    return best;
  }
  Vec2 at(const Vec2& weights) const { return a + weights.x * ab + weights.y * ac; }
};

class TexelRaster {
 public:
  TexelRaster(const AtlasChart& chart, const ChartPlace& place, int gutter)
      : chart_(chart), place_(place), gutter_(gutter), size_(place.texels + 2 * gutter) {
    texels_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
    squared_.assign(texels_.size(), kInfinity);
  }

  /// The triangles that are (not) lit, where those before leave room.
  void add(const std::vector<char>& lit, bool which) {
    for (std::uint32_t t = 0; t < chart_.triangles.size(); ++t)
      if ((lit[t] != 0) == which) add(t);
    taken_.assign(texels_.size(), 0);
    for (std::size_t i = 0; i < texels_.size(); ++i) taken_[i] = squared_[i] < kInfinity;
  }

  std::vector<LightmapTexel> take() { return std::move(texels_); }

 private:
  void add(std::uint32_t t) {
    Vec2 p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = texelOf(chart_, place_, chart_.places[chart_.corners[3 * t + k]]);
    const TexelTriangle triangle(p[0], p[1], p[2]);
    const Vec2 low = glm::min(p[0], glm::min(p[1], p[2])) - kReach,
               high = glm::max(p[0], glm::max(p[1], p[2])) + kReach;
    const glm::ivec2 from = glm::max(glm::ivec2(glm::ceil(low)), glm::ivec2(-gutter_));
    const glm::ivec2 to = glm::min(glm::ivec2(glm::floor(high)), place_.texels - 1 + gutter_);
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) offer(t, triangle, x, y);
  }

  void offer(std::uint32_t t, const TexelTriangle& triangle, int x, int y) {
    const std::size_t i = static_cast<std::size_t>(y + gutter_) * static_cast<std::size_t>(size_.x) +
                          static_cast<std::size_t>(x + gutter_);
    if (!taken_.empty() && taken_[i]) return;
    const Vec2 center(x, y), nearest = triangle.nearestTo(center), off = triangle.at(nearest) - center;
    const double squared = glm::dot(off, off);
    if (squared > kReach * kReach || squared >= squared_[i] - kCloser) return;
    squared_[i] = squared;
    texels_[i].triangle = t;
    texels_[i].nearest = glm::vec2(nearest);
    texels_[i].weights =
        squared > kCloser ? glm::vec2(triangle.weightsAt(center).value_or(nearest)) : texels_[i].nearest;
  }

  const AtlasChart& chart_;
  const ChartPlace& place_;
  int gutter_;
  glm::ivec2 size_;
  std::vector<LightmapTexel> texels_;
  std::vector<double> squared_;  // distance of what a texel shows
  std::vector<char> taken_;      // by triangles that come first
};

}  // namespace

std::vector<LightmapTexel> texelsOf(const AtlasChart& chart, const ChartPlace& place, int gutter,
                                    const std::vector<char>& lit) {
  TexelRaster raster(chart, place, gutter);
  raster.add(lit, true);
  raster.add(lit, false);
  return raster.take();
}

Rgb carriedOn(const Rgb& a, const Rgb& b, const Rgb& c, const LightmapTexel& texel) {
  if (texel.inside()) return glm::max(within(a, b, c, texel.nearest), Rgb(0.0f));
  const Rgb low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c)), spread = high - low;
  return glm::clamp(within(a, b, c, texel.weights), glm::max(low - spread, Rgb(0.0f)), high + spread);
}

void dilate(std::vector<Rgb>& pixels, std::vector<char>& known, int width, int gutter) {
  const int height = width > 0 ? static_cast<int>(pixels.size()) / width : 0;
  std::vector<std::pair<std::size_t, Rgb>> found;
  for (int pass = 0; pass < gutter; ++pass) {
    found.clear();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        if (known[i]) continue;
        Rgb sum(0.0f);
        int count = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
            const std::size_t j =
                static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
            if (known[j]) sum += pixels[j], ++count;
          }
        if (count > 0) found.emplace_back(i, sum / static_cast<float>(count));
      }
    for (const auto& [i, value] : found) pixels[i] = value, known[i] = 1;
  }
}

}  // namespace deltalux::exporting
