#include "hierarchy/input_level.hpp"

#include <algorithm>
#include <cmath>

#include "base/sort_unique.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::hierarchy {

namespace {

std::optional<PlaneFrame> planeOf(const Scene& scene, const PatchDomain& d) {
  return hierarchy::planeOf(scene[d.primitive].shape, d.triangle);
}

bool isGone(const Scene& scene, PrimitiveId primitive) { return !(area(scene[primitive].shape) > 0); }

template <class Visit>
void forSubtree(const Elements& elements, ElementId e, const Visit& visit) {
  visit(e);
  for (std::size_t i = 0; i < elements.at(e).childCount; ++i) forSubtree(elements, elements.child(e, i), visit);
}

void darken(Elements& elements, ElementId e) {
  ElementLight& l = elements.radiometry[e.index()];
  l.B = l.rho = l.tau = l.direct = l.indirect = l.particle = Rgb(0.0f);
}

/// Draws an element together into a point.
void vanish(Elements& elements, ElementId e, const Vec3f& at) {
  ElementGeometry& g = elements.geometry[e.index()];
  g.area = g.radius = 0;
  g.lower = g.upper = g.center = at;
  for (Vec3f& p : elements.nodes[e.index()].position) p = g.center;
  darken(elements, e);
  elements.topology[e.index()].blocker = !elements.at(e).emitter;
}

}  // namespace

std::optional<PlaneFrame> planeOf(const Shape& shape, std::uint32_t triangle) {
  if (const auto* polygon = std::get_if<Polygon>(&shape))
    return PlaneFrame{polygon->origin, polygon->edgeU, polygon->edgeV, polygon->normal};
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh || triangle >= mesh->triangles.size()) return std::nullopt;
  const auto& corners = mesh->triangles[triangle];
  const Vec3 p0 = mesh->positions[corners[0]], e1 = mesh->positions[corners[1]] - p0,
             e2 = mesh->positions[corners[2]] - p0;
  const Vec3 n = glm::cross(e1, e2);
  const double length = glm::length(n);
  return PlaneFrame{p0, e1, e2, length > 0 ? n / length : Vec3(0, 0, 1)};
}

std::vector<Vec2> outlineOf(const Shape& shape) {
  const auto* polygon = std::get_if<Polygon>(&shape);
  if (!polygon) return {{0, 0}, {1, 0}, {0, 1}};
  std::vector<Vec2> outline;
  for (const Vec3& p : polygon->vertices) outline.push_back(parameterAt(shape, p));
  return outline;
}

void addPlane(Elements& elements, const Scene& scene, ElementId e) {
  PatchDomain& d = elements.domain[e.index()];
  const auto plane = planeOf(scene, d);
  elements.topology[e.index()].flat = plane.has_value();
  if (!plane) return;
  const std::vector<Vec2> outline = outlineOf(scene[d.primitive].shape);
  d.frame = static_cast<std::uint32_t>(elements.frames.size());
  elements.frames.push_back(*plane);
  d.outline = static_cast<std::uint32_t>(elements.outlines.size());
  d.outlineSize = static_cast<std::uint32_t>(outline.size());
  elements.outlines.insert(elements.outlines.end(), outline.begin(), outline.end());
}

void setReflectance(Elements& elements, const Scene& scene, ElementId input) {
  const Material& material = scene.materialOf(elements.domain[input.index()].primitive);
  const bool inactive = std::binary_search(elements.inactive.begin(), elements.inactive.end(), input);
  const bool blocker = inactive || isClear(material) || isGone(scene, elements.domain[input.index()].primitive);
  forSubtree(elements, input, [&](ElementId e) {
    elements.topology[e.index()].blocker = blocker;
    if (inactive) return darken(elements, e);
    elements.radiometry[e.index()].rho = diffuseReflectance(material, elements.at(e).front);
    elements.radiometry[e.index()].tau = diffuseTransmittance(material);
  });
}

void setInactive(Elements& elements, const Scene& scene, std::span<const ElementId> inputs, bool inactive) {
  for (const ElementId e : inputs) {
    const auto at = std::lower_bound(elements.inactive.begin(), elements.inactive.end(), e);
    const bool is = at != elements.inactive.end() && *at == e;
    if (inactive && !is) elements.inactive.insert(at, e);
    if (!inactive && is) elements.inactive.erase(at);
    setReflectance(elements, scene, e);
  }
  shapeAbove(elements, inputs);
}

void setEmission(Elements& elements, const Scene& scene, ElementId emitter) {
  const Light& light = scene[elements.light[emitter.index()]];
  forSubtree(elements, emitter, [&](ElementId e) {
    Rgb& B = elements.radiometry[e.index()].B;
    if (elements.isDistant(e)) return shapeDistant(elements, scene, e);
    if (elements.isPatch(e)) {
      const auto& emission = scene.materialOf(elements.domain[e.index()].primitive).emission;
      B = std::holds_alternative<AreaLight>(light.emitter) && emission ? float(kPi) * emission->radiance * light.scale
                                                                       : Rgb(0.0f);
      return;
    }
    B = std::visit(
        [&](const auto& l) {
          using T = std::decay_t<decltype(l)>;
          if constexpr (std::is_same_v<T, PhotometricLight>)
            return l.scale * light.scale;
          else if constexpr (requires { l.intensity; })
            return l.intensity * light.scale;
          else
            return Rgb(0.0f);
        },
        light.emitter);
  });
}

void shapePointLight(Elements& elements, const Scene& scene, ElementId e) {
  ElementGeometry& g = elements.geometry[e.index()];
  std::visit(
      [&](const auto& light) {
        if constexpr (requires { light.position; }) g.center = Vec3f(light.position);
      },
      scene[elements.light[e.index()]].emitter);
  g.lower = g.upper = g.center;
  for (int q = 0; q < 4; ++q) {
    elements.nodes[e.index()].position[q] = g.center;
    elements.nodes[e.index()].weight[q] = 0.25f;
  }
  setEmission(elements, scene, e);
}

void shapeCluster(Elements& elements, ElementId e) {
  Box box;
  double area = 0;
  Vec3 center(0.0);
  for (std::size_t i = 0; i < elements.at(e).childCount; ++i) {
    const ElementId c = elements.child(e, i);
    const ElementGeometry& g = elements.shape(c);
    box.extend(elements.box(c));
    if (elements.at(c).blocker) continue;
    area += g.area;
    center += double(g.area) * Vec3(g.center);
  }
  ElementGeometry& g = elements.geometry[e.index()];
  g.lower = Vec3f(box.lower), g.upper = Vec3f(box.upper);
  g.area = static_cast<float>(area);
  g.center = Vec3f(area > 0 ? center / area : box.center());
  g.radius = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f p{corner & 1 ? g.lower.x : g.upper.x, corner & 2 ? g.lower.y : g.upper.y,
                  corner & 4 ? g.lower.z : g.upper.z};
    g.radius = std::max(g.radius, glm::length(p - g.center));
  }
  for (int q = 0; q < 4; ++q) {
    double rest = (q + 0.5) / 4 * area;
    ElementId c = e;
    while (elements.isCluster(c)) {
      ElementId next = elements.child(c, elements.at(c).childCount - 1u);
      for (std::size_t i = 0; i < elements.at(c).childCount; ++i) {
        const ElementId candidate = elements.child(c, i);
        const double part = elements.at(candidate).blocker ? 0.0 : double(elements.shape(candidate).area);
        if (rest < part) {
          next = candidate;
          break;
        }
        rest -= part;
      }
      c = next;
    }
    ElementNodes& n = elements.nodes[e.index()];
    n.position[q] = elements.nodes[c.index()].position[q];
    n.normal[q] = elements.nodes[c.index()].normal[q];
    n.weight[q] = 0.25f;
  }
}

void shapeAbove(Elements& elements, std::span<const ElementId> changed) {
  std::vector<ElementId> above;
  for (const ElementId c : changed)
    for (ElementId e = elements.at(c).parent; e.valid(); e = elements.at(e).parent) above.push_back(e);
  // Children stand behind their clusters.
  std::sort(above.begin(), above.end(), [](ElementId a, ElementId b) { return b < a; });
  above.erase(std::unique(above.begin(), above.end()), above.end());
  for (const ElementId e : above) shapeCluster(elements, e);
}

std::vector<ElementId> elementsOf(const Elements& elements, std::span<const PrimitiveId> primitives) {
  std::vector<PrimitiveId> sorted(primitives.begin(), primitives.end());
  sortUnique(sorted);
  std::vector<ElementId> out;
  for (const PrimitiveId primitive : sorted)
    elements.sides.forEachOf(primitive, [&](ElementId e) { out.push_back(surfaceOf(elements, e)); });
  if (elements.lightRoot.valid())
    forEachBelow(elements, elements.lightRoot, [&](ElementId e) {
      if (elements.isInputLevel(e) &&
          std::binary_search(sorted.begin(), sorted.end(), elements.domain[e.index()].primitive))
        out.push_back(e);
      return elements.isCluster(e);
    });
  sortUnique(out);
  return out;
}

std::vector<ElementId> elementsOf(const Elements& elements, std::span<const LightId> lights) {
  std::vector<ElementId> out;
  for (const ElementId e : elements.inputs)
    if (const LightId light = elements.light[e.index()];
        light.valid() && std::find(lights.begin(), lights.end(), light) != lights.end())
      out.push_back(e);
  return out;
}

void reshape(Elements& elements, const Scene& scene, std::span<const ElementId> inputs) {
  for (const ElementId input : inputs) {
    if (elements.isPoint(input)) {
      shapePointLight(elements, scene, input);
    } else if (elements.isDistant(input)) {
      forSubtree(elements, input, [&](ElementId e) { shapeDistant(elements, scene, e); });
    } else if (isGone(scene, elements.domain[input.index()].primitive)) {
      const Vec3f at = elements.shape(input).center;
      forSubtree(elements, input, [&](ElementId e) { vanish(elements, e, at); });
    } else {
      forSubtree(elements, input, [&](ElementId e) {
        const PatchDomain& d = elements.domain[e.index()];
        const bool first = e == input || elements.hasFaces(elements.at(e).parent);  // of those that share a plane
        if (elements.at(e).flat && first) elements.frames[d.frame] = *planeOf(scene, d);
        shapePatch(elements, scene, e);
      });
      if (elements.at(input).emitter)
        setEmission(elements, scene, input);
      else
        setReflectance(elements, scene, input);
    }
  }
  shapeAbove(elements, inputs);
}

}  // namespace deltalux::hierarchy
