#include "hierarchy/patch.hpp"

#include <algorithm>
#include <array>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "hierarchy/fold.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/outline.hpp"
#include "hierarchy/tuning.hpp"

namespace deltalux::hierarchy {

namespace {

constexpr int kMaxDepth = 14;  // four bits below the 2 * 14 that addresses use [layout]

double areaScale(const PlaneFrame& f) { return glm::length(glm::cross(f.edgeU, f.edgeV)); }

/// World lengths of the patch's rectangle along u and v.
Vec2 worldSize(const Elements& elements, const Scene& scene, ElementId e) {
  const PatchDomain& d = elements.domain[e.index()];
  const double du = d.u1 - d.u0, dv = d.v1 - d.v0;
  if (elements.at(e).flat) {
    const PlaneFrame& f = elements.frames[d.frame];
    return {du * glm::length(f.edgeU), dv * glm::length(f.edgeV)};
  }
  const Shape& shape = scene[d.primitive].shape;
  const double um = 0.5 * (d.u0 + d.u1), vm = 0.5 * (d.v0 + d.v1);
  const auto length = [&](const Vec2& a, const Vec2& m, const Vec2& b) {
    const Vec3 p = pointAt(shape, m).position;
    return glm::length(p - pointAt(shape, a).position) + glm::length(pointAt(shape, b).position - p);
  };
  return {length({d.u0, vm}, {um, vm}, {d.u1, vm}), length({um, d.v0}, {um, vm}, {um, d.v1})};
}

void setExtent(ElementGeometry& g, const Box& box) {
  g.lower = Vec3f(box.lower);
  g.upper = Vec3f(box.upper);
}

void shapeFlat(Elements& elements, ElementId e) {
  const PatchDomain& d = elements.domain[e.index()];
  const PlaneFrame& f = elements.frames[d.frame];
  const auto outline = elements.outline(e);
  ElementGeometry& g = elements.geometry[e.index()];
  ElementNodes& n = elements.nodes[e.index()];
  const double scale = areaScale(f);
  const double area = std::abs(outlineArea(outline)) * scale;
  const Vec3f normal = Vec3f(elements.at(e).front ? f.normal : -f.normal);
  g.area = static_cast<float>(area);
  g.normal = normal;
  g.normalCone = 1.0f;
  const Vec3 center = f.at(outlineCentroid(outline));
  g.center = Vec3f(center);
  Box box;
  double radius = 0;
  for (const Vec2& q : outline) {
    const Vec3 p = f.at(q);
    box.extend(p);
    radius = std::max(radius, glm::length(p - center));
  }
  g.radius = static_cast<float>(radius);
  setExtent(g, box);

  // One node per quadrant of the rectangle: the centroid of what the outline leaves of it.
  const double um = 0.5 * (d.u0 + d.u1), vm = 0.5 * (d.v0 + d.v1);
  for (int q = 0; q < 4; ++q) {
    const auto half = clipOutline(outline, 0, um, (q & 1) == 0);
    const auto quarter = clipOutline(half, 1, vm, (q & 2) == 0);
    const double part = quarter.size() < 3 ? 0.0 : std::abs(outlineArea(quarter)) * scale;
    Vec2 c = part > 0 ? outlineCentroid(quarter) : Vec2(0.0);
    if (part > 0 && quarter.size() > 4 && !outlineContains(quarter, c)) {
      // The centroid lies in a hole: take a point halfway to the first vertex that is inside.
      for (const Vec2& vertex : quarter) {
        const Vec2 candidate = glm::mix(c, vertex, 0.97);
        if (outlineContains(quarter, candidate)) {
          c = candidate;
          break;
        }
      }
    }
    n.position[q] = part > 0 ? Vec3f(f.at(c)) : g.center;
    n.normal[q] = normal;
    n.weight[q] = area > 0 ? static_cast<float>(part / area) : 0.25f;
  }
  elements.moments[e.index()] = {harmonics(normal)};
}

/// Area of the parameter rectangle, up to the primitive's total: equal-area shapes by proportion, cones by the radius.
double curvedArea(const Shape& shape, const PatchDomain& d) {
  const double whole = area(shape) * (d.u1 - d.u0);
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    const auto integral = [&](double v) { return cone->radius0 * v + 0.5 * (cone->radius1 - cone->radius0) * v * v; };
    return whole * (integral(d.v1) - integral(d.v0)) / integral(1.0);
  }
  return whole * (d.v1 - d.v0);
}

/// How a patch of a curved shape turns between neighbouring points of a grid: by what angle, about what radius.
/// Along the axes of cylinders and cones, and away from the centres of rings, it does not.
struct Turn {
  double angle, radius;
};

Turn turnOf(const Shape& shape, const PatchDomain& d, int grid) {
  const double around = 2 * kPi * (d.u1 - d.u0) / grid;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return {around, cylinder->radius};
  if (const auto* cone = std::get_if<Cone>(&shape)) return {around, std::max(cone->radius0, cone->radius1)};
  if (const auto* ring = std::get_if<Ring>(&shape)) return {around, ring->outerRadius};
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    double most = around;  // and along meridians, where v goes evenly in height
    const auto latitude = [&](int j) {
      return std::asin(std::clamp(2 * (d.v0 + (d.v1 - d.v0) * double(j) / grid) - 1, -1.0, 1.0));
    };
    for (int j = 0; j < grid; ++j) most = std::max(most, latitude(j + 1) - latitude(j));
    return {most, sphere->radius};
  }
  return {2 * kPi * std::max(d.u1 - d.u0, d.v1 - d.v0) / grid, 0.5 * bounds(shape).diagonal()};
}

void shapeCurved(Elements& elements, const Scene& scene, ElementId e) {
  const PatchDomain& d = elements.domain[e.index()];
  const Shape& shape = scene[d.primitive].shape;
  const float sign = elements.at(e).front ? 1.0f : -1.0f;
  ElementGeometry& g = elements.geometry[e.index()];
  ElementNodes& n = elements.nodes[e.index()];
  g.area = static_cast<float>(curvedArea(shape, d));
  const double du = d.u1 - d.u0, dv = d.v1 - d.v0;

  // A grid of points and normals bounds the patch, widened by how far the surface bulges between grid points.
  std::array<Vec3f, (tuning::kGrid + 1) * (tuning::kGrid + 1)> normals;
  Box box;
  Vec3f mean(0.0f), center(0.0f);
  NormalMoments moments;
  float weights = 0;
  const auto* cone = std::get_if<Cone>(&shape);
  for (int j = 0; j <= tuning::kGrid; ++j) {
    for (int i = 0; i <= tuning::kGrid; ++i) {
      const double v = d.v0 + dv * j / tuning::kGrid;
      const SurfacePoint p = pointAt(shape, {d.u0 + du * i / tuning::kGrid, v});
      const Vec3f normal = sign * Vec3f(p.normal);
      normals[static_cast<std::size_t>(j * (tuning::kGrid + 1) + i)] = normal;
      box.extend(p.position);
      const float radius = cone ? static_cast<float>(cone->radius0 + v * (cone->radius1 - cone->radius0)) : 1.0f;
      const float w =
          radius * (i == 0 || i == tuning::kGrid ? 0.5f : 1.0f) * (j == 0 || j == tuning::kGrid ? 0.5f : 1.0f);
      const auto y = harmonics(normal);
      for (int k = 0; k < kHarmonics; ++k) moments.m[k] += w * y[k];
      mean += w * normal;
      center += w * Vec3f(p.position);
      weights += w;
    }
  }
  for (float& m : moments.m) m /= weights;
  elements.moments[e.index()] = moments;
  g.center = center / weights;
  const Box whole = bounds(shape);
  const Turn turn = turnOf(shape, d, tuning::kGrid);
  const double bulge = (1 - std::cos(std::min(kPi / 2, 0.5 * turn.angle))) * turn.radius;
  box = {glm::max(box.lower - bulge, whole.lower), glm::min(box.upper + bulge, whole.upper)};
  setExtent(g, box);
  g.radius = static_cast<float>(0.5 * box.diagonal());
  const float length = glm::length(mean) / weights;
  g.normal = length > 0.05f ? glm::normalize(mean) : Vec3f(0.0f);
  g.normalCone = -1.0f;
  if (length > 0.05f) {
    g.normalCone = 1.0f;
    for (const Vec3f& normal : normals) g.normalCone = std::min(g.normalCone, glm::dot(normal, g.normal));
    const double turning = std::holds_alternative<Ring>(shape) ? 0 : 0.25 * turn.angle;
    const double widened = std::acos(std::clamp(static_cast<double>(g.normalCone), -1.0, 1.0)) + turning;
    g.normalCone = widened >= kPi ? -1.0f : static_cast<float>(std::cos(widened));
  }
  for (int q = 0; q < 4; ++q) {
    const double u = d.u0 + du * ((q & 1) ? 0.75 : 0.25), v = d.v0 + dv * ((q & 2) ? 0.75 : 0.25);
    const SurfacePoint p = pointAt(shape, {u, v});
    n.position[q] = Vec3f(p.position);
    n.normal[q] = sign * Vec3f(p.normal);
    n.weight[q] = cone ? static_cast<float>(cone->radius0 + v * (cone->radius1 - cone->radius0)) : 1.0f;
  }
  const float sum = n.weight[0] + n.weight[1] + n.weight[2] + n.weight[3];
  for (float& w : n.weight) w /= sum;
}

/// Sums over the faces of a patch.
struct FaceSums {
  Box box;
  Vec3 center{0}, normal{0};
  double area = 0;

  FaceSums& operator+=(const FaceSums& o) {
    box.extend(o.box);
    center += o.center, normal += o.normal, area += o.area;
    return *this;
  }
};

/// The farthest of the faces' corners from a centre, squared, the least cosine to a normal, and means over normals.
struct FaceSpread {
  double radius = 0, cone = 1;
  NormalMoments moments;

  FaceSpread& operator+=(const FaceSpread& o) {
    radius = std::max(radius, o.radius), cone = std::min(cone, o.cone);
    for (int k = 0; k < kHarmonics; ++k) moments.m[k] += o.moments.m[k];
    return *this;
  }
};

void shapeFaces(Elements& elements, const Scene& scene, ElementId e) {
  constexpr std::size_t kBlock = 2048;  // [task]
  const auto& mesh = std::get<Mesh>(scene[elements.domain[e.index()].primitive].shape);
  const FaceOrder& order = elements.orderOf(e);
  const FaceRange range = elements.facesOf(e);
  const double sign = elements.at(e).front ? 1.0 : -1.0;
  ElementGeometry& g = elements.geometry[e.index()];
  ElementNodes& n = elements.nodes[e.index()];
  const auto cornersOf = [&](std::size_t i) {
    const auto& [a, b, c] = mesh.triangles[order.faceAt(range.first + static_cast<std::uint32_t>(i))];
    return std::array<Vec3, 3>{mesh.positions[a], mesh.positions[b], mesh.positions[c]};
  };
  const auto areaVector = [&](const std::array<Vec3, 3>& p) {
    return 0.5 * sign * glm::cross(p[1] - p[0], p[2] - p[0]);
  };
  FaceSums sums = parallelSum<FaceSums>(range.count, kBlock, [&](std::size_t i) {
    const std::array<Vec3, 3> p = cornersOf(i);
    FaceSums face;
    for (const Vec3& q : p) face.box.extend(q);
    face.normal = areaVector(p), face.area = glm::length(face.normal);
    face.center = face.area / 3 * (p[0] + p[1] + p[2]);
    return face;
  });
  sums.center /= sums.area;
  g.area = static_cast<float>(sums.area);
  g.center = Vec3f(sums.center);
  setExtent(g, sums.box);
  const bool hasNormal = glm::length(sums.normal) > 0.05 * sums.area;
  const Vec3 normal = hasNormal ? glm::normalize(sums.normal) : Vec3(0);
  g.normal = Vec3f(normal);
  const FaceSpread spread = parallelSum<FaceSpread>(range.count, kBlock, [&](std::size_t i) {
    const std::array<Vec3, 3> p = cornersOf(i);
    const Vec3 v = areaVector(p);
    const double area = glm::length(v);
    FaceSpread face;
    for (const Vec3& q : p) face.radius = std::max(face.radius, glm::dot(q - sums.center, q - sums.center));
    face.cone = glm::dot(v, normal) / area;
    const auto y = harmonics(Vec3f(v / area));
    for (int k = 0; k < kHarmonics; ++k) face.moments.m[k] = static_cast<float>(area / sums.area) * y[k];
    return face;
  });
  g.radius = static_cast<float>(std::sqrt(spread.radius));
  // Rounding must not part normals that are all the same from their mean.
  g.normalCone = spread.cone > 1 - 1e-9 ? 1.0f : hasNormal ? static_cast<float>(spread.cone) - 1e-6f : -1.0f;
  elements.moments[e.index()] = spread.moments;
  for (int q = 0; q < 4; ++q) {
    const PatchPoint p = pointOn(elements, scene, e, (q + 0.5) / 4, 1.0 / 3);
    n.position[q] = p.position, n.normal[q] = p.normal, n.weight[q] = 0.25f;
  }
}

}  // namespace

void shapePatch(Elements& elements, const Scene& scene, ElementId patch) {
  if (elements.hasFaces(patch))
    shapeFaces(elements, scene, patch);
  else if (elements.at(patch).flat)
    shapeFlat(elements, patch);
  else
    shapeCurved(elements, scene, patch);
}

void shapeDistant(Elements& elements, const Scene& scene, ElementId e) {
  const PatchDomain& d = elements.domain[e.index()];
  const Light& light = scene[elements.light[e.index()]];
  ElementGeometry& g = elements.geometry[e.index()];
  ElementLight& r = elements.radiometry[e.index()];
  const auto* sun = std::get_if<SunLight>(&light.emitter);
  const auto* dome = std::get_if<DomeLight>(&light.emitter);
  const double halfAngle = sun ? sun->angularRadius : dome->halfAngle;
  g.area = static_cast<float>(4 * kPi * std::pow(std::sin(0.5 * halfAngle), 2) * (d.u1 - d.u0) * (d.v1 - d.v0));

  Vec3f mean(0.0f);
  RgbSum radiance(0.0);
  for (int j = 0; j < tuning::kGrid; ++j) {
    for (int i = 0; i < tuning::kGrid; ++i) {
      const Vec3f w = directionOf(elements, scene, e, (i + 0.5) / tuning::kGrid, (j + 0.5) / tuning::kGrid);
      mean += w;
      radiance += RgbSum(sun ? sun->radiance : skyRadiance(*dome, Vec3(w))) / double(tuning::kGrid * tuning::kGrid);
    }
  }
  r.B = Rgb(radiance) * light.scale;
  g.center = glm::length(mean) > 1e-3f ? glm::normalize(mean) : directionOf(elements, scene, e, 0.5, 0.0);
  g.normal = -g.center;
  g.normalCone = 1.0f;
  // The far box holds the cell's directions at a distance at which the scene is small.
  const double distance = 100.0 * std::max(elements.sceneBox.diagonal(), 1e-6);
  const Vec3 origin = elements.sceneBox.empty() ? Vec3(0.0) : elements.sceneBox.center();
  Box box;
  for (int j = 0; j <= tuning::kGrid; ++j) {
    for (int i = 0; i <= tuning::kGrid; ++i) {
      const Vec3f w = directionOf(elements, scene, e, double(i) / tuning::kGrid, double(j) / tuning::kGrid);
      g.normalCone = std::min(g.normalCone, glm::dot(w, g.center));
      box.extend(origin + distance * Vec3(w));
    }
  }
  const double step = halfAngle * 2 * std::max(d.u1 - d.u0, d.v1 - d.v0) / tuning::kGrid;
  const double bulge = distance * (1 - std::cos(std::min(kPi / 2, step)));
  setExtent(g, {box.lower - bulge, box.upper + bulge});
  g.radius = static_cast<float>(std::acos(std::clamp(g.normalCone, -1.0f, 1.0f)));  // angular, for distant elements
  for (int q = 0; q < 4; ++q) {
    elements.nodes[e.index()].position[q] =
        directionOf(elements, scene, e, (q & 1) ? 0.75 : 0.25, (q & 2) ? 0.75 : 0.25);
    elements.nodes[e.index()].normal[q] = -elements.nodes[e.index()].position[q];
    elements.nodes[e.index()].weight[q] = 0.25f;
  }
}

Walls wallsAcross(const Elements& elements, const Scene& scene, ElementId e) {
  if (!elements.at(e).flat) return {};
  const PatchDomain& d = elements.domain[e.index()];
  const Vec2 size = worldSize(elements, scene, e);
  const auto height = static_cast<float>(tuning::kWall * std::sqrt(size.x * size.y));
  return {elements.contacts.across({d.frame, 0, d.u0, d.u1, d.v0, d.v1}, height),
          elements.contacts.across({d.frame, 1, d.v0, d.v1, d.u0, d.u1}, height)};
}

namespace {

/// What an element is split into.
struct Parts {
  std::vector<PatchDomain> domains;
  std::vector<std::vector<Vec2>> outlines;  // of each
};

/// Of a patch of many faces: such of fewer, and single faces, which are flat patches as others are.
Parts partsOfFaces(const Elements& elements, ElementId e) {
  Parts parts;
  const PatchDomain& whole = elements.domain[e.index()];
  for (const FaceRange& r : elements.orderOf(e).parts(elements.facesOf(e))) {
    PatchDomain d = whole;
    d.address = whole.address << 2 | parts.domains.size();
    d.triangle = elements.orderOf(e).faceAt(r.first);
    d.outline = r.first, d.outlineSize = r.count;
    if (r.count == 1) d.order = d.outline = d.outlineSize = 0;
    parts.domains.push_back(d);
  }
  parts.outlines.resize(parts.domains.size());
  return parts;
}

Parts partsOf(const Elements& elements, const Scene& scene, ElementId e) {
  Parts parts;
  const ElementTopology& parent = elements.at(e);
  const PatchDomain& whole = elements.domain[e.index()];
  if (parent.depth >= kMaxDepth || parent.kind == ElementKind::Cluster || parent.kind == ElementKind::Point)
    return parts;
  if (parent.kind == ElementKind::Distant && std::holds_alternative<SunLight>(scene[elements.light[e.index()]].emitter))
    return parts;
  if (parent.kind == ElementKind::Patch && elements.hasFaces(e)) return partsOfFaces(elements, e);

  bool splitU = true, splitV = true;
  float um = 0.5f * (whole.u0 + whole.u1), vm = 0.5f * (whole.v0 + whole.v1);
  if (parent.kind == ElementKind::Patch) {
    const Vec2 size = worldSize(elements, scene, e);
    // Halved rather than quartered where halves are nearer to squares.
    splitU = 2 * size.x * size.x > size.y * size.y;
    splitV = 2 * size.y * size.y > size.x * size.x;
    if (const Walls walls = wallsAcross(elements, scene, e); walls) {
      splitU = walls.u.has_value(), splitV = walls.v.has_value();
      um = walls.u.value_or(um), vm = walls.v.value_or(vm);
    }
  }
  for (int q = 0; q < 4; ++q) {
    if ((!splitU && (q & 1)) || (!splitV && (q & 2))) continue;
    PatchDomain d = whole;
    if (splitU) (q & 1 ? d.u0 : d.u1) = um;
    if (splitV) (q & 2 ? d.v0 : d.v1) = vm;
    d.address = whole.address << 2 | static_cast<std::uint64_t>(q);
    std::vector<Vec2> outline;
    if (parent.flat) {
      const auto source = elements.outline(e);
      outline.assign(source.begin(), source.end());
      if (splitU) outline = clipOutline(outline, 0, um, (q & 1) == 0);
      if (splitV) outline = clipOutline(outline, 1, vm, (q & 2) == 0);
      const double cell = double(d.u1 - d.u0) * double(d.v1 - d.v0);
      if (outline.size() < 3 || std::abs(outlineArea(outline)) < 1e-9 * cell) continue;
    }
    parts.domains.push_back(d);
    parts.outlines.push_back(std::move(outline));
  }
  return parts;
}

/// Gives the parts their places as children, in which nothing but their domains and planes is filled.
void placeParts(Elements& elements, const Scene& scene, ElementId e, const Parts& parts) {
  elements.addChildren(e, elements.at(e).kind, parts.domains.size());
  for (std::size_t i = 0; i < parts.domains.size(); ++i) {
    const ElementId c = elements.child(e, i);
    PatchDomain& d = elements.domain[c.index()];
    d = parts.domains[i];
    if (elements.hasFaces(e)) {
      if (!elements.hasFaces(c)) addPlane(elements, scene, c);
      continue;
    }
    elements.topology[c.index()].flat = elements.at(e).flat;
    d.outline = static_cast<std::uint32_t>(elements.outlines.size());
    d.outlineSize = static_cast<std::uint32_t>(parts.outlines[i].size());
    elements.outlines.insert(elements.outlines.end(), parts.outlines[i].begin(), parts.outlines[i].end());
  }
}

void fillChildren(Elements& elements, const Scene& scene, ElementId e) {
  const ElementTopology& parent = elements.at(e);
  for (std::size_t i = 0; i < parent.childCount; ++i) {
    const ElementId c = elements.child(e, i);
    ElementTopology& t = elements.topology[c.index()];
    t.front = parent.front, t.emitter = parent.emitter;
    t.depth = static_cast<std::uint8_t>(parent.depth + 1);
    elements.light[c.index()] = elements.light[e.index()];
    elements.key[c.index()] = combineKeys(elements.key[e.index()], elements.domain[c.index()].address);
    inherit(elements, c, e);
    if (parent.kind == ElementKind::Distant)
      shapeDistant(elements, scene, c);
    else
      shapePatch(elements, scene, c);
    if (elements.hasFaces(e)) elements.holdSides(c);
  }
}

}  // namespace

bool splitsAlike(const Elements& elements, const Scene& scene, ElementId e, const Elements& other, ElementId first,
                 std::size_t count) {
  const Parts parts = partsOf(elements, scene, e);
  if (parts.domains.size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const PatchDomain &a = parts.domains[i], &b = other.domain[first.index() + i];
    if (a.address != b.address || a.u0 != b.u0 || a.v0 != b.v0 || a.u1 != b.u1 || a.v1 != b.v1 ||
        a.triangle != b.triangle || (a.order > 0) != (b.order > 0))
      return false;
    if (a.order > 0 ? a.outline != b.outline || a.outlineSize != b.outlineSize
                    : !elements.hasFaces(e) && parts.outlines[i].size() != b.outlineSize)
      return false;
  }
  return true;
}

bool subdivide(Elements& elements, const Scene& scene, ElementId e) {
  if (!elements.isLeaf(e) || unfold(elements, e)) return true;
  const Parts parts = partsOf(elements, scene, e);
  if (parts.domains.empty()) return false;
  placeParts(elements, scene, e, parts);
  fillChildren(elements, scene, e);
  return true;
}

std::vector<char> subdivide(Elements& elements, const Scene& scene, std::span<const ElementId> all) {
  constexpr std::size_t kBlock = 64;  // elements of a task [task]
  std::vector<char> split(all.size(), true);
  std::vector<Parts> parts(all.size());
  for (const ElementId e : all)
    if (elements.hasFaces(e)) unfold(elements, e);  // lists its sides
  parallelFor(all.size(), kBlock, [&](std::size_t i) {
    if (elements.isLeaf(all[i]) && !unfold(elements, all[i])) parts[i] = partsOf(elements, scene, all[i]);
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!elements.isLeaf(all[i])) continue;
    if (parts[i].domains.empty())
      split[i] = false;
    else
      placeParts(elements, scene, all[i], parts[i]);
  }
  parallelFor(all.size(), kBlock, [&](std::size_t i) {
    if (!parts[i].domains.empty()) fillChildren(elements, scene, all[i]);
  });
  return split;
}

}  // namespace deltalux::hierarchy
