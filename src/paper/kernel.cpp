#include "paper/kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/square.hpp"
#include "base/tuning.hpp"
#include "hierarchy/patch.hpp"
#include "paper/facing.hpp"
#include "paper/rounding.hpp"
#include "paper/tuning.hpp"
#include "scene/form_factor.hpp"

namespace deltalux::paper {

namespace {

bool isZero(const Vec3f& v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; }

/// Signed reach of a box above the plane through `p` with normal `n`.
float reachAbove(const hierarchy::ElementGeometry& g, const Vec3f& p, const Vec3f& n) {
  const Vec3f half = 0.5f * (g.upper - g.lower);
  return glm::dot(0.5f * (g.upper + g.lower) - p, n) + glm::dot(half, glm::abs(n));
}

/// Relative intensity of a point light into `w` (its colour is the element's B).
double relativeIntensity(const Light& light, const Vec3& w) {
  return std::visit(
      [&](const auto& emitter) -> double {
        if constexpr (requires { radiantIntensity(emitter, w); }) {
          const float value = maxChannel(radiantIntensity(emitter, w));
          float peak = 1;
          if constexpr (requires { emitter.intensity; })
            peak = maxChannel(emitter.intensity);
          else
            peak = maxChannel(emitter.scale);
          return peak > 0 ? value / peak : 0.0f;
        } else {
          return 0.0;
        }
      },
      light.emitter);
}

/// Of an emitter whose radiance depends on direction; null for others.
const Emission* directionalEmission(const hierarchy::Elements& elements, const Scene& scene,
                                    hierarchy::ElementId sender) {
  if (!elements.at(sender).emitter || !elements.isPatch(sender)) return nullptr;
  const auto& emission = scene.materialOf(elements.domain[sender.index()].primitive).emission;
  return emission && isDirectional(*emission) ? &*emission : nullptr;
}

/// World vertices of a flat patch's outline, up to 64.
std::size_t worldOutline(const hierarchy::Elements& elements, hierarchy::ElementId e, std::array<Vec3f, 64>& out) {
  const hierarchy::PlaneFrame& f = elements.frames[elements.domain[e.index()].frame];
  const auto outline = elements.outline(e);
  const std::size_t count = std::min<std::size_t>(outline.size(), out.size());
  for (std::size_t i = 0; i < count; ++i) out[i] = Vec3f(f.at(outline[i]));
  return count;
}

/// The point of `g`'s box nearest to `p`; for flat patches moved into their plane.
Vec3f nearestPoint(const hierarchy::ElementGeometry& g, const Vec3f& p, bool flat) {
  Vec3f q = glm::clamp(p, g.lower, g.upper);
  if (flat) q -= glm::dot(q - g.center, g.normal) * g.normal;
  return q;
}

/// Greatest cosine between `n` and the directions of a distant sender.
float highestDirection(const hierarchy::Elements& elements, hierarchy::ElementId sender, const Vec3f& n) {
  float top = -1;
  for (const Vec3f& w : elements.nodes[sender.index()].position) top = std::max(top, glm::dot(w, n));
  return top + elements.shape(sender).radius;
}

/// What two flat ends could exchange at most if both faced each other as far as they rise above each other's planes.
double crossingBound(const hierarchy::ElementGeometry& r, const hierarchy::ElementGeometry& s, float senderReach,
                     float receiverReach) {
  const float d = glm::length(r.center - s.center);
  const double squared = std::max(double(d) * d, double(s.area) / kPi);
  const double cosines = std::min(1.0, double(senderReach) / std::sqrt(squared)) *
                         std::min(1.0, double(receiverReach) / std::sqrt(squared));
  return 0.5 * cosines * s.area / (kPi * squared);
}

/// Whether the side of a curved shape looks at itself.
bool hollow(const Shape& shape, bool front) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.inward; })
          return s.inward == front;
        else
          return false;
      },
      shape);
}

}  // namespace

double pointKernel(const hierarchy::Elements& elements, const Scene& scene, const Vec3f& x, const Vec3f& n,
                   hierarchy::ElementId sender, const Vec3f& y, const Vec3f& m) {
  if (elements.isDistant(sender)) return isZero(n) ? 1.0 : std::max(0.0f, glm::dot(n, y));
  const Vec3f d = y - x;
  const float squared = glm::dot(d, d);
  if (squared <= 0) return 0;
  const float distance = std::sqrt(squared);
  const Vec3f w = d / distance;
  const float cosReceiver = isZero(n) ? 1.0f : glm::dot(n, w);
  if (cosReceiver <= 0) return 0;
  if (elements.isPoint(sender))
    return relativeIntensity(scene[elements.light[sender.index()]], -Vec3(w)) * cosReceiver / squared;
  if (elements.isCluster(sender)) return cosReceiver / squared;
  const float cosSender = -glm::dot(m, w);
  if (cosSender <= 0) return 0;
  double k = cosReceiver * cosSender / (kPi * squared);
  if (const Emission* emission = directionalEmission(elements, scene, sender))
    k *= relativeRadiance(*emission, -Vec3(w), distance);
  return k;
}

namespace {
/// Of a flat source whose radiance, not its intensity, is given by direction: it varies little over what is near.
bool isWindow(const Emission& emission) { return !emission.spot && emission.pattern && !emission.pattern->normal; }

/// Mean of the relative radiance over the nodes, as much as each sends to `x`.
double meanRadiance(const Emission& emission, const hierarchy::ElementNodes& nodes, const Vec3f& x, const Vec3f& n) {
  double sum = 0, weights = 0;
  for (int j = 0; j < 4; ++j) {
    const Vec3f d = nodes.position[j] - x;
    const double squared = glm::dot(d, d), distance = std::sqrt(squared);
    const double cosines = -double(glm::dot(n, d)) * glm::dot(nodes.normal[j], d);
    if (!(nodes.weight[j] > 0 && cosines > 0 && squared > 0)) continue;
    const double weight = nodes.weight[j] * cosines / (squared * squared);
    sum += weight * relativeRadiance(emission, -Vec3(d) / distance, distance);
    weights += weight;
  }
  if (weights > 0) return sum / weights;
  return relativeRadiance(emission, Vec3(-n), 1.0);  // the nodes lie below the horizon: what shows is high above it
}

/// Transfer from a flat patch some of its radii away. The nodes sample half of its extent: together with the centre
/// they give the mean to second order.
double toDistantFlat(const hierarchy::Elements& elements, const Scene& scene, const Vec3f& x, const Vec3f& n,
                     hierarchy::ElementId sender) {
  const hierarchy::ElementGeometry& g = elements.shape(sender);
  const hierarchy::ElementNodes& nodes = elements.nodes[sender.index()];
  double mean = 0;
  bool whole = true;
  for (int j = 0; j < 4; ++j) {
    if (nodes.weight[j] <= 0) continue;
    const double k = pointKernel(elements, scene, x, n, sender, nodes.position[j], nodes.normal[j]);
    whole = whole && k > 0;
    mean += nodes.weight[j] * k;
  }
  if (whole) mean += (mean - pointKernel(elements, scene, x, n, sender, g.center, g.normal)) / 3;
  return std::max(0.0, mean) * g.area;
}
/// The transfer between a point (unit normal; zero for a point of a cluster, which has no cosine) and a whole sender.
double kernelAtPoint(const hierarchy::Elements& elements, const Scene& scene, const Vec3f& x, const Vec3f& n,
                     hierarchy::ElementId sender) {
  const hierarchy::ElementGeometry& g = elements.shape(sender);
  const hierarchy::ElementNodes& nodes = elements.nodes[sender.index()];
  if (elements.isPoint(sender)) return pointKernel(elements, scene, x, n, sender, g.center, Vec3f(0.0f));
  const Emission* directional = directionalEmission(elements, scene, sender);
  if (elements.isPatch(sender) && elements.at(sender).flat && !isZero(n) && (!directional || isWindow(*directional))) {
    const Vec3f d = g.center - x;
    if (glm::dot(d, d) < square(deltalux::tuning::kFar * g.radius)) {
      // A point in its plane may come to lie above it by rounding, and would see half of it: the other side of a leaf.
      if (glm::dot(x - g.center, g.normal) <= roundingAlong(g.normal, x, g)) return 0;
      std::array<Vec3f, 64> outline;
      const std::size_t count = worldOutline(elements, sender, outline);
      const double F = scene::formFactorToPolygon(x, n, {outline.data(), count});
      return directional ? F * meanRadiance(*directional, nodes, x, n) : F;
    }
    return toDistantFlat(elements, scene, x, n, sender);
  }
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    if (nodes.weight[j] <= 0) continue;
    double k = pointKernel(elements, scene, x, n, sender, nodes.position[j], nodes.normal[j]);
    if (elements.isPatch(sender)) {
      // The kernel towards a disc of the node's area stays bounded when the points nearly touch.
      const Vec3f d = nodes.position[j] - x;
      const double squared = glm::dot(d, d), part = nodes.weight[j] * g.area;
      k *= g.area * squared / (squared + part / kPi);
    } else if (elements.isDistant(sender)) {
      k *= g.area;
    }
    sum += nodes.weight[j] * k;
  }
  return sum;
}

/// A hollow patch lights itself: mean over pairs of its nodes, of which little is certain.
void selfKernel(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId e, Kernel& result) {
  const hierarchy::ElementNodes& nodes = elements.nodes[e.index()];
  double sum = 0, weights = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      const double w = nodes.weight[i] * nodes.weight[j];
      sum +=
          w * pointKernel(elements, scene, nodes.position[i], nodes.normal[i], e, nodes.position[j], nodes.normal[j]);
      weights += w;
    }
  }
  if (weights > 0) result.K = static_cast<float>(std::min(1.0, sum / weights * elements.shape(e).area));
  result.receiverSpread = 0.5f * result.K;
}
}  // namespace

Kernel kernel(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId receiver,
              hierarchy::ElementId sender) {
  Kernel result;
  const hierarchy::ElementGeometry &r = elements.shape(receiver), &s = elements.shape(sender);
  const hierarchy::ElementTopology &rt = elements.at(receiver), &st = elements.at(sender);
  const bool clusterReceiver = rt.kind == hierarchy::ElementKind::Cluster,
             clusterSender = st.kind == hierarchy::ElementKind::Cluster;
  if (receiver == sender) {
    if (clusterReceiver)
      result.overlapping = true;
    else if (rt.flat || !hollow(scene[elements.domain[receiver.index()].primitive].shape, rt.front))
      result.averted = true;  // a flat or convex surface does not see itself
    else
      selfKernel(elements, scene, receiver, result);
    return result;
  }
  const bool distant = st.kind == hierarchy::ElementKind::Distant;
  const bool flatReceiver = rt.flat && !clusterReceiver,
             flatSender = st.flat && st.kind == hierarchy::ElementKind::Patch;
  float senderReach = s.radius, receiverReach = r.radius;  // how far each end rises above the other's plane
  if (flatReceiver) {
    senderReach = distant ? highestDirection(elements, sender, r.normal) : reachAbove(s, r.center, r.normal);
    result.averted = senderReach <= (distant ? 0.0f : roundingAlong(r.normal, r, s));
  }
  if (flatSender && !result.averted) {
    receiverReach = reachAbove(r, s.center, s.normal);
    result.averted = receiverReach <= roundingAlong(s.normal, r, s);
  }
  const bool curvedReceiver = !rt.flat && !clusterReceiver,
             curvedSender = !st.flat && st.kind == hierarchy::ElementKind::Patch;
  if (!result.averted && !distant && ((curvedReceiver && turnsAway(r, s)) || (curvedSender && turnsAway(s, r))))
    result.averted = true;
  if (result.averted) return result;
  if ((clusterReceiver || clusterSender) && st.kind != hierarchy::ElementKind::Distant) {
    result.overlapping = elements.box(receiver).overlaps(elements.box(sender));
    if (result.overlapping) return result;
  }

  const hierarchy::ElementNodes& nodes = elements.nodes[receiver.index()];
  const auto normalAt = [&](int i) { return clusterReceiver ? Vec3f(0.0f) : nodes.normal[i]; };
  double mean = 0;
  std::array<double, 4> at{};
  for (int i = 0; i < 4; ++i) {
    if (nodes.weight[i] <= 0) continue;
    at[i] = kernelAtPoint(elements, scene, nodes.position[i], normalAt(i), sender);
    mean += nodes.weight[i] * at[i];
  }
  double spread = 0;
  for (int i = 0; i < 4; ++i) spread += nodes.weight[i] * std::abs(at[i] - mean);
  if (flatReceiver) {
    // Nodes that lie alike see alike: the centre tells how K curves between them, and mends the mean of the nodes,
    // which samples half of the patch's extent, to second order where it is smooth.
    const double center = kernelAtPoint(elements, scene, r.center, r.normal, sender);
    spread = std::max(spread, std::abs(center - mean));
    if (std::abs(mean - center) < 0.3 * mean) mean += (mean - center) / 3.0;
  }
  if (!distant && s.radius < 0.5f * r.radius) {
    // A small sender close to a large receiver peaks between the nodes: look where it is nearest.
    const Vec3f x = nearestPoint(r, s.center, rt.flat && !clusterReceiver);
    const double peak = kernelAtPoint(elements, scene, x, rt.flat && !clusterReceiver ? r.normal : normalAt(0), sender);
    spread = std::max(spread, std::abs(peak - mean));
  }
  if (flatReceiver && flatSender && spread <= 0.5 * mean + 1e-12) {
    // The ends cross each other's planes: the nodes may all lie where little or nothing is seen.
    const bool crossing = reachAbove(s, r.center, -r.normal) > roundingAlong(r.normal, r, s) ||
                          reachAbove(r, s.center, -s.normal) > roundingAlong(s.normal, r, s);
    if (crossing) spread = std::max(spread, std::min(1.0, crossingBound(r, s, senderReach, receiverReach)) - mean);
  }
  result.K = static_cast<float>(mean);
  result.receiverSpread = static_cast<float>(spread);

  // Over the sender: its nodes one by one, seen from the receiver's centre.
  double low = kInfinity, high = 0;
  const hierarchy::ElementNodes& senderNodes = elements.nodes[sender.index()];
  for (int j = 0; j < 4 && st.kind != hierarchy::ElementKind::Point; ++j) {
    if (senderNodes.weight[j] <= 0) continue;
    double k = pointKernel(elements, scene, r.center, clusterReceiver ? Vec3f(0.0f) : r.normal, sender,
                           senderNodes.position[j], senderNodes.normal[j]);
    if (st.kind == hierarchy::ElementKind::Patch || st.kind == hierarchy::ElementKind::Distant) k *= s.area;
    low = std::min(low, k), high = std::max(high, k);
  }
  // Of that the mean over nodes is hardly off: a uniform sender is integrated, not sampled, and splitting it would only
  // hide the receiver's error.
  if (high > 0)
    result.senderSpread = static_cast<float>(deltalux::tuning::kChangeMatters * std::min(high - low, 2 * mean));
  // The inverse square counts from centres, and the harmonics from one direction.
  const float d = distant ? 1e30f : glm::length(r.center - s.center);
  if (clusterSender) {
    result.senderSpread += (tuning::kClusterSpread + std::min(1.0f, s.radius / d)) * result.K;
    result.receiverSpread += std::min(1.0f, 0.5f * r.radius / d) * result.K;
  }
  if (clusterReceiver) result.receiverSpread += (tuning::kClusterSpread + std::min(1.0f, r.radius / d)) * result.K;
  return result;
}

}  // namespace deltalux::paper
