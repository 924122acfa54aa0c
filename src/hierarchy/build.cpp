#include "hierarchy/build.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "base/check.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/tuning.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::hierarchy {

namespace {

constexpr std::uint64_t kSceneKey = 1, kLightKey = 2, kFacesKey = 3, kGrownKey = 64;  // [key]

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

/// Where the surface is at rest: edits move things within the clusters that they were built into, and a scene that was
/// edited gets the same ones.
Box boundsOf(const Scene& scene, const Elements& elements, const SurfaceSide& side) {
  const Shape& shape = scene::edits::restShape(scene, side.primitive);
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return bounds(shape);
  Box box;
  const auto add = [&](std::uint32_t triangle) {
    for (const std::uint32_t v : mesh->triangles[triangle]) box.extend(mesh->positions[v]);
  };
  if (side.order == 0) add(side.triangle);
  for (std::uint32_t i = 0; i < side.faces.count; ++i)
    add(elements.faceOrders[side.order - 1].faceAt(side.faces.first + i));
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
  if (groups.size() <= tuning::kLeafGroups) {
    node->groups = std::move(groups);
    return node;
  }
  const double limit = node->box.diagonal() / 2;  // what is larger fits into neither half
  const auto small =
      std::stable_partition(groups.begin(), groups.end(), [&](const Group& g) { return g.box.diagonal() > limit; });
  const auto largeCount = static_cast<std::size_t>(small - groups.begin());
  std::vector<Group> rest(std::make_move_iterator(small), std::make_move_iterator(groups.end()));
  groups.erase(small, groups.end());
  if (largeCount > deltalux::tuning::kPilots) {
    // Many that are all large (a stack of boards): size does not tell them apart, so position must.
    rest.insert(rest.end(), std::make_move_iterator(groups.begin()), std::make_move_iterator(groups.end()));
    groups.clear();
  }
  node->groups = std::move(groups);
  if (rest.size() <= tuning::kLeafGroups && !node->groups.empty()) {
    for (Group& g : rest) node->groups.push_back(std::move(g));
  } else if (!rest.empty()) {
    // Two binary splits at once: four children a level halve the depth of the link tree.
    auto [a, b] = halve(std::move(rest));
    for (auto* half : {&a, &b}) {
      if (half->size() > deltalux::tuning::kPilots) {
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

  ElementId build(const std::vector<SurfaceSide>& sides, std::uint64_t key, bool emitter, std::vector<LightId> points) {
    std::vector<Group> groups;
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
      const bool sameSurface =
          i > 0 && sides[i].primitive == sides[i - 1].primitive && sides[i].triangle == sides[i - 1].triangle;
      if (!sameSurface) groups.push_back({boundsOf(scene_, elements_, sides[i]), {}});
      groups.back().sides.push_back(i);
    }
    if (groups.empty() && points.empty()) return {};
    const auto root = cluster(std::move(groups));
    const ElementId first = elements_.addChildren({}, ElementKind::Cluster, 1);
    elements_.topology[first.index()].emitter = emitter;
    elements_.key[first.index()] = key;
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
    t.front = side.front;
    d.primitive = side.primitive, d.triangle = side.triangle;
    elements_.key[e.index()] =
        combineKeys(combineKeys(side.primitive.value, side.triangle), (side.front ? 4u : 8u) + emitter);
    if (side.order > 0) {
      d.order = side.order, d.outline = side.faces.first, d.outlineSize = side.faces.count;
      elements_.key[e.index()] = combineKeys(elements_.key[e.index()], kFacesKey);
    } else {
      addPlane(elements_, scene_, e);
    }
    shapePatch(elements_, scene_, e);
    // In a slot (a lamp just below the ceiling) the surface's own size is the scale that matters.
    ElementGeometry& g = elements_.geometry[e.index()];
    g.meanFreePath = std::max(side.meanFreePath, std::sqrt(g.area));
    ElementLight& r = elements_.radiometry[e.index()];
    if (emitter) {
      elements_.light[e.index()] = lightOf(side.primitive);
      setEmission(elements_, scene_, e);
      return;
    }
    setReflectance(elements_, scene_, e);
    r.indirect = side.irradiance;
    r.B = r.rho * side.irradiance;
    r.tolerance = r.typical = side.typicalIrradiance;
  }

  void shapePoint(ElementId e, LightId light) {
    elements_.light[e.index()] = light;
    elements_.key[e.index()] = combineKeys(light.value, 16);
    shapePointLight(elements_, scene_, e);
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

  void pull(ElementId e) {
    if (!elements_.isCluster(e)) return;
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) pull(elements_.child(e, i));
    shapeCluster(elements_, e);
    ElementGeometry& g = elements_.geometry[e.index()];
    double path = 0;
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) {
      const ElementId c = elements_.child(e, i);
      if (!elements_.at(c).blocker) path += double(elements_.shape(c).area) * elements_.shape(c).meanFreePath;
    }
    g.meanFreePath = g.area > 0 ? static_cast<float>(path / g.area) : 0.0f;
  }

  /// In a slot (between a frame and its wall) light varies over little, but what surrounds the slot sets the scale on
  /// which that matters: no mean free path is much shorter than in the cluster two levels up.
  void widenPaths(ElementId e, float above = 0, float twiceAbove = 0) {
    ElementGeometry& g = elements_.geometry[e.index()];
    const float own = g.meanFreePath;
    g.meanFreePath = std::max(own, tuning::kNarrowPlace * twiceAbove);
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
  sides.reserve(2 * scene.primitives.size());
  for (std::size_t i = 0; i < scene.primitives.size(); ++i)
    forEachSide(scene, PrimitiveId(i), [&](const Side& s) { sides.push_back({s.primitive, s.triangle, s.front}); });
  return sides;
}

std::vector<SurfaceSide> surfaceSides(const Scene& scene, std::span<const FaceOrder> orders) {
  std::vector<SurfaceSide> sides;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const PrimitiveId primitive(i);
    const auto order = std::lower_bound(orders.begin(), orders.end(), primitive,
                                        [](const FaceOrder& o, PrimitiveId p) { return o.primitive() < p; });
    if (order == orders.end() || order->primitive() != primitive) {
      forEachSide(scene, primitive, [&](const Side& s) { sides.push_back({s.primitive, s.triangle, s.front}); });
      continue;
    }
    if (!(area(scene[primitive].shape) > 0)) continue;
    const bool clear = isClear(scene.materialOf(primitive));
    for (const FaceRange& r : order->inputs())
      for (const bool front : {true, false}) {
        if (clear && !front) continue;
        SurfaceSide side{primitive, order->faceAt(r.first), front};
        side.order = static_cast<std::uint32_t>(order - orders.begin()) + 1, side.faces = r;
        sides.push_back(side);
      }
  }
  return sides;
}

Elements buildElements(const Scene& scene, const std::vector<SurfaceSide>& reachable, std::vector<FaceOrder> orders) {
  Elements elements;
  elements.faceOrders = std::move(orders);
  elements.sceneBox = bounds(scene);
  Builder builder(scene, elements);
  elements.sceneRoot = builder.build(reachable, kSceneKey, false, {});

  std::vector<SurfaceSide> emitting;
  std::vector<LightId> points;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& emitter = scene.lights[i].emitter;
    if (const auto* area = std::get_if<AreaLight>(&emitter)) {
      const auto* mesh = std::get_if<Mesh>(&scene[area->primitive].shape);
      const bool bothSides = scene.materialOf(area->primitive).emission->bothSides;
      for (std::uint32_t t = 0; t < (mesh ? mesh->triangles.size() : 1); ++t) {
        emitting.push_back({area->primitive, t, true});
        if (bothSides) emitting.push_back({area->primitive, t, false});
      }
    } else if (!std::holds_alternative<SunLight>(emitter) && !std::holds_alternative<DomeLight>(emitter)) {
      points.push_back(LightId(i));
    }
  }
  elements.lightRoot = builder.build(emitting, kLightKey, true, points);

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
  elements.listSides(0);
  elements.contacts = ContactLines(elements, scene);
  return elements;
}

std::vector<ElementId> elementsOf(const Elements& elements, std::span<const SurfaceSide> sides) {
  std::vector<ElementId> found;
  for (const SurfaceSide& s : sides)
    if (const ElementId e = elements.sides.at(s.side()); found.push_back(e), e.valid())
      found.back() = surfaceOf(elements, e);
  return found;
}

ElementId growElements(Elements& elements, const Scene& scene, const std::vector<SurfaceSide>& sides) {
  DELTALUX_CHECK(!sides.empty(), "something to grow");
  const SurfaceSide& first = sides.front();
  const std::uint64_t key =
      combineKeys(combineKeys(first.primitive.value, first.triangle), kGrownKey + (first.front ? 0u : 1u));
  const std::size_t known = elements.inputs.size();
  const ElementId root = Builder(scene, elements).build(sides, key, false, {});
  elements.listSides(known);
  (elements.sceneRoot.valid() ? elements.grown.emplace_back() : elements.sceneRoot) = root;
  return root;
}

}  // namespace deltalux::hierarchy
