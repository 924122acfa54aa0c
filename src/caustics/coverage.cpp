#include "caustics/coverage.hpp"

#include <algorithm>

#include "hierarchy/tuning.hpp"

namespace deltalux::caustics {

namespace {

/// Texels of a region, and where they lie.
struct Raster {
  Region region;
  int width, height;
  Vec2 texel{region.size() / Vec2(width, height)};

  Vec2 at(double x, double y) const { return region.lower + Vec2(x, y) * texel; }
  Vec2 toTexels(const Vec2& st) const { return (st - region.lower) / texel; }
};

/// Marks the texels that a segment of the chart runs through, and their neighbours.
void markAlong(const Raster& r, const Vec2& from, const Vec2& to, std::vector<char>& marked) {
  const Vec2 a = r.toTexels(from), b = r.toTexels(to);
  const int steps = 1 + static_cast<int>(2 * std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)));
  for (int i = 0; i <= steps; ++i) {
    const Vec2 p = glm::floor(a + double(i) / steps * (b - a));
    for (int y = static_cast<int>(p.y) - 1; y <= static_cast<int>(p.y) + 1; ++y)
      for (int x = static_cast<int>(p.x) - 1; x <= static_cast<int>(p.x) + 1; ++x)
        if (x >= 0 && y >= 0 && x < r.width && y < r.height) marked[static_cast<std::size_t>(y) * r.width + x] = 1;
  }
}

template <class Covers>
std::vector<float> sampledAreas(const Raster& r, const std::vector<char>& marked, const Covers& covers) {
  std::vector<float> areas(marked.size(), 0.0f);
  const double whole = r.texel.x * r.texel.y;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * r.width + x;
      if (!marked[i]) {
        areas[i] = covers(r.at(x + 0.5, y + 0.5)) ? static_cast<float>(whole) : 0.0f;
        continue;
      }
      int inside = 0;
      for (int k = 0; k < hierarchy::tuning::kGrid * hierarchy::tuning::kGrid; ++k)
        inside += covers(r.at(x + (k % hierarchy::tuning::kGrid + 0.5) / hierarchy::tuning::kGrid,
                              y + (k / hierarchy::tuning::kGrid + 0.5) / hierarchy::tuning::kGrid));
      areas[i] = static_cast<float>(whole * inside / (hierarchy::tuning::kGrid * hierarchy::tuning::kGrid));
    }
  return areas;
}

/// Signed area under a polygon's edges, texel by texel: what lies to the right of each, by rows; sums along a row give
/// the share of each texel that is inside. Seams, walked there and back, cancel.
class Outline {
 public:
  Outline(int width, int height)
      : width_(width), height_(height), change_(static_cast<std::size_t>(width + 2) * height, 0.0) {}

  /// An edge, in texels.
  void add(Vec2 a, Vec2 b) {
    const double sign = a.y < b.y ? 1 : -1;
    if (a.y > b.y) std::swap(a, b);
    const double slope = (b.x - a.x) / (b.y - a.y);
    const int last = std::min(height_, static_cast<int>(std::ceil(b.y)));
    for (int y = std::max(0, static_cast<int>(std::floor(a.y))); y < last; ++y) {
      const double y0 = std::max<double>(y, a.y), y1 = std::min<double>(y + 1, b.y);
      if (y1 > y0) addInRow(y, a.x + slope * (y0 - a.y), a.x + slope * (y1 - a.y), sign * (y1 - y0));
    }
  }

  /// Share of each texel that is inside.
  std::vector<float> shares() const {
    std::vector<float> result;
    result.reserve(static_cast<std::size_t>(width_) * height_);
    for (int y = 0; y < height_; ++y) {
      double sum = 0;
      for (int x = 0; x < width_; ++x) {
        sum += change_[indexOf(x, y)];
        const double share = std::abs(sum);
        result.push_back(share < kRounding ? 0.0f : share > 1 - kRounding ? 1.0f : static_cast<float>(share));
      }
    }
    return result;
  }

 private:
  static constexpr double kRounding = 1e-6;  // [rounding]

  std::size_t indexOf(int x, int y) const { return static_cast<std::size_t>(y) * (width_ + 2) + x; }

  /// A part of an edge within a row, from x0 to x1 over the height `rise`.
  void addInRow(int y, double x0, double x1, double rise) {
    if (x0 > x1) std::swap(x0, x1);
    const double perX = x1 > x0 ? rise / (x1 - x0) : 0.0;
    double at = x0;
    if (at < 0) {
      const double end = std::min(x1, 0.0), part = x1 > x0 ? perX * (end - at) : rise;
      change_[indexOf(0, y)] += part;
      rise -= part, at = end;
      if (x1 <= 0) return;
    }
    for (int x = static_cast<int>(at); x < width_; ++x) {
      const double end = std::min<double>(x + 1, x1);
      const double part = end >= x1 ? rise : perX * (end - at), inside = 1 - (0.5 * (at + end) - x);
      change_[indexOf(x, y)] += part * inside, change_[indexOf(x + 1, y)] += part * (1 - inside);
      rise -= part, at = end;
      if (end >= x1) return;
    }
  }

  int width_, height_;
  std::vector<double> change_;  // of the share covered, from the texel before
};

std::vector<float> areasOf(const Polygon& p, const Chart& chart, std::size_t, const Charts&, const Raster& r) {
  Outline outline(r.width, r.height);
  for (std::size_t i = 0, n = p.vertices.size(); i < n; ++i) {
    SurfacePoint from, to;
    from.position = p.vertices[i], to.position = p.vertices[(i + 1) % n];
    outline.add(r.toTexels(chart.place(from)), r.toTexels(chart.place(to)));
  }
  std::vector<float> areas = outline.shares();
  const auto whole = static_cast<float>(r.texel.x * r.texel.y);
  for (float& a : areas) a *= whole;
  return areas;
}

std::vector<float> areasOf(const Ring& ring, const Chart&, std::size_t, const Charts&, const Raster& r) {
  std::vector<char> marked(static_cast<std::size_t>(r.width) * r.height, 0);
  const Vec2 center(ring.outerRadius);
  for (const double radius : {ring.innerRadius, ring.outerRadius}) {
    constexpr int sides = 64;
    const auto at = [&](int k) {
      const double phi = 2 * kPi * k / sides;
      return center + radius * Vec2(std::cos(phi), std::sin(phi));
    };
    for (int k = 0; k < sides; ++k) markAlong(r, at(k), at(k + 1), marked);
  }
  return sampledAreas(r, marked, [&](const Vec2& st) {
    const double radius = glm::length(st - center);
    return radius >= ring.innerRadius && radius <= ring.outerRadius;
  });
}

std::vector<float> areasOf(const Mesh& m, const Chart& chart, std::size_t index, const Charts& charts,
                           const Raster& r) {
  std::vector<double> areas(static_cast<std::size_t>(r.width) * r.height, 0.0);
  double projected = 0, sampled = 0;
  for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
    if (charts.ofTriangle[t] != index) continue;
    Vec2 corner[3];
    for (int k = 0; k < 3; ++k) {
      SurfacePoint p;
      p.position = m.positions[m.triangles[t][k]];
      corner[k] = double(hierarchy::tuning::kGrid) * r.toTexels(chart.place(p));
    }
    const auto turn = [](const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; };
    const double flat = std::abs(turn(corner[1] - corner[0], corner[2] - corner[0]));
    const double below = t == 0 ? 0.0 : m.cumulativeArea[t - 1];
    const double area = m.cumulativeArea[t] - below, perSample = flat > 0 ? 2 * area / flat : 0.0;
    const Vec2 low = glm::min(corner[0], glm::min(corner[1], corner[2]));
    const Vec2 high = glm::max(corner[0], glm::max(corner[1], corner[2]));
    const int x0 = std::max(0, static_cast<int>(low.x - 0.5)), y0 = std::max(0, static_cast<int>(low.y - 0.5));
    const int x1 = std::min(r.width * hierarchy::tuning::kGrid - 1, static_cast<int>(high.x));
    const int y1 = std::min(r.height * hierarchy::tuning::kGrid - 1, static_cast<int>(high.y));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Vec2 p(x + 0.5, y + 0.5);
        const double a = turn(corner[1] - corner[0], p - corner[0]), b = turn(corner[2] - corner[1], p - corner[1]),
                     c = turn(corner[0] - corner[2], p - corner[2]);
        if (std::min({a, b, c}) < 0 && std::max({a, b, c}) > 0) continue;
        areas[static_cast<std::size_t>(y / hierarchy::tuning::kGrid) * r.width + x / hierarchy::tuning::kGrid] +=
            perSample;
        sampled += perSample;
      }
    projected += area;
  }
  // Triangles smaller than the samples are hit or missed by chance: on the whole they count for what they are. A region
  // that leaves triangles out has no such sum to meet.
  const bool all = r.region.contains({0, 0}) && r.region.contains(chart.size);
  const double mend = all && sampled > 0 ? projected / sampled : 1.0;
  std::vector<float> result;
  for (const double a : areas) result.push_back(static_cast<float>(mend * a));
  return result;
}

template <class TurnShape>
std::vector<float> areasOf(const TurnShape&, const Chart& chart, std::size_t, const Charts&, const Raster& r) {
  std::vector<float> areas;
  for (int y = 0; y < r.height; ++y) {
    const double band = chart.bandArea(r.at(0, y).y, r.at(0, y + 1).y);
    areas.insert(areas.end(), r.width, static_cast<float>(r.texel.x * std::max(band, 0.0)));
  }
  return areas;
}

}  // namespace

std::vector<float> coveredAreas(const Shape& shape, const Charts& charts, std::size_t chart, const Region& region,
                                int width, int height) {
  const Raster raster{region, width, height};
  return std::visit([&](const auto& s) { return areasOf(s, charts.all[chart], chart, charts, raster); }, shape);
}

}  // namespace deltalux::caustics
