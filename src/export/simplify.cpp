#include "export/simplify.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "base/parallel.hpp"

namespace deltalux::exporting {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]
constexpr std::size_t kMostNeighbours = 16;   // of a vertex that is looked at [limit]
constexpr int kMostPasses = 6;                // over the vertices of a side [limit]
constexpr double kInside = 1e-4;              // barycentric, of what counts as inside a triangle [rounding]
constexpr double kBend = 0.003;       // of a side's size: how far curved surfaces may be off their shape [shown]
constexpr double kSameNormal = 0.99;  // cosine between normals of vertices that may be one [shown]
constexpr double kTurn = 0.7;         // cosine between a triangle and its neighbourhood, at least [shown]
constexpr double kSliver = 1e-3;      // twice a triangle's area over that size squared, at least [rounding]
constexpr float kChannelCount = 3;    // whose sum light is compared by [layout]
constexpr float kLeastShare = 0.03f;  // of all light at a point: a group's below it is not told apart from it [shown]

struct Triangle {
  std::array<std::uint32_t, 3> corners{kNone, kNone, kNone};
  std::vector<std::uint32_t> gone;  // vertices that were left out of it
  bool there = true;
};

/// One side's triangles, and light by vertex, numbered within the side.
class SideMesh {
 public:
  SideMesh(std::span<const MeshVertex> vertices, const std::vector<std::span<const Rgb>>& layers,
           const LightTolerance& tolerance)
      : vertices_(vertices),
        layers_(layers),
        tolerance_(static_cast<float>(tolerance.relative)),
        floors_(layers.size(), 0.0f),
        around_(vertices.size()) {
    for (std::size_t g = 0; g < tolerance.floors.size(); ++g)
      floors_[g] = kChannelCount * static_cast<float>(tolerance.floors[g]);
    Box box;
    for (const MeshVertex& v : vertices) box.extend(Vec3(v.position));
    bend_ = kBend * box.diagonal();
  }

  void add(std::array<std::uint32_t, 3> corners) {
    if (same_.empty()) joinTouching();
    for (std::uint32_t& v : corners) v = same_[v];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    for (const std::uint32_t v : corners) around_[v].push_back(static_cast<std::uint32_t>(triangles_.size()));
    triangles_.push_back({corners, {}, true});
  }

  void simplify() {
    for (int pass = 0; pass < kMostPasses; ++pass) {
      std::size_t left = 0;
      for (std::uint32_t v = 0; v < vertices_.size(); ++v) left += leaveOut(v);
      if (left * 50 < vertices_.size()) return;
    }
  }

  std::vector<std::array<std::uint32_t, 3>> triangles() const {
    std::vector<std::array<std::uint32_t, 3>> out;
    for (const Triangle& t : triangles_)
      if (t.there) out.push_back(t.corners);
    return out;
  }

 private:
  /// Vertices of one place and one light are one: patches that something stands on have vertices of their own, whether
  /// light differs there or not.
  void joinTouching() {
    std::vector<std::uint32_t> order(vertices_.size());
    std::iota(order.begin(), order.end(), 0u);
    same_ = order;
    const auto key = [&](std::uint32_t v) {
      const Vec3f& p = vertices_[v].position;
      return std::tuple(p.x, p.y, p.z, v);
    };
    std::ranges::sort(order, std::less<>(), key);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      while (end < order.size() && vertices_[order[end]].position == vertices_[order[begin]].position) ++end;
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t j = begin; j < i && same_[order[i]] == order[i]; ++j)
          if (same_[order[j]] == order[j] && alike(order[i], order[j])) same_[order[i]] = order[j];
    }
  }
  bool alike(std::uint32_t v, std::uint32_t w) const {
    return glm::dot(vertices_[v].normal, vertices_[w].normal) > static_cast<float>(kSameNormal) &&
           vertices_[v].uv == vertices_[w].uv && errorAt(v, {w, w, w}, {1, 0, 0}) < 1;
  }

  /// The neighbours of a vertex in order; empty where its triangles do not close round it.
  std::vector<std::uint32_t> ringOf(std::uint32_t v) const {
    const std::vector<std::uint32_t>& fan = around_[v];
    if (fan.size() < 3 || fan.size() > kMostNeighbours) return {};
    const auto edgeOf = [&](std::uint32_t t) {
      const auto& c = triangles_[t].corners;
      const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
      return std::pair(c[(k + 1) % 3], c[(k + 2) % 3]);
    };
    std::vector<std::uint32_t> ring{edgeOf(fan[0]).first};
    std::uint32_t at = edgeOf(fan[0]).second;
    while (at != ring[0] && ring.size() < fan.size()) {
      ring.push_back(at);
      const auto next = std::ranges::find_if(fan, [&](std::uint32_t t) { return edgeOf(t).first == at; });
      if (next == fan.end()) return {};
      at = edgeOf(*next).second;
    }
    return at == ring[0] && ring.size() == fan.size() ? ring : std::vector<std::uint32_t>{};
  }

  Vec3 at(std::uint32_t v) const { return Vec3(vertices_[v].position); }

  /// Coordinates in a plane: those of the largest projection.
  struct Plane {
    Vec3 normal;
    int x = 0, y = 1;
    double sign = 1, size = 0;
  };
  /// nullopt: the surface bends too much there.
  std::optional<Plane> planeOf(std::uint32_t v, const std::vector<std::uint32_t>& ring) const {
    Vec3 normal(0);
    double size = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 a = at(ring[i]) - at(v), b = at(ring[(i + 1) % ring.size()]) - at(v);
      normal += glm::cross(a, b), size = std::max(size, glm::length(a));
    }
    const double length = glm::length(normal);
    if (!(length > 0)) return std::nullopt;
    normal /= length;
    for (const std::uint32_t u : ring)
      if (std::abs(glm::dot(at(u) - at(v), normal)) > (1 - kTurn) * size) return std::nullopt;
    const Vec3 n = glm::abs(normal);
    const int axis = n.x > n.y ? (n.x > n.z ? 0 : 2) : (n.y > n.z ? 1 : 2);
    return Plane{normal, (axis + 1) % 3, (axis + 2) % 3, normal[axis] > 0 ? 1.0 : -1.0, size};
  }

  /// Whether a triangle stands as its neighbourhood does, and is none too thin.
  bool stands(const Plane& p, const std::array<std::uint32_t, 3>& c) const {
    const Vec3 n = glm::cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0]));
    const double length = glm::length(n);
    return length > kSliver * p.size * p.size && glm::dot(n, p.normal) > kTurn * length;
  }
  double distance(const std::array<std::uint32_t, 3>& c, std::uint32_t v) const {
    const Vec3 n = glm::cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0]));
    return std::abs(glm::dot(at(v) - at(c[0]), n)) / glm::length(n);
  }

  double cross(const Plane& p, std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec3 u = at(b) - at(a), w = at(c) - at(a);
    return p.sign * (u[p.x] * w[p.y] - u[p.y] * w[p.x]);
  }

  /// How far interpolation is off, over what is allowed.
  float errorAt(std::uint32_t v, const std::array<std::uint32_t, 3>& c, const glm::vec3& w) const {
    float total = 0, most = 0;
    for (const auto& layer : layers_) total += layer[v].r + layer[v].g + layer[v].b;
    for (std::size_t g = 0; g < layers_.size(); ++g) {
      const auto& layer = layers_[g];
      const Rgb off = w.x * layer[c[0]] + w.y * layer[c[1]] + w.z * layer[c[2]] - layer[v];
      const float allowed =
          tolerance_ * std::max({layer[v].r + layer[v].g + layer[v].b, kLeastShare * total, floors_[g]});
      const float is = std::abs(off.r) + std::abs(off.g) + std::abs(off.b);
      if (is > 0) most = std::max(most, allowed > 0 ? is / allowed : std::numeric_limits<float>::infinity());
    }
    return most;
  }

  struct Collapse {
    float error = 1;
    std::vector<Triangle> triangles;
  };
  /// The fan drawn into ring[k]; nullopt where it cannot be, or light suffers more than `most`.
  std::optional<Collapse> collapsed(const Plane& p, const std::vector<std::uint32_t>& ring, std::size_t k,
                                    const std::vector<std::uint32_t>& gone, float most) const {
    Collapse out{0, {}};
    const std::size_t n = ring.size();
    for (std::size_t j = 1; j + 1 < n; ++j) {
      const std::array<std::uint32_t, 3> c{ring[k], ring[(k + j) % n], ring[(k + j + 1) % n]};
      if (!(cross(p, c[0], c[1], c[2]) > 0) || !stands(p, c)) return std::nullopt;
      out.triangles.push_back({c, {}, true});
    }
    for (const std::uint32_t v : gone) {
      const auto in = std::ranges::find_if(out.triangles, [&](const Triangle& t) { return holds(p, t.corners, v); });
      if (in == out.triangles.end() || distance(in->corners, v) > bend_) return std::nullopt;
      out.error = std::max(out.error, errorAt(v, in->corners, placeIn(p, in->corners, v)));
      if (out.error >= most) return std::nullopt;
      in->gone.push_back(v);
    }
    return out;
  }

  glm::vec3 placeIn(const Plane& p, const std::array<std::uint32_t, 3>& c, std::uint32_t v) const {
    const double whole = cross(p, c[0], c[1], c[2]);
    const double b = cross(p, c[0], v, c[2]) / whole, d = cross(p, c[0], c[1], v) / whole;
    return glm::vec3(1 - b - d, b, d);
  }
  bool holds(const Plane& p, const std::array<std::uint32_t, 3>& c, std::uint32_t v) const {
    const glm::vec3 w = placeIn(p, c, v);
    return std::min({w.x, w.y, w.z}) >= -static_cast<float>(kInside);
  }

  bool leaveOut(std::uint32_t v) {
    const std::vector<std::uint32_t> ring = ringOf(v);
    if (ring.empty()) return false;
    const auto plane = planeOf(v, ring);
    if (!plane) return false;
    std::vector<std::uint32_t> gone{v};
    for (const std::uint32_t t : around_[v])
      gone.insert(gone.end(), triangles_[t].gone.begin(), triangles_[t].gone.end());
    Collapse best;
    for (std::size_t k = 0; k < ring.size(); ++k)
      if (auto found = collapsed(*plane, ring, k, gone, best.error)) best = std::move(*found);
    if (best.triangles.empty()) return false;
    apply(v, ring, std::move(best.triangles));
    return true;
  }

  void apply(std::uint32_t v, const std::vector<std::uint32_t>& ring, std::vector<Triangle> now) {
    const std::vector<std::uint32_t> fan = std::move(around_[v]);
    around_[v].clear();
    for (const std::uint32_t u : ring)
      std::erase_if(around_[u], [&](std::uint32_t t) { return std::ranges::find(fan, t) != fan.end(); });
    for (std::size_t i = 0; i < fan.size(); ++i) {
      triangles_[fan[i]].there = i < now.size();
      if (i >= now.size()) continue;
      triangles_[fan[i]] = std::move(now[i]);
      for (const std::uint32_t u : triangles_[fan[i]].corners) around_[u].push_back(fan[i]);
    }
  }

  std::span<const MeshVertex> vertices_;
  const std::vector<std::span<const Rgb>>& layers_;
  const float tolerance_;
  std::vector<float> floors_;                       // by group, sum of channels
  double bend_ = 0;                                 // how far a vertex that was left out may be from its triangle
  std::vector<std::uint32_t> same_;                 // by vertex: the one that it is one with
  std::vector<std::vector<std::uint32_t>> around_;  // by vertex: its triangles
  std::vector<Triangle> triangles_;
};

/// The triangles that sides keep, numbered within them. A side is in several draws with the same triangles.
std::vector<SideTriangles> keptTriangles(const PageMesh& mesh, const std::vector<std::vector<Rgb>>& layers,
                                         const LightTolerance& tolerance, const std::vector<char>& whole) {
  std::vector<SideTriangles> of = trianglesOfSides(mesh);
  parallelFor(mesh.sides.size(), 1, [&](std::size_t s) {
    for (auto& t : of[s])
      for (std::uint32_t& v : t) v -= mesh.sides[s].first;
    if (!whole.empty() && whole[s]) return;
    const PageMesh::Side& side = mesh.sides[s];
    std::vector<std::span<const Rgb>> light;
    for (const auto& layer : layers) light.emplace_back(layer.data() + side.first, side.count);
    SideMesh work({mesh.vertices.data() + side.first, side.count}, light, tolerance);
    for (const auto& t : of[s]) work.add(t);
    work.simplify();
    of[s] = work.triangles();
  });
  return of;
}

}  // namespace

void simplify(PageMesh& mesh, std::vector<std::vector<Rgb>>& layers, const LightTolerance& tolerance,
              const std::vector<char>& whole) {
  std::vector<std::uint32_t> firsts;
  for (const PageMesh::Side& side : mesh.sides) firsts.push_back(side.first);
  replaceTriangles(mesh, keptTriangles(mesh, layers, tolerance, whole), firsts);
  // Vertices that any of them has, in their order.
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
  for (const std::uint32_t v : mesh.triangles) number[v] = 0;
  std::uint32_t next = 0;
  for (PageMesh::Side& side : mesh.sides) {
    const std::uint32_t from = side.first, end = side.first + side.count;
    side.first = next;
    for (std::uint32_t v = from; v < end; ++v)
      if (number[v] != kNone) number[v] = next++;
    side.count = next - side.first;
  }
  const auto keep = [&](auto& values) {
    for (std::size_t v = 0; v < number.size(); ++v)
      if (number[v] != kNone) values[number[v]] = values[v];
    values.resize(next);
  };
  keep(mesh.vertices);
  for (auto& layer : layers) keep(layer);
  for (std::uint32_t& v : mesh.triangles) v = number[v];
  mesh.source.clear();
}

std::vector<char> sidesUnderTextures(const PageMesh& mesh, const std::vector<SolutionMesh>& groups) {
  std::vector<char> whole(mesh.sides.size(), 0);
  for (std::size_t s = 0; s < mesh.sides.size(); ++s)
    for (const SolutionMesh& group : groups) {
      const std::uint32_t side = mesh.sides[s].side;
      if (side >= group.caustics.size() || !group.caustics[side] || group.caustics[side]->textures.empty()) continue;
      const Shape& shape = (*group.scene)[group.caustics[side]->primitive].shape;
      if (!std::holds_alternative<Polygon>(shape)) whole[s] = 1;
    }
  return whole;
}

}  // namespace deltalux::exporting
