#include "render/solution_mesh/caustic_mesh.hpp"

#include <algorithm>
#include <array>

namespace deltalux::rendering {

namespace {

using caustics::CausticTexture;
using caustics::Chart;
using caustics::SurfaceCaustics;

/// Whether a texel knows nothing of light (see CausticTexture::sample).
bool knowsNothing(const CausticTexture& t, std::size_t texel) {
  return !(t.areas[texel] > 0) && isBlack(t.texels[texel]);
}

/// How many texels of border a texture gets.
int borderOf(const CausticTexture& t) { return t.closed || t.poleAtStart || t.poleAtEnd ? 1 : 0; }

/// The texel at a place that may lie beyond the rims.
std::size_t texelPast(const CausticTexture& t, int x, int y) {
  if (y < 0 && t.poleAtStart) y = -1 - y, x += t.width / 2;
  if (y >= t.height && t.poleAtEnd) y = 2 * t.height - 1 - y, x += t.width / 2;
  x = t.closed ? (x % t.width + t.width) % t.width : std::clamp(x, 0, t.width - 1);
  return static_cast<std::size_t>(std::clamp(y, 0, t.height - 1)) * static_cast<std::size_t>(t.width) +
         static_cast<std::size_t>(x);
}

/// The mean of what the texels around one know.
Rgb knownAround(const CausticTexture& t, int x, int y) {
  RgbSum sum(0.0);
  int count = 0;
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
    if (const std::size_t i = texelPast(t, x + dx, y + dy); !knowsNothing(t, i)) sum += RgbSum(t.texels[i]), ++count;
  if (count == 0)
    for (const auto& [dx, dy] : {std::pair{-1, -1}, {1, -1}, {-1, 1}, {1, 1}})
      if (const std::size_t i = texelPast(t, x + dx, y + dy); !knowsNothing(t, i)) sum += RgbSum(t.texels[i]), ++count;
  return count > 0 ? Rgb(sum / double(count)) : Rgb(0.0f);
}

/// Whether another texture of the surface shows the chart point.
bool shownElsewhere(const SurfaceCaustics& s, const CausticTexture& but, const Vec2& st) {
  const Chart& chart = s.charts.all[but.chart];
  return std::any_of(s.textures.begin(), s.textures.end(), [&](const CausticTexture& t) {
    return &t != &but && t.chart == but.chart && t.shows(st, chart.closed() ? chart.size.x : 0.0);
  });
}

/// The coarsest of a chart's textures: it shows points on outlines that fall beyond all texels.
bool isLastOfChart(const SurfaceCaustics& s, const CausticTexture& t) {
  return std::none_of(&t + 1, s.textures.data() + s.textures.size(),
                      [&](const CausticTexture& other) { return other.chart == t.chart; });
}

std::vector<glm::vec4> texelsOf(const SurfaceCaustics& s, const CausticTexture& t) {
  const bool last = isLastOfChart(s, t);
  std::vector<glm::vec4> inner(t.texels.size());
  for (int y = 0; y < t.height; ++y)
    for (int x = 0; x < t.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(t.width) + static_cast<std::size_t>(x);
      if (!knowsNothing(t, i)) {
        inner[i] = glm::vec4(t.texels[i], t.areas[i] > 0 ? 1.0f : 0.0f);
        continue;
      }
      const Vec2 center = t.region.lower + t.region.size() * (Vec2(x, y) + 0.5) / Vec2(t.width, t.height);
      inner[i] = glm::vec4(knownAround(t, x, y), last && !shownElsewhere(s, t, center) ? 1.0f : 0.0f);
    }
  const int border = borderOf(t);
  if (border == 0) return inner;
  std::vector<glm::vec4> all;
  for (int y = -border; y < t.height + border; ++y)
    for (int x = -border; x < t.width + border; ++x) all.push_back(inner[texelPast(t, x, y)]);
  return all;
}

/// A corner of a triangle on its way to being clipped.
struct ChartCorner {
  Vec2 st;
  Vec3 position;
};

ChartCorner between(const ChartCorner& a, const ChartCorner& b, double t) {
  return {glm::mix(a.st, b.st, t), glm::mix(a.position, b.position, t)};
}

/// The part of a convex polygon with st[axis] above (below) a limit. [SH74]
void clipCorners(std::vector<ChartCorner>& polygon, int axis, double limit, bool above) {
  std::vector<ChartCorner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ChartCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = above ? a.st[axis] - limit : limit - a.st[axis];
    const double db = above ? b.st[axis] - limit : limit - b.st[axis];
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      kept.push_back(between(a, b, da / (da - db)));
      kept.back().st[axis] = limit;
    }
  }
  polygon = std::move(kept);
}

class CausticTriangles {
 public:
  CausticTriangles(const CausticTexture& texture, CausticMesh& to) : texture_(texture), to_(to) {}

  void add(const std::array<ChartCorner, 3>& triangle, double shift) {
    polygon_.assign(triangle.begin(), triangle.end());
    for (ChartCorner& c : polygon_) c.st.x += shift;
    for (int axis = 0; axis < 2; ++axis) {
      clipCorners(polygon_, axis, texture_.region.lower[axis], true);
      clipCorners(polygon_, axis, texture_.region.upper[axis], false);
    }
    if (!(areaInChart() > 0)) return;
    const auto first = static_cast<std::uint32_t>(to_.vertices.size());
    for (const ChartCorner& c : polygon_) to_.vertices.push_back({Vec3f(c.position), texcoordOf(c.st)});
    for (std::uint32_t i = 1; i + 1 < polygon_.size(); ++i)
      to_.triangles.insert(to_.triangles.end(), {first, first + i, first + i + 1});
  }

 private:
  double areaInChart() const {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon_.size(); ++i) {
      const Vec2 a = polygon_[i].st - polygon_[0].st, b = polygon_[i + 1].st - polygon_[0].st;
      sum += a.x * b.y - a.y * b.x;
    }
    return std::abs(sum);
  }
  glm::vec2 texcoordOf(const Vec2& st) const {
    const double border = borderOf(texture_);
    const Vec2 size(texture_.width, texture_.height);
    const Vec2 within = (st - texture_.region.lower) / texture_.region.size() * size;
    return glm::vec2((within + border) / (size + 2 * border));
  }

  const CausticTexture& texture_;
  CausticMesh& to_;
  std::vector<ChartCorner> polygon_;
};

/// visit(triangle) for all of the surface's triangles in a chart, with their chart coordinates.
template <class Visit>
void forEachChartTriangle(const SurfaceCaustics& s, std::uint32_t index, const Shape& shape, const SurfaceMesh& side,
                          const Visit& visit) {
  const Chart& chart = s.charts.all[index];
  const auto flat = [&](const std::vector<Vec3>& positions, const std::array<std::uint32_t, 3>& corners) {
    std::array<ChartCorner, 3> triangle;
    for (int k = 0; k < 3; ++k) {
      SurfacePoint p;
      p.position = positions[corners[static_cast<std::size_t>(s.front ? k : 2 - k)]];
      triangle[static_cast<std::size_t>(k)] = {chart.place(p), p.position};
    }
    visit(triangle);
  };
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    for (const auto& corners : polygon->triangles) flat(polygon->vertices, corners);
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t)
      if (s.charts.indexOf(t) == index) flat(mesh->positions, mesh->triangles[t]);
  } else {
    for (std::size_t i = 0; i < side.triangles.size(); i += 3) {
      std::array<ChartCorner, 3> triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const MeshVertex& v = side.vertices[side.triangles[i + k]];
        SurfacePoint p;
        p.position = Vec3(v.position), p.uv = Vec2(v.uv);
        triangle[k] = {chart.place(p), p.position};
      }
      visit(triangle);
    }
  }
}

}  // namespace

SurfaceCausticMesh causticMeshOf(const SurfaceCaustics& s, const Shape& shape, const SurfaceMesh& side) {
  SurfaceCausticMesh result;
  result.primitive = s.primitive, result.front = s.front;
  for (const CausticTexture& texture : s.textures) {
    CausticMesh mesh;
    mesh.width = texture.width + 2 * borderOf(texture), mesh.height = texture.height + 2 * borderOf(texture);
    mesh.texels = texelsOf(s, texture);
    const Chart& chart = s.charts.all[texture.chart];
    CausticTriangles triangles(texture, mesh);
    forEachChartTriangle(s, texture.chart, shape, side, [&](const std::array<ChartCorner, 3>& triangle) {
      triangles.add(triangle, 0);
      if (!chart.closed()) return;
      // A region runs on past the seam; one of all the way round must not be covered twice.
      triangles.add(triangle, chart.size.x);
      triangles.add(triangle, -chart.size.x);
    });
    if (!mesh.triangles.empty()) result.textures.push_back(std::move(mesh));
  }
  return result;
}

bool sameTextures(const SurfaceCausticMesh& a, const SurfaceCausticMesh& b) {
  const auto sameVertex = [](const CausticMesh::Vertex& v, const CausticMesh::Vertex& w) {
    return v.position == w.position && v.texcoord == w.texcoord;
  };
  return std::equal(
      a.textures.begin(), a.textures.end(), b.textures.begin(), b.textures.end(),
      [&](const CausticMesh& s, const CausticMesh& t) {
        return s.width == t.width && s.height == t.height && s.texels == t.texels && s.triangles == t.triangles &&
               std::equal(s.vertices.begin(), s.vertices.end(), t.vertices.begin(), t.vertices.end(), sameVertex);
      });
}

}  // namespace deltalux::rendering
