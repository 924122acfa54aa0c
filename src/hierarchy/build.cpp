#include "hierarchy/build.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "base/check.hpp"
#include "base/random.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kLeafGroups = 4;  // surfaces that a cluster may hold directly without looking at their sizes
constexpr float kSlot = 0.5f;           // least mean free path, relative to that of the surroundings
constexpr double kLarge = 0.5;          // a surface this large against its cluster stays in it

/// The sides of one surface (front, back) travel together.
struct Group {
  Box box;
  std::vector<std::uint32_t> sides;
};

/// A cluster to be: children clusters, and the groups it holds directly.
struct Node {
  Box box;
  std::vector<std::unique_ptr<Node>> clusters;
  std::vector<Group> groups;
};

/// Glass has no diffuse side: it blocks or attenuates, and hands on specular light.
bool passesStraight(const Material& material) {
  return isThinGlass(material) || std::holds_alternative<Dielectric>(material.surface);
}

Box boundsOf(const Scene& scene, PrimitiveId primitive, std::uint32_t triangle) {
  const Shape& shape = scene[primitive].shape;
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return bounds(shape);
  Box box;
  for (const std::uint32_t v : mesh->triangles[triangle]) box.extend(mesh->positions[v]);
  return box;
}

/// Splits groups in two at the median of their centres along the axis of largest spread.
std::pair<std::vector<Group>, std::vector<Group>> halve(std::vector<Group> groups) {
  Box centers;
  for (const Group& g : groups) centers.extend(g.box.center());
  const Vec3 spread = centers.extent();
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  // The spatial middle keeps clusters compact; the median is the way out when all centres lie on one side of it.
  const double middle = centers.center()[axis];
  auto split = std::stable_partition(groups.begin(), groups.end(),
                                     [&](const Group& g) { return g.box.center()[axis] < middle; });
  if (split == groups.begin() || split == groups.end())
    split = groups.begin() + static_cast<std::ptrdiff_t>(groups.size() / 2);
  std::vector<Group> second(std::make_move_iterator(split), std::make_move_iterator(groups.end()));
  groups.erase(split, groups.end());
  return {std::move(groups), std::move(second)};
}

std::unique_ptr<Node> cluster(std::vector<Group> groups) {
  auto node = std::make_unique<Node>();
  for (const Group& g : groups) node->box.extend(g.box);
  if (groups.size() <= kLeafGroups) {
    node->groups = std::move(groups);
    return node;
  }
  const double limit = kLarge * node->box.diagonal();
  const auto small =
      std::stable_partition(groups.begin(), groups.end(), [&](const Group& g) { return g.box.diagonal() > limit; });
  const auto largeCount = static_cast<std::size_t>(small - groups.begin());
  std::vector<Group> rest(std::make_move_iterator(small), std::make_move_iterator(groups.end()));
  groups.erase(small, groups.end());
  if (largeCount > 4 * kLeafGroups) {
    // Many that are all large (a stack of boards): size does not tell them apart, so position must.
    rest.insert(rest.end(), std::make_move_iterator(groups.begin()), std::make_move_iterator(groups.end()));
    groups.clear();
  }
  node->groups = std::move(groups);
  if (rest.size() <= kLeafGroups && !node->groups.empty()) {
    for (Group& g : rest) node->groups.push_back(std::move(g));
  } else if (!rest.empty()) {
    // Two binary splits at once: four children a level halve the depth of the link tree.
    auto [a, b] = halve(std::move(rest));
    for (auto* half : {&a, &b}) {
      if (half->size() > 4 * kLeafGroups) {
        auto [c, d] = halve(std::move(*half));
        node->clusters.push_back(cluster(std::move(c)));
        node->clusters.push_back(cluster(std::move(d)));
      } else if (!half->empty()) {
        node->clusters.push_back(cluster(std::move(*half)));
      }
    }
  }
  return node;
}

class Builder {
 public:
  Builder(const Scene& scene, Elements& elements) : scene_(scene), elements_(elements) {}

  ElementId build(const std::vector<SurfaceSide>& sides, bool emitter, std::vector<LightId> points) {
    std::vector<Group> groups;
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
      const bool sameSurface =
          i > 0 && sides[i].primitive == sides[i - 1].primitive && sides[i].triangle == sides[i - 1].triangle;
      if (!sameSurface) groups.push_back({boundsOf(scene_, sides[i].primitive, sides[i].triangle), {}});
      groups.back().sides.push_back(i);
    }
    if (groups.empty() && points.empty()) return {};
    const auto root = cluster(std::move(groups));
    const ElementId first = elements_.addChildren({}, ElementKind::Cluster, 1);
    elements_.topology[first.index()].emitter = emitter;
    elements_.key[first.index()] = emitter ? 2 : 1;
    emit(*root, first, sides, emitter, points);
    pull(first);
    widenPaths(first);
    return first;
  }

 private:
  void emit(const Node& node, ElementId self, const std::vector<SurfaceSide>& sides, bool emitter,
            const std::vector<LightId>& points = {}) {
    std::vector<std::uint32_t> own;
    for (const Group& g : node.groups) own.insert(own.end(), g.sides.begin(), g.sides.end());
    const std::size_t count = node.clusters.size() + own.size() + points.size();
    const ElementId first = elements_.addChildren(self, ElementKind::Cluster, node.clusters.size());
    if (own.size() > 0) elements_.addChildren({}, ElementKind::Patch, own.size());
    if (points.size() > 0) elements_.addChildren({}, ElementKind::Point, points.size());
    elements_.topology[self.index()].firstChild = first;
    elements_.topology[self.index()].childCount = static_cast<std::uint16_t>(count);
    DELTALUX_CHECK(count < 65536, "a cluster holds fewer than 65536 children");
    for (std::size_t i = 0; i < count; ++i) {
      const ElementId c = elements_.child(self, i);
      elements_.topology[c.index()].parent = self;
      elements_.topology[c.index()].emitter = emitter;
      if (i >= node.clusters.size() + own.size())
        shapePoint(c, points[i - node.clusters.size() - own.size()]);
      else if (i >= node.clusters.size())
        shapeInput(c, sides[own[i - node.clusters.size()]], emitter);
      else
        elements_.key[c.index()] = combineKeys(elements_.key[self.index()], i);
    }
    for (std::size_t i = 0; i < node.clusters.size(); ++i)
      emit(*node.clusters[i], elements_.child(self, i), sides, emitter);
  }

  void shapeInput(ElementId e, const SurfaceSide& side, bool emitter) {
    ElementTopology& t = elements_.topology[e.index()];
    PatchDomain& d = elements_.domain[e.index()];
    const Primitive& primitive = scene_[side.primitive];
    t.front = side.front;
    d.primitive = side.primitive, d.triangle = side.triangle;
    elements_.key[e.index()] =
        combineKeys(combineKeys(side.primitive.value, side.triangle), (side.front ? 4u : 8u) + emitter);
    std::vector<Vec2> outline;
    if (const auto* polygon = std::get_if<Polygon>(&primitive.shape)) {
      outline.reserve(polygon->vertices.size());
      for (const Vec3& p : polygon->vertices) outline.push_back(parameterAt(primitive.shape, p));
      elements_.frames.push_back({polygon->origin, polygon->edgeU, polygon->edgeV, polygon->normal});
      t.flat = true;
    } else if (const auto* mesh = std::get_if<Mesh>(&primitive.shape)) {
      const auto& triangle = mesh->triangles[side.triangle];
      const Vec3 p0 = mesh->positions[triangle[0]], e1 = mesh->positions[triangle[1]] - p0,
                 e2 = mesh->positions[triangle[2]] - p0;
      outline = {{0, 0}, {1, 0}, {0, 1}};
      const Vec3 n = glm::cross(e1, e2);
      const double length = glm::length(n);
      elements_.frames.push_back({p0, e1, e2, length > 0 ? n / length : Vec3(0, 0, 1)});
      t.flat = true;
    }
    if (t.flat) {
      d.frame = static_cast<std::uint32_t>(elements_.frames.size() - 1);
      d.outline = static_cast<std::uint32_t>(elements_.outlines.size());
      d.outlineSize = static_cast<std::uint32_t>(outline.size());
      elements_.outlines.insert(elements_.outlines.end(), outline.begin(), outline.end());
    }
    shapePatch(elements_, scene_, e);
    // In a slot (a lamp just below the ceiling) the surface's own size is the scale that matters.
    ElementGeometry& g = elements_.geometry[e.index()];
    g.meanFreePath = std::max(side.meanFreePath, std::sqrt(g.area));
    const Material& material = scene_.materialOf(side.primitive);
    ElementLight& r = elements_.radiometry[e.index()];
    if (emitter) {
      elements_.light[e.index()] = lightOf(side.primitive);
      r.B = float(kPi) * material.emission->radiance * scene_[elements_.light[e.index()]].scale;
      return;
    }
    t.blocker = passesStraight(material);
    r.rho = diffuseReflectance(material, side.front);
    r.tau = diffuseTransmittance(material);
    r.indirect = side.irradiance;
    r.B = r.rho * side.irradiance;
    r.tolerance = r.typical = side.typicalIrradiance;
  }

  void shapePoint(ElementId e, LightId light) {
    elements_.light[e.index()] = light;
    elements_.key[e.index()] = combineKeys(light.value, 16);
    const Light& l = scene_[light];
    ElementGeometry& g = elements_.geometry[e.index()];
    std::visit(
        [&](const auto& emitter) {
          using T = std::decay_t<decltype(emitter)>;
          if constexpr (requires { emitter.position; }) {
            g.center = Vec3f(emitter.position);
            if constexpr (std::is_same_v<T, PhotometricLight>)
              elements_.radiometry[e.index()].B = emitter.scale * l.scale;
            else
              elements_.radiometry[e.index()].B = emitter.intensity * l.scale;
          }
        },
        l.emitter);
    g.lower = g.upper = g.center;
    for (int q = 0; q < 4; ++q) {
      elements_.nodes[e.index()].position[q] = g.center;
      elements_.nodes[e.index()].weight[q] = 0.25f;
    }
  }

  LightId lightOf(PrimitiveId primitive) {
    if (lightOfPrimitive_.empty()) {
      lightOfPrimitive_.resize(scene_.primitives.size());
      for (std::size_t i = 0; i < scene_.lights.size(); ++i)
        if (const auto* area = std::get_if<AreaLight>(&scene_.lights[i].emitter))
          lightOfPrimitive_[area->primitive.index()] = LightId(i);
    }
    const LightId light = lightOfPrimitive_[primitive.index()];
    DELTALUX_CHECK(light.valid(), "every emitting primitive has an area light (addAreaLights)");
    return light;
  }

  /// Extent of a cluster from its children: boxes, areas, and four surface points at even steps of area.
  void pull(ElementId e) {
    if (!elements_.isCluster(e)) return;
    Box box;
    double area = 0, path = 0;
    Vec3 center(0.0);
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) {
      const ElementId c = elements_.child(e, i);
      pull(c);
      const ElementGeometry& g = elements_.shape(c);
      box.extend(elements_.box(c));
      if (elements_.at(c).blocker) continue;
      area += g.area;
      path += double(g.area) * g.meanFreePath;
      center += double(g.area) * Vec3(g.center);
    }
    ElementGeometry& g = elements_.geometry[e.index()];
    g.lower = Vec3f(box.lower), g.upper = Vec3f(box.upper);
    g.area = static_cast<float>(area);
    g.center = Vec3f(area > 0 ? center / area : box.center());
    g.meanFreePath = area > 0 ? static_cast<float>(path / area) : 0.0f;
    g.radius = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f p{corner & 1 ? g.lower.x : g.upper.x, corner & 2 ? g.lower.y : g.upper.y,
                    corner & 4 ? g.lower.z : g.upper.z};
      g.radius = std::max(g.radius, glm::length(p - g.center));
    }
    for (int q = 0; q < 4; ++q) {
      double rest = (q + 0.5) / 4 * area;
      ElementId c = e;
      while (elements_.isCluster(c)) {
        ElementId next = elements_.child(c, elements_.at(c).childCount - 1u);
        for (std::size_t i = 0; i < elements_.at(c).childCount; ++i) {
          const ElementId candidate = elements_.child(c, i);
          const double part = elements_.at(candidate).blocker ? 0.0 : double(elements_.shape(candidate).area);
          if (rest < part) {
            next = candidate;
            break;
          }
          rest -= part;
        }
        c = next;
      }
      ElementNodes& n = elements_.nodes[e.index()];
      n.position[q] = elements_.nodes[c.index()].position[q];
      n.normal[q] = elements_.nodes[c.index()].normal[q];
      n.weight[q] = 0.25f;
    }
  }

  /// In a slot (between a frame and its wall) light varies over little, but what surrounds the slot sets the scale on
  /// which that matters: no mean free path is much shorter than in the cluster two levels up.
  void widenPaths(ElementId e, float above = 0, float twiceAbove = 0) {
    ElementGeometry& g = elements_.geometry[e.index()];
    const float own = g.meanFreePath;
    g.meanFreePath = std::max(own, kSlot * twiceAbove);
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i)
      widenPaths(elements_.child(e, i), own, std::max(above, own));
  }

  const Scene& scene_;
  Elements& elements_;
  std::vector<LightId> lightOfPrimitive_;
};

}  // namespace

std::vector<SurfaceSide> surfaceSides(const Scene& scene) {
  std::vector<SurfaceSide> sides;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const PrimitiveId id(i);
    const Material& material = scene.materialOf(id);
    const bool glass = passesStraight(material);
    const auto* mesh = std::get_if<Mesh>(&scene[id].shape);
    const std::size_t triangles = mesh ? mesh->triangles.size() : 1;
    if (!(area(scene[id].shape) > 0)) continue;
    for (std::size_t t = 0; t < triangles; ++t) {
      sides.push_back({id, static_cast<std::uint32_t>(t), true, 0, Rgb(0.0f), 0});
      if (!glass) sides.push_back({id, static_cast<std::uint32_t>(t), false, 0, Rgb(0.0f), 0});
    }
  }
  return sides;
}

Elements buildElements(const Scene& scene, const std::vector<SurfaceSide>& reachable) {
  Elements elements;
  elements.sceneBox = bounds(scene);
  Builder builder(scene, elements);
  elements.sceneRoot = builder.build(reachable, false, {});

  std::vector<SurfaceSide> emitting;
  std::vector<LightId> points;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& emitter = scene.lights[i].emitter;
    if (const auto* area = std::get_if<AreaLight>(&emitter)) {
      const auto* mesh = std::get_if<Mesh>(&scene[area->primitive].shape);
      const bool bothSides = scene.materialOf(area->primitive).emission->bothSides;
      for (std::uint32_t t = 0; t < (mesh ? mesh->triangles.size() : 1); ++t) {
        emitting.push_back({area->primitive, t, true, 0, Rgb(0.0f), 0});
        if (bothSides) emitting.push_back({area->primitive, t, false, 0, Rgb(0.0f), 0});
      }
    } else if (!std::holds_alternative<SunLight>(emitter) && !std::holds_alternative<DomeLight>(emitter)) {
      points.push_back(LightId(i));
    }
  }
  elements.lightRoot = builder.build(emitting, true, points);

  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& emitter = scene.lights[i].emitter;
    if (!std::holds_alternative<SunLight>(emitter) && !std::holds_alternative<DomeLight>(emitter)) continue;
    const ElementId e = elements.addChildren({}, ElementKind::Distant, 1);
    elements.light[e.index()] = LightId(i);
    elements.key[e.index()] = combineKeys(i, 32);
    elements.topology[e.index()].emitter = true;
    shapeDistant(elements, scene, e);
    elements.distant.push_back(e);
  }
  return elements;
}

}  // namespace deltalux
