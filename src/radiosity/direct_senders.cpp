#include "radiosity/direct_senders.hpp"

#include <algorithm>

#include "radiosity/kernel.hpp"

namespace deltalux {

namespace {
constexpr std::uint32_t kFewLights = 4096;  // clusters of no more than these are told apart
constexpr float kLeastCosine = 0.1f;        // credited to senders only part of which rises above the horizon
constexpr float kLeastKernel = 0.02f;  // of the sender's solid angle: its few nodes may all face away, or lie below

/// Transfer that a sender of unknown orientation is credited with.
float leastKernel(const Elements& elements, const Vec3f& x, ElementId sender) {
  const ElementGeometry& g = elements.shape(sender);
  if (elements.isDistant(sender)) return kLeastKernel * g.area;
  if (!elements.isPatch(sender)) return 0.0f;
  const Vec3f d = g.center - x;
  return kLeastKernel * g.area / (float(kPi) * (glm::dot(d, d) + g.area));
}
}  // namespace

DirectSenders::DirectSenders(const Elements& elements, const Links& links, const Scene& scene)
    : elements_(elements), links_(links), scene_(scene) {
  lightCount_.assign(elements.size(), 0);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const ElementTopology& t = elements.topology[i];
    if (!t.emitter || t.kind == ElementKind::Distant || t.depth > 0) continue;
    if (t.kind != ElementKind::Cluster) lightCount_[i] = 1;
    if (t.parent.valid()) lightCount_[t.parent.index()] += lightCount_[i];
  }
}

void DirectSenders::addLights(ElementId e, ElementId leaf, const PossibleSender& by,
                              std::vector<PossibleSender>& out) const {
  if (elements_.isCluster(e) && lightCount_[e.index()] <= kFewLights) {
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) addLights(elements_.child(e, i), leaf, by, out);
    return;
  }
  const ElementGeometry& g = elements_.shape(leaf);
  const Vec3f normal = g.normalCone > 0 ? g.normal : Vec3f(0.0f);
  const double K = kernelAtPoint(elements_, scene_, g.center, normal, e);
  const float potential = std::max(static_cast<float>(K), leastKernel(elements_, g.center, e)) * strength(leaf, e);
  if (potential > 0) out.push_back({by.link, e, potential, by.open, by.rays});
}

float DirectSenders::strength(ElementId receiver, ElementId sender) const {
  if (!elements_.isCluster(sender)) return gray(elements_.radiometry[sender.index()].B);
  const Vec3f between = elements_.shape(receiver).center - elements_.shape(sender).center;
  const float distance = glm::length(between);
  const DirectionalRgb& intensity = elements_.cluster(sender).intensity;
  return gray(intensity.at(distance > 0 ? between / distance : Vec3f(0, 0, 1)));
}

std::vector<PossibleSender> DirectSenders::at(ElementId leaf) const {
  std::vector<PossibleSender> out;
  const ElementGeometry& g = elements_.shape(leaf);
  for (ElementId e = leaf; e.valid(); e = elements_.at(e).parent) {
    const bool cluster = elements_.isCluster(e);
    for (LinkId id = links_.first(e, true); id.valid(); id = links_[id].nextArriving) {
      const Link& l = links_[id];
      const bool sampled = l.visibility == Visibility::Sampled;
      PossibleSender a{id, l.sender, 0.0f, sampled ? maxChannel(l.V) : 1.0f, sampled ? l.samples : std::uint8_t{0}};
      if (elements_.isCluster(l.sender) && lightCount_[l.sender.index()] <= kFewLights) {
        addLights(l.sender, leaf, a, out);
        continue;
      }
      a.potential = std::max(l.K, leastKernel(elements_, elements_.shape(e).center, l.sender)) * strength(e, l.sender);
      if (cluster) {
        const ElementGeometry& s = elements_.shape(l.sender);
        const bool distant = elements_.isDistant(l.sender);
        const Vec3f between = distant ? s.center : s.center - g.center;
        const float distance = std::max(glm::length(between), 1e-20f);
        // How far the sender and the patch's own curvature reach above the horizon.
        const float extent = std::min(1.0f, distant ? s.radius : (s.radius + g.radius) / distance);
        const float bend = g.normalCone > 0 ? std::sqrt(1 - g.normalCone * g.normalCone) : 1.0f;
        const float cosine = glm::dot(g.normal, between) / distance;
        if (cosine + extent + bend <= 0) continue;
        a.potential *= std::max(cosine, kLeastCosine);
      }
      if (a.potential > 0) out.push_back(a);
    }
  }
  return out;
}

std::vector<PossibleSender> DirectSenders::at(const Vec3f& x, const Vec3f& normal) const {
  std::vector<PossibleSender> out;
  if (elements_.lightRoot.valid()) collectAll(elements_.lightRoot, x, normal, out);
  for (const ElementId e : elements_.distant) collectAll(e, x, normal, out);
  return out;
}

void DirectSenders::collectAll(ElementId e, const Vec3f& x, const Vec3f& normal,
                               std::vector<PossibleSender>& out) const {
  if (elements_.isCluster(e)) {
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) collectAll(elements_.child(e, i), x, normal, out);
    return;
  }
  double K = kernelAtPoint(elements_, scene_, x, normal, e);
  const ElementGeometry& g = elements_.shape(e);
  const bool above = elements_.isDistant(e) || glm::dot(g.center - x, normal) + g.radius > 0;
  if (above) K = std::max(K, double(leastKernel(elements_, x, e)));
  const float potential = static_cast<float>(K) * gray(elements_.radiometry[e.index()].B);
  if (potential > 0) out.push_back({{}, e, potential, 1.0f, 0});
}

}  // namespace deltalux
