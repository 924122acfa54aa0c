#include "particles/senders.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "base/sky_side.hpp"
#include "base/tuning.hpp"
#include "base/unit_circle.hpp"
#include "hierarchy/tuning.hpp"
#include "particles/side_index.hpp"
#include "particles/tuning.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::particles {

namespace {

constexpr std::uint64_t kSurfaceSeed = 0x737572666163657aull, kLightSeed = 0x6c69676874737a7aull;  // [key]

bool isDiffuse(const Material& m, bool front) {
  return !isBlack(diffuseReflectance(m, front)) || !isBlack(diffuseTransmittance(m));
}

}  // namespace

Senders::Senders(const Scene& scene, const scene::LightSampler& lights) : scene_(scene), lights_(lights) {
  double total = 0;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i)
    total += area(scene::edits::restShape(scene, PrimitiveId(i)));
  for (std::size_t i = 0; i < scene.lights.size(); ++i) beams_.push_back(beamOf(LightId(i)));
  const double limit = coarse(total) / tuning::kCellsOfScene;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) addLight(LightId(i), limit / tuning::kFinerLamps);
  lightTrees_ = roots_.size();
  surfaceCells_ = static_cast<std::uint32_t>(cells_.size());
  addSurfaces(limit * tuning::kFinerLamps);
  bounds_.resize(nodes_.size());
  normals_.resize(nodes_.size());
  leaf_.resize(cells_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].isLeaf()) leaf_[nodes_[n].begin] = static_cast<std::uint32_t>(n);
  const auto restOf = [&](const SenderCell& c) {
    return c.primitive.valid() ? &scene::edits::restShape(scene, c.primitive) : nullptr;
  };
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    restMeasure_.push_back(cells_[c].measure);
    boundLeaf(c, restOf(cells_[c]));
  }
  boundNodes();
  rememberRest();
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    if (cells_[c].primitive.valid() && restOf(cells_[c]) != &scene[cells_[c].primitive].shape) place(c);
  boundNodes();
}

void Senders::place(std::uint32_t cell) {
  SenderCell& c = cells_[cell];
  const Shape& shape = scene_[c.primitive].shape;
  c.measure = static_cast<float>(area(shape) * c.rect.measure());
  boundLeaf(cell, &shape);
}

std::vector<char> Senders::follow(std::span<const PrimitiveId> moved) {
  std::vector<char> moves(scene_.primitives.size(), 0), cells(cells_.size(), 0);
  for (const PrimitiveId p : moved) moves[p.index()] = 1;
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    if (!cells_[c].primitive.valid() || !moves[cells_[c].primitive.index()]) continue;
    place(c);
    cells[c] = 1;
  }
  boundNodes();
  return cells;
}

void Senders::addLight(LightId id, double limit) {
  std::vector<std::pair<Code, SenderCell>> cells;
  const auto& emitter = scene_[id].emitter;
  SenderCell c;
  c.light = id;
  if (const auto* areaLight = std::get_if<AreaLight>(&emitter)) {
    const Material& material = scene_.materialOf(areaLight->primitive);
    const Shape& shape = scene::edits::restShape(scene_, areaLight->primitive);
    const double whole = area(shape);
    if (!material.emission || !(whole > 0)) return;
    c.kind = SenderKind::Lamp;
    c.primitive = areaLight->primitive;
    const int halves = std::min(halvings(whole, limit), kSkyHalvings);
    for (const bool front : {true, false}) {
      if (!front && !material.emission->bothSides) continue;
      c.front = front;
      for (const UnitCell& cell : cellsOf(sampleSize(shape), halves)) {
        c.rect = cell.rect;
        c.measure = static_cast<float>(whole * cell.rect.measure());
        cells.push_back({Code{front ? 0u : 1u, cell.code, 0, 0}, c});
      }
    }
  } else if (const auto* sun = std::get_if<SunLight>(&emitter)) {
    c.kind = SenderKind::Sun;
    c.measure = static_cast<float>(solidAngle(*sun));
    cells.push_back({Code{}, c});
  } else if (const auto* dome = std::get_if<DomeLight>(&emitter)) {
    c.kind = SenderKind::Sky;
    const double cap = 1 - std::cos(dome->halfAngle);
    for (const UnitCell& cell : cellsOf({2 * kPi, std::sqrt(cap) * 1.5}, kSkyHalvings)) {
      c.rect = cell.rect;
      c.measure = static_cast<float>(2 * kPi * cap * cell.rect.measure());
      cells.push_back({Code{0, cell.code, 0, 0}, c});
    }
  } else {
    c.kind = SenderKind::Point;
    c.measure = 1;
    cells.push_back({Code{}, c});
  }
  addTree(std::move(cells), combineKeys(kLightSeed, id.value));
}

void Senders::addSurfaces(double limit) {
  const std::vector<std::uint32_t> top = topObjects(scene_);
  halvings_.assign(scene_.primitives.size(), 0);
  firstCell_.assign(2 * scene_.primitives.size(), RadixNode::kNone);
  std::vector<std::pair<Code, SenderCell>> cells;
  for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
    const Shape& rest = scene::edits::restShape(scene_, PrimitiveId(i));
    const Material& material = scene_.materialOf(PrimitiveId(i));
    const double whole = area(rest);
    if (!(whole > 0)) continue;
    for (const bool front : {true, false}) {
      if (!isDiffuse(material, front)) continue;
      SenderCell c;
      c.front = front, c.primitive = PrimitiveId(i);
      halvings_[i] = static_cast<std::uint8_t>(halvings(whole, limit));
      for (const UnitCell& cell : cellsOf(sampleSize(rest), halvings_[i])) {
        c.rect = cell.rect;
        c.measure = static_cast<float>(whole * cell.rect.measure());
        cells.push_back({Code{top[i], static_cast<std::uint32_t>(i), front ? 0u : 1u, cell.code}, c});
      }
    }
  }
  std::sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  addTree(std::move(cells), kSurfaceSeed);
  for (std::size_t i = cells_.size(); i-- > surfaceCells_;)
    firstCell_[sideIndex(cells_[i].primitive, cells_[i].front)] = static_cast<std::uint32_t>(i);
}

std::uint32_t Senders::cellOf(PrimitiveId p, std::uint32_t triangle, bool front, const Vec2& uv) const {
  const std::uint32_t first = firstCell_[2 * p.index() + (front ? 0 : 1)];
  const int halves = halvings_[p.index()];
  if (first == RadixNode::kNone || halves == 0) return first;
  const Shape& shape = scene::edits::restShape(scene_, p);
  return first + cellAt(sampleSize(shape), halves, sampleNumbers(shape, triangle, uv));
}

void Senders::addTree(std::vector<std::pair<Code, SenderCell>> cells, std::uint64_t seed) {
  if (cells.empty()) return;
  const auto firstLeaf = static_cast<std::uint32_t>(cells_.size());
  std::vector<Code> codes;
  for (auto& [code, cell] : cells) {
    codes.push_back(code);
    cells_.push_back(std::move(cell));
  }
  roots_.push_back(appendRadixTree(nodes_, codes, firstLeaf, seed));
}

void Senders::boundNodes() {
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const RadixNode& node = nodes_[n];
    if (node.isLeaf()) continue;
    const std::uint32_t a = node.child[0], b = node.child[1];
    const bool sky = cells_[node.begin].kind == SenderKind::Sky;
    const BoundingSphere &s = bounds_[a], &t = bounds_[b];
    if (sky) {
      const Vec3 sum = s.center + t.center;
      const Vec3 axis = glm::length(sum) > 1e-6 ? glm::normalize(sum) : s.center;
      const auto reach = [&](const BoundingSphere& x) {
        return std::acos(std::clamp(glm::dot(x.center, axis), -1.0, 1.0)) + x.radius;
      };
      bounds_[n] = {axis, std::min(kPi, std::max(reach(s), reach(t)))};
      continue;
    }
    // The smallest sphere over two.
    const double d = glm::distance(s.center, t.center);
    if (t.empty() || d + t.radius <= s.radius) {
      bounds_[n] = s;
    } else if (s.empty() || d + s.radius <= t.radius) {
      bounds_[n] = t;
    } else {
      const double radius = 0.5 * (d + s.radius + t.radius);
      bounds_[n] = {s.center + (radius - s.radius) / d * (t.center - s.center), radius};
    }
    const Cone &p = normals_[a], &q = normals_[b];
    normals_[n] = {};
    if (p.cosine > 1 - 1e-12 && q.cosine > 1 - 1e-12 && glm::dot(p.axis, q.axis) > 1 - 1e-12) normals_[n] = p;
  }
}

void Senders::boundLeaf(std::uint32_t cell, const Shape* at) {
  const SenderCell& c = cells_[cell];
  const std::uint32_t n = leaf_[cell];
  if (c.kind == SenderKind::Point) {
    bounds_[n] = {lights_.position(c.light), 0};
    return;
  }
  if (c.kind == SenderKind::Sun || c.kind == SenderKind::Sky) {
    const Vec3 axis = direction(cell, {0.5, c.kind == SenderKind::Sun ? 0.0 : 0.5});
    double angle = 0;
    for (int i = 0; i <= hierarchy::tuning::kGrid; ++i)
      for (int j = 0; j <= hierarchy::tuning::kGrid; ++j)
        angle = std::max(angle,
                         std::acos(std::clamp(glm::dot(axis, direction(cell, {double(i) / hierarchy::tuning::kGrid,
                                                                              double(j) / hierarchy::tuning::kGrid})),
                                              -1., 1.)));
    bounds_[n] = {axis, angle};
    return;
  }
  normals_[n] = {};
  if (!(c.measure > 0)) {
    bounds_[n] = {Vec3(0), -1};
    return;
  }
  const Shape& shape = *at;
  Box box;
  for (int i = 0; i <= hierarchy::tuning::kGrid; ++i)
    for (int j = 0; j <= hierarchy::tuning::kGrid; ++j) {
      const Vec2 s =
          glm::min(Vec2(double(i) / hierarchy::tuning::kGrid, double(j) / hierarchy::tuning::kGrid), Vec2(1 - 1e-9));
      box.extend(samplePoint(shape, c.rect.at(s)).position);
    }
  bounds_[n] = {box.center(), 0.5 * box.diagonal()};
  const bool flat = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Ring>(shape);
  if (flat) normals_[n] = {(c.front ? 1.0 : -1.0) * samplePoint(shape, c.rect.at({0.5, 0.5})).normal, 1};
}

SurfacePoint Senders::point(std::uint32_t cell, const Vec2& u) const {
  const SenderCell& c = cells_[cell];
  SurfacePoint p = samplePoint(scene_[c.primitive].shape, c.rect.at(u));
  if (!c.front) p.normal = -p.normal;
  return p;
}

Senders::Beam Senders::beamOf(LightId light) const {
  const auto& emitter = scene_[light].emitter;
  const auto beam = [](const Vec3& axis, double halfAngle) {
    const double halfSine = std::sin(0.5 * halfAngle);
    // Not from the cosine, so that the sun's small disc keeps its digits.
    return Beam{Frame(axis), 2 * halfSine * halfSine};
  };
  if (const auto* sun = std::get_if<SunLight>(&emitter)) return beam(sun->direction, sun->angularRadius);
  if (const auto* dome = std::get_if<DomeLight>(&emitter)) return beam(dome->axis, dome->halfAngle);
  return {};
}

Vec3 Senders::direction(std::uint32_t cell, const Vec2& u) const {
  const SenderCell& c = cells_[cell];
  const Beam& beam = beams_[c.light.index()];
  const Vec2 at = c.rect.at(u);
  const double down = beam.depth * at.y, radius = std::sqrt(std::max(0.0, down * (2 - down)));
  return beam.frame.toWorld(Vec3(radius * onUnitCircle(at.x), 1 - down));
}

std::size_t Senders::memoryBytes() const {
  return cells_.capacity() * sizeof(SenderCell) + (restMeasure_.capacity() + leaf_.capacity()) * 4 +
         nodes_.capacity() * sizeof(RadixNode) + bounds_.capacity() * sizeof(BoundingSphere) +
         near_.capacity() * sizeof(NearNode) + beams_.capacity() * sizeof(Beam) + normals_.capacity() * sizeof(Cone) +
         cumulative_.capacity() * 8 + roots_.capacity() * 4;
}

}  // namespace deltalux::particles
