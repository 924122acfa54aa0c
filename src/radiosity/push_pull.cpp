#include "radiosity/push_pull.hpp"

#include <algorithm>
#include <cmath>

#include "base/paged_array.hpp"
#include "base/parallel.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::radiosity {

namespace {

constexpr std::size_t kElementBlock = 256;
constexpr float kDarkest = 0.1f, kBrightest = 2.0f;  // tolerance of a leaf relative to its surface's first estimate
constexpr float kLeast = 1e-12f;

/// The same place on the other side of a surface, at no finer level; invalid when that side has no element.
hierarchy::ElementId otherSide(const hierarchy::Elements& elements, hierarchy::ElementId leaf) {
  const hierarchy::ElementId input = hierarchy::surfaceOf(elements, leaf);
  const hierarchy::PatchDomain &d = elements.domain[leaf.index()], &top = elements.domain[input.index()];
  const hierarchy::ElementId parent = elements.at(input).parent;
  hierarchy::ElementId other;
  for (std::size_t i = 0; i < elements.at(parent).childCount; ++i) {
    const hierarchy::ElementId c = elements.child(parent, i);
    if (elements.isPatch(c) && elements.domain[c.index()].primitive == top.primitive &&
        elements.domain[c.index()].triangle == top.triangle && elements.at(c).front != elements.at(input).front)
      other = c;
  }
  if (!other.valid()) return other;
  const float u = 0.5f * (d.u0 + d.u1), v = 0.5f * (d.v0 + d.v1);
  while (!elements.isLeaf(other) && elements.at(other).depth < elements.at(leaf).depth) {
    hierarchy::ElementId next;
    for (std::size_t i = 0; i < elements.at(other).childCount; ++i) {
      const hierarchy::PatchDomain& c = elements.domain[elements.child(other, i).index()];
      if (u >= c.u0 && u <= c.u1 && v >= c.v0 && v <= c.v1) next = elements.child(other, i);
    }
    if (!next.valid()) break;
    other = next;
  }
  return other;
}

/// Light from above each element: scalar below the input level, directional at clusters.
void push(hierarchy::Elements& elements) {
  std::vector<hierarchy::DirectionalRgb> direct(elements.clusters.size()), indirect(elements.clusters.size());
  std::vector<std::uint32_t> source(elements.size(), Id<void>::kNone);  // slot of the cluster above a patch
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementTopology& t = elements.topology[i];
    if (t.emitter) continue;
    if (t.kind == hierarchy::ElementKind::Cluster) {
      const std::uint32_t slot = elements.slot[i];
      const hierarchy::ClusterLight& own = elements.clusters[slot];
      direct[slot] = own.directGathered;
      indirect[slot] = own.indirectGathered;
      if (t.parent.valid()) {
        direct[slot] += direct[elements.slot[t.parent.index()]];
        indirect[slot] += indirect[elements.slot[t.parent.index()]];
      }
      continue;
    }
    hierarchy::ElementLight& light = elements.radiometry[i];
    light.direct = light.directGathered;
    light.indirect = light.indirectGathered;
    const bool input = t.depth == 0;
    source[i] = input ? elements.slot[t.parent.index()] : source[t.parent.index()];
    if (!input) {
      light.direct += elements.radiometry[t.parent.index()].direct;
      light.indirect += elements.radiometry[t.parent.index()].indirect;
    }
    // A flat surface takes its clusters' light once, a curved one where its orientation is known best: at the leaves.
    if (t.flat ? input : t.childCount == 0) {
      light.direct += direct[source[i]].mean(elements.moments[i]);
      light.indirect += indirect[source[i]].mean(elements.moments[i]);
    }
  }
}

/// The exposed share of what has parts.
void pullExposure(hierarchy::Elements& elements, std::size_t i) {
  const hierarchy::ElementTopology& t = elements.topology[i];
  if (t.kind != hierarchy::ElementKind::Patch || t.childCount == 0) return;
  double lit = 0, area = 0;
  for (std::size_t c = 0; c < t.childCount; ++c) {
    const hierarchy::ElementGeometry& g = elements.geometry[t.firstChild.index() + c];
    lit += g.litArea(), area += g.area;
  }
  if (area > 0) elements.geometry[i].exposed = static_cast<float>(lit / area);
}

void pullIrradiance(hierarchy::Elements& elements, std::size_t i) {
  const hierarchy::ElementTopology& t = elements.topology[i];
  if (t.emitter) return;
  hierarchy::ElementLight& light = elements.radiometry[i];
  if (t.childCount == 0) {
    // The first estimate is free of the leaks that a coarse solution has, so it bounds what may be tolerated.
    light.tolerance = std::clamp(gray(light.direct + light.indirect + light.particle), kDarkest * light.typical,
                                 kBrightest * light.typical);
    return;
  }
  RgbSum direct(0.0), indirect(0.0), particle(0.0);
  double area = 0, inverse = 0;
  for (std::size_t c = 0; c < t.childCount; ++c) {
    const std::size_t child = t.firstChild.index() + c;
    if (elements.topology[child].blocker) continue;
    const double a = elements.geometry[child].litArea();
    const hierarchy::ElementLight& l = elements.radiometry[child];
    direct += a * RgbSum(l.direct), indirect += a * RgbSum(l.indirect), particle += a * RgbSum(l.particle);
    inverse += a / std::max(l.tolerance, kLeast);
    area += a;
  }
  if (area <= 0) return;
  light.direct = Rgb(direct / area), light.indirect = Rgb(indirect / area), light.particle = Rgb(particle / area);
  // The harmonic mean: a cluster with dark surfaces must not let bright ones speak for them.
  light.tolerance = static_cast<float>(area / inverse);
}

void pullIntensity(hierarchy::Elements& elements, hierarchy::ElementId cluster) {
  hierarchy::DirectionalRgb& intensity = elements.clusters[elements.slot[cluster.index()]].intensity;
  intensity = {};
  for (std::size_t c = 0; c < elements.at(cluster).childCount; ++c) {
    const hierarchy::ElementId child = elements.child(cluster, c);
    if (elements.isCluster(child))
      intensity += elements.cluster(child).intensity;
    else if (elements.isPatch(child))
      intensity.addLobe(elements.moments[child.index()],
                        elements.shape(child).litArea() / float(kPi) * elements.radiometry[child.index()].B);
    else  // a point of any distribution, as bright all round as where it is brightest
      intensity.c[0] += elements.radiometry[child.index()].B / hierarchy::kConstantHarmonic;
  }
}

/// Adds the power by which a leaf's radiosity changes.
void reflectAndPull(hierarchy::Elements& elements, std::size_t i, RgbSum& change) {
  const hierarchy::ElementTopology& t = elements.topology[i];
  const hierarchy::ElementId e(i);
  if (t.kind == hierarchy::ElementKind::Cluster) return pullIntensity(elements, e);
  if (t.emitter) return;
  hierarchy::ElementLight& light = elements.radiometry[i];
  if (t.childCount == 0) {
    Rgb B = light.rho * (light.direct + light.indirect + light.particle);
    if (!isBlack(light.tau)) {
      const hierarchy::ElementId other = otherSide(elements, e);
      if (other.valid()) {
        const hierarchy::ElementLight& o = elements.radiometry[other.index()];
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

RgbSum pull(hierarchy::Elements& elements) {
  RgbSum change(0.0);
  for (std::size_t i = elements.size(); i-- > 0;) pullExposure(elements, i), pullIrradiance(elements, i);
  for (std::size_t i = elements.size(); i-- > 0;) reflectAndPull(elements, i, change);
  return change;
}

void addOtherSides(const hierarchy::Elements& elements, std::vector<hierarchy::ElementId>& leaves) {
  const std::size_t given = leaves.size();
  for (std::size_t i = 0; i < given; ++i) {
    if (isBlack(elements.radiometry[leaves[i].index()].tau)) continue;
    const hierarchy::ElementId other = otherSide(elements, leaves[i]);
    if (other.valid())
      hierarchy::forEachLeafBelow(elements, other, [&](hierarchy::ElementId leaf) { leaves.push_back(leaf); });
  }
}

RgbSum pull(hierarchy::Elements& elements, std::span<const hierarchy::ElementId> leaves) {
  PagedArray<char> marked(elements.size());
  const auto mark = [&](hierarchy::ElementId e) {
    for (; e.valid() && !marked[e.index()]; e = elements.at(e).parent) marked.at(e.index()) = 1;
  };
  std::vector<hierarchy::ElementId> lit(leaves.begin(), leaves.end());
  addOtherSides(elements, lit);
  for (const hierarchy::ElementId leaf : lit) mark(leaf);
  // Leaves apart from what is above them, which takes a small part of the time.
  std::vector<std::uint32_t> below, above;
  marked.forEach([&](std::size_t i, char) {
    (elements.topology[i].childCount == 0 ? below : above).push_back(static_cast<std::uint32_t>(i));
  });
  std::reverse(above.begin(), above.end());
  parallelFor(below.size(), kElementBlock, [&](std::size_t k) { pullIrradiance(elements, below[k]); });
  for (const std::uint32_t i : above) pullExposure(elements, i), pullIrradiance(elements, i);
  RgbSum change = parallelSum<RgbSum>(below.size(), kElementBlock, [&](std::size_t k) {
    RgbSum own(0.0);
    reflectAndPull(elements, below[k], own);
    return own;
  });
  for (const std::uint32_t i : above) reflectAndPull(elements, i, change);
  return change;
}

RgbSum pushPull(hierarchy::Elements& elements) {
  push(elements);
  return pull(elements);
}

}  // namespace deltalux::radiosity
