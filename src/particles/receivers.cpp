#include "particles/receivers.hpp"

#include <algorithm>
#include <cmath>

#include "hierarchy/tuning.hpp"
#include "particles/tuning.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::particles {

namespace {

constexpr std::uint64_t kSeed = 0x7265636569766572ull;  // [key]

double lobe(const SpecularLobe& l) { return maxChannel(l.reflectance); }

/// A few digits only: a motion must not change them, nor with them which cells are drawn.
double roundedFraction(double x) {
  return static_cast<double>(static_cast<float>(std::ldexp(std::round(std::ldexp(x, 12)), -12)));
}

double weightOf(double area, double albedo) {
  int exponent = 0;
  const double mantissa = std::frexp(area * albedo, &exponent);
  return std::ldexp(roundedFraction(mantissa), exponent);
}

Rectangle frameOf(const Polygon& p) {
  const double length = glm::length(p.edgeU);
  const Vec3 a = p.edgeU / length, b = glm::cross(p.normal, a);
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec3& v : p.vertices) {
    const Vec2 at(glm::dot(v - p.origin, a), glm::dot(v - p.origin, b));
    low = glm::min(low, at), high = glm::max(high, at);
  }
  return {p.origin + low.x * a + low.y * b, a, b, high.x - low.x, high.y - low.y};
}

Rectangle frameOf(const Ring& r) {
  const Frame f(r.normal);
  return {r.center - r.outerRadius * (f.tangent + f.bitangent), f.tangent, f.bitangent, 2 * r.outerRadius,
          2 * r.outerRadius};
}

Rectangle frameOf(const Mesh& m, std::uint32_t triangle) {
  const auto& t = m.triangles[triangle];
  Vec3 p[3] = {m.positions[t[0]], m.positions[t[1]], m.positions[t[2]]};
  // Along the longest edge the rectangle is least.
  int longest = 0;
  for (int i = 1; i < 3; ++i)
    if (glm::distance(p[i], p[(i + 1) % 3]) > (1 + 1e-6) * glm::distance(p[longest], p[(longest + 1) % 3])) longest = i;
  const Vec3 origin = p[longest], edge = p[(longest + 1) % 3] - origin, third = p[(longest + 2) % 3] - origin;
  const double length = glm::length(edge);
  const Vec3 a = edge / length, up = third - glm::dot(third, a) * a;
  const double height = glm::length(up);
  return {origin, a, up / height, length, height};
}

/// The rectangle around a flat surface; none for curved ones.
std::optional<Rectangle> frameOf(const Shape& shape, std::uint32_t triangle) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return frameOf(*polygon);
  if (const auto* ring = std::get_if<Ring>(&shape)) return frameOf(*ring);
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return frameOf(*mesh, triangle);
  return std::nullopt;
}

}  // namespace

float specularAlbedo(const Material& material) {
  struct Visitor {
    double operator()(const Opaque& s) const { return lobe(s.specular); }
    double operator()(const Mirror& s) const { return maxChannel(s.reflectance); }
    double operator()(const ThinGlass& s) const { return maxChannel(reflectance(s, 0.5)); }
    double operator()(const Dielectric&) const { return 1.0; }
    double operator()(const Trans& s) const { return lobe(s.reflection) + lobe(s.transmission); }
  };
  return material.coverage * static_cast<float>(std::visit(Visitor{}, material.surface));
}

Receivers::Receivers(const Scene& scene) : scene_(scene), surfaceOf_(scene.primitives.size(), RadixNode::kNone) {
  double total = 0;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i)
    total += deltalux::area(scene::edits::restShape(scene, PrimitiveId(i)));
  const double limit = coarse(total) / tuning::kCellsOfScene;
  const std::vector<std::uint32_t> top = topObjects(scene);
  std::vector<std::pair<Code, Cell>> cells;
  std::vector<double> areas;  // at rest, by surface
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const Shape& rest = scene::edits::restShape(scene, PrimitiveId(i));
    if (!isSpecular(scene.materialOf(PrimitiveId(i))) || !(deltalux::area(rest) > 0)) continue;
    surfaceOf_[i] = static_cast<std::uint32_t>(surfaces_.size());
    const auto* mesh = std::get_if<Mesh>(&rest);
    for (std::uint32_t t = 0; t < (mesh ? mesh->triangles.size() : 1); ++t) {
      areas.push_back(addSurface(rest, PrimitiveId(i), t, top[i], limit, cells));
      place(surfaces_.back(), rest);
    }
  }
  if (cells.empty()) return;
  std::sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Code> codes;
  cumulative_.push_back(0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i].second;
    if (i == 0 || cell.surface != cells_.back().surface)
      surfaces_[cell.surface].firstCell = static_cast<std::uint32_t>(i);
    codes.push_back(cells[i].first);
    cells_.push_back(cell);
    const double area = areas[cell.surface] * cell.rect.measure();
    cumulative_.push_back(cumulative_.back() + particles::weightOf(area, surfaces_[cell.surface].albedo));
  }
  appendRadixTree(nodes_, codes, 0, kSeed);
  bounds_.resize(nodes_.size()), holdsAll_.assign(nodes_.size(), 1);
  leaf_.resize(cells_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].isLeaf()) leaf_[nodes_[n].begin] = static_cast<std::uint32_t>(n);
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    bounds_[leaf_[c]] = boundOf(cells_[c], scene::edits::restShape(scene, primitive(c)));
  boundNodes();
  restBounds_ = bounds_;
  std::vector<PrimitiveId> edited;
  for (const Placement& p : scene.placements) edited.push_back(p.primitive);
  follow(edited);
}

double Receivers::addSurface(const Shape& rest, PrimitiveId id, std::uint32_t triangle, std::uint32_t object,
                             double limit, std::vector<std::pair<Code, Cell>>& cells) {
  Surface s;
  s.primitive = id, s.triangle = triangle;
  s.albedo = specularAlbedo(scene_.materialOf(id));
  const std::optional<Rectangle> frame = frameOf(rest, triangle);
  s.flat = frame.has_value();
  const double whole = s.flat ? frame->area() : deltalux::area(rest);
  s.size = s.flat ? Vec2(frame->lengthA, frame->lengthB) : sampleSize(rest);
  s.halvings = halvings(whole, limit);
  s.firstCell = RadixNode::kNone;
  const auto surface = static_cast<std::uint32_t>(surfaces_.size());
  surfaces_.push_back(s);
  if (!(whole > 0) || !std::isfinite(whole)) return 0;
  for (const UnitCell& c : cellsOf(s.size, s.halvings))
    cells.push_back({Code{object, id.value, triangle, c.code}, Cell{surface, c.rect, s.flat}});
  return whole;
}

void Receivers::place(Surface& s, const Shape& shape) const {
  s.whole = deltalux::area(shape);
  if (!(s.whole > 0) || !s.flat) return;
  s.frame = *frameOf(shape, s.triangle);
  const auto* polygon = std::get_if<Polygon>(&shape);
  s.fills = polygon && s.frame.area() < (1 + 1e-9) * polygon->area;
  s.whole = s.frame.area();
}

std::vector<Receivers::Motion> Receivers::follow(std::span<const PrimitiveId> moved) {
  std::vector<Motion> motion(nodes_.size(), Motion::None);
  const std::vector<BoundingSphere> before = bounds_;
  for (const PrimitiveId p : moved) {
    const Shape& shape = scene_[p].shape;
    std::uint32_t s = surfaceOf_[p.index()];
    for (; s != RadixNode::kNone && s < surfaces_.size() && surfaces_[s].primitive == p; ++s) {
      place(surfaces_[s], shape);
      const std::uint32_t first = surfaces_[s].firstCell;
      for (std::uint32_t c = first; c < cells_.size() && cells_[c].surface == s; ++c) {
        bounds_[leaf_[c]] = boundOf(cells_[c], shape);
        motion[leaf_[c]] = Motion::Bound;
      }
    }
  }
  boundNodes();
  const Edited is = edited();
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    holdsAll_[n] = nodes_[n].isLeaf() || !(is.none[n] && is.some[n]);
    if (nodes_[n].isLeaf()) continue;
    if (is.none[n]) bounds_[n] = restBounds_[n];
    for (const std::uint32_t child : nodes_[n].child)
      if (motion[child] != Motion::None) motion[n] = Motion::Below;
    if (!(bounds_[n] == before[n])) motion[n] = Motion::Bound;
  }
  return motion;
}

Receivers::Edited Receivers::edited() const {
  std::vector<char> edited(scene_.primitives.size(), 0);
  Edited is{std::vector<char>(nodes_.size(), 0), std::vector<char>(nodes_.size(), 0)};
  for (const Placement& p : scene_.placements) edited[p.primitive.index()] = !p.present || p.matrix != Mat4(1.0);
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const RadixNode& node = nodes_[n];
    const auto below = [&](const std::vector<char>& v) { return v[node.child[0]] || v[node.child[1]]; };
    is.some[n] = node.isLeaf() ? edited[primitive(node.begin).index()] : below(is.some);
    is.none[n] = node.isLeaf() ? !edited[primitive(node.begin).index()] : below(is.none);
  }
  return is;
}

/// From today's leaves.
void Receivers::boundNodes() {
  std::vector<Box> boxes(nodes_.size());
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const RadixNode& node = nodes_[n];
    BoundingSphere& b = bounds_[n];
    if (node.isLeaf()) {
      if (!b.empty()) boxes[n] = {b.center - b.radius, b.center + b.radius};
      continue;
    }
    b = {Vec3(0), -1};
    for (const std::uint32_t child : node.child)
      if (!boxes[child].empty()) boxes[n].extend(boxes[child]);
    if (boxes[n].empty()) continue;
    b.center = boxes[n].center();
    for (const std::uint32_t child : node.child) {
      const BoundingSphere& inner = bounds_[child];
      if (!inner.empty()) b.radius = std::max(b.radius, glm::distance(inner.center, b.center) + inner.radius);
    }
  }
}

BoundingSphere Receivers::boundOf(const Cell& c, const Shape& shape) const {
  const Surface& s = surfaces_[c.surface];
  if (!(s.whole > 0)) return {Vec3(0), -1};
  if (s.flat) {
    const Vec3 low = s.frame.at({c.rect.u0, c.rect.v0}), high = s.frame.at({c.rect.u1, c.rect.v1});
    return {0.5 * (low + high), 0.5 * glm::distance(low, high)};
  }
  const Box whole = bounds(shape);
  const auto* ball = std::get_if<Sphere>(&shape);
  const BoundingSphere sphere{whole.center(), ball ? ball->radius : 0.5 * whole.diagonal()};
  if (s.halvings == 0) return sphere;
  // A grid of points, widened by what the surface bulges between them.
  Box box;
  for (int j = 0; j <= hierarchy::tuning::kGrid; ++j)
    for (int i = 0; i <= hierarchy::tuning::kGrid; ++i)
      box.extend(samplePoint(shape, c.rect.at({double(i) / hierarchy::tuning::kGrid,
                                               std::min(double(j) / hierarchy::tuning::kGrid, 1.0)}))
                     .position);
  const double du = (c.rect.u1 - c.rect.u0) / hierarchy::tuning::kGrid,
               dv = (c.rect.v1 - c.rect.v0) / hierarchy::tuning::kGrid;
  const double step = std::max(2 * kPi * du, 2.5 * std::sqrt(dv));  // angle; v is the height, steep at a ball's poles
  const double bulge = (1 - std::cos(std::min(kPi, step) / 2)) * 0.5 * whole.diagonal();
  const BoundingSphere part{box.center(), 0.5 * box.diagonal() + bulge};
  return part.radius < sphere.radius ? part : sphere;
}

std::size_t Receivers::memoryBytes() const {
  return surfaces_.capacity() * sizeof(Surface) + cells_.capacity() * sizeof(Cell) +
         nodes_.capacity() * sizeof(RadixNode) + 2 * bounds_.capacity() * sizeof(BoundingSphere) +
         holdsAll_.capacity() + leaf_.capacity() * 4 + cumulative_.capacity() * 8 + surfaceOf_.capacity() * 4;
}

}  // namespace deltalux::particles
