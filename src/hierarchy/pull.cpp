#include "hierarchy/pull.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/tuning.hpp"

namespace deltalux::hierarchy {

namespace {

constexpr float kLeast = 1e-12f;  // [rounding]

/// The same place on the other side of a surface, at no finer level; invalid when that side has no element.
ElementId otherSide(const Elements& elements, ElementId leaf) {
  const ElementId input = surfaceOf(elements, leaf);
  const PatchDomain &d = elements.domain[leaf.index()], &top = elements.domain[input.index()];
  const ElementId parent = elements.at(input).parent;
  ElementId other;
  for (std::size_t i = 0; i < elements.at(parent).childCount; ++i) {
    const ElementId c = elements.child(parent, i);
    if (elements.isPatch(c) && elements.domain[c.index()].primitive == top.primitive &&
        elements.domain[c.index()].triangle == top.triangle && elements.at(c).front != elements.at(input).front)
      other = c;
  }
  if (!other.valid()) return other;
  const float u = 0.5f * (d.u0 + d.u1), v = 0.5f * (d.v0 + d.v1);
  while (!elements.isLeaf(other) && elements.at(other).depth < elements.at(leaf).depth) {
    ElementId next;
    for (std::size_t i = 0; i < elements.at(other).childCount; ++i) {
      const PatchDomain& c = elements.domain[elements.child(other, i).index()];
      if (u >= c.u0 && u <= c.u1 && v >= c.v0 && v <= c.v1) next = elements.child(other, i);
    }
    if (!next.valid()) break;
    other = next;
  }
  return other;
}

/// The exposed share of what has parts.
void pullExposure(Elements& elements, std::size_t i) {
  const ElementTopology& t = elements.topology[i];
  if (t.kind != ElementKind::Patch || t.childCount == 0) return;
  double lit = 0, area = 0;
  for (std::size_t c = 0; c < t.childCount; ++c) {
    const ElementGeometry& g = elements.geometry[t.firstChild.index() + c];
    lit += g.litArea(), area += g.area;
  }
  if (area > 0) elements.geometry[i].exposed = static_cast<float>(lit / area);
}

void pullIrradiance(Elements& elements, std::size_t i) {
  const ElementTopology& t = elements.topology[i];
  if (t.emitter || t.kind == ElementKind::Away) return;
  ElementLight& light = elements.radiometry[i];
  if (t.childCount == 0) {
    // The first estimate is free of the leaks that a coarse solution has, so it bounds what may be tolerated.
    light.tolerance = std::max(gray(light.direct + light.indirect + light.particle),
                               static_cast<float>(deltalux::tuning::kChangeMatters) * light.typical);
    return;
  }
  RgbSum direct(0.0), indirect(0.0), particle(0.0);
  double area = 0, inverse = 0;
  for (std::size_t c = 0; c < t.childCount; ++c) {
    const std::size_t child = t.firstChild.index() + c;
    if (elements.topology[child].blocker) continue;
    const double a = elements.geometry[child].litArea();
    const ElementLight& l = elements.radiometry[child];
    direct += a * RgbSum(l.direct), indirect += a * RgbSum(l.indirect), particle += a * RgbSum(l.particle);
    inverse += a / std::max(l.tolerance, kLeast);
    area += a;
  }
  if (area <= 0) return;
  light.direct = Rgb(direct / area), light.indirect = Rgb(indirect / area), light.particle = Rgb(particle / area);
  // The harmonic mean: a cluster with dark surfaces must not let bright ones speak for them.
  light.tolerance = static_cast<float>(area / inverse);
}

void pullIntensity(Elements& elements, ElementId cluster) {
  DirectionalRgb& intensity = elements.clusters[elements.slot[cluster.index()]].intensity;
  intensity = {};
  for (std::size_t c = 0; c < elements.at(cluster).childCount; ++c) {
    const ElementId child = elements.child(cluster, c);
    if (elements.isCluster(child))
      intensity += elements.cluster(child).intensity;
    else if (elements.isPatch(child))
      intensity.addLobe(elements.moments[child.index()],
                        elements.shape(child).litArea() / float(kPi) * elements.radiometry[child.index()].B);
    else  // a point of any distribution, as bright all round as where it is brightest
      intensity.c[0] += elements.radiometry[child.index()].B / kConstantHarmonic;
  }
}

/// Adds the power by which a leaf's radiosity changes.
void reflectAndPull(Elements& elements, std::size_t i, RgbSum& change) {
  const ElementTopology& t = elements.topology[i];
  const ElementId e(i);
  if (t.kind == ElementKind::Cluster) return pullIntensity(elements, e);
  if (t.emitter || t.kind == ElementKind::Away) return;
  ElementLight& light = elements.radiometry[i];
  if (t.childCount == 0) {
    Rgb B = light.rho * (light.direct + light.indirect + light.particle);
    if (!isBlack(light.tau)) {
      const ElementId other = otherSide(elements, e);
      if (other.valid()) {
        const ElementLight& o = elements.radiometry[other.index()];
        B += light.tau * (o.direct + o.indirect + o.particle);
      }
    }
    change += RgbSum(elements.geometry[i].litArea() * glm::abs(B - light.B));
    light.B = B;
    return;
  }
  RgbSum power(0.0);
  double total = 0;
  for (std::size_t c = 0; c < t.childCount; ++c) {
    const std::size_t child = t.firstChild.index() + c;
    power += double(elements.geometry[child].litArea()) * RgbSum(elements.radiometry[child].B);
    total += elements.geometry[child].litArea();
  }
  if (total > 0) light.B = Rgb(power / total);
}

}  // namespace

RgbSum pull(Elements& elements) {
  RgbSum change(0.0);
  for (std::size_t i = elements.size(); i-- > 0;) pullExposure(elements, i), pullIrradiance(elements, i);
  for (std::size_t i = elements.size(); i-- > 0;) reflectAndPull(elements, i, change);
  return change;
}

RgbSum pull(Elements& elements, std::span<const char> marked) {
  RgbSum change(0.0);
  for (std::size_t i = elements.size(); i-- > 0;)
    if (marked[i]) pullExposure(elements, i), pullIrradiance(elements, i);
  for (std::size_t i = elements.size(); i-- > 0;)
    if (marked[i]) reflectAndPull(elements, i, change);
  return change;
}

}  // namespace deltalux::hierarchy
