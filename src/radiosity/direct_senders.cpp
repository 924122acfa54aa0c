#include "radiosity/direct_senders.hpp"

#include <algorithm>

#include "hierarchy/below.hpp"
#include "paper/kernel.hpp"
#include "paper/links_below.hpp"

namespace deltalux::radiosity {

namespace {
constexpr std::uint32_t kFewLights = 4096;  // clusters of no more than these are told apart
constexpr float kLeastCosine = 0.1f;        // credited to senders only part of which rises above the horizon
constexpr float kLeastSenderKernel =
    0.02f;  // of the sender's solid angle: its few nodes may all face away, or lie below

/// Transfer that a sender of unknown orientation is credited with.
float leastKernel(const hierarchy::Elements& elements, const Vec3f& x, hierarchy::ElementId sender) {
  const hierarchy::ElementGeometry& g = elements.shape(sender);
  if (elements.isDistant(sender)) return kLeastSenderKernel * g.area;
  if (!elements.isPatch(sender)) return 0.0f;
  const Vec3f d = g.center - x;
  return kLeastSenderKernel * g.area / (float(kPi) * (glm::dot(d, d) + g.area));
}
}  // namespace

float shownStrength(const hierarchy::Elements& elements, hierarchy::ElementId e) {
  return gray(elements.radiometry[e.index()].B);
}

float creditedStrength(const hierarchy::Elements& elements, hierarchy::ElementId e) {
  return std::max(shownStrength(elements, e), elements.radiometry[e.index()].typical);
}

void creditLights(hierarchy::Elements& elements) {
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (const hierarchy::ElementId e(i); elements.light[i].valid() && !elements.isCluster(e)) {
      float& credit = elements.radiometry[i].typical;
      credit = std::max(credit, shownStrength(elements, e) / kBrighter);
    }
}

DirectSenders::DirectSenders(const hierarchy::Elements& elements, const hierarchy::Links& links, const Scene& scene,
                             Strength strengthOf)
    : elements_(elements), links_(links), scene_(scene), strengthOf_(strengthOf), lightCount_(elements.size()) {
  for (const hierarchy::ElementId e : elements.inputs) {
    if (!elements.at(e).emitter || elements.isDistant(e)) continue;
    for (hierarchy::ElementId up = e; up.valid(); up = elements.at(up).parent) ++lightCount_.at(up.index());
  }
}

void DirectSenders::addLights(hierarchy::ElementId e, hierarchy::ElementId leaf, const PossibleSender& by,
                              std::vector<PossibleSender>& out) const {
  if (elements_.isCluster(e) && lightCount_[e.index()] <= kFewLights) {
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) addLights(elements_.child(e, i), leaf, by, out);
    return;
  }
  const hierarchy::ElementGeometry& g = elements_.shape(leaf);
  const Vec3f normal = g.normalCone > 0 ? g.normal : Vec3f(0.0f);
  const double K = paper::kernelAtPoint(elements_, scene_, g.center, normal, e);
  const float potential = std::max(static_cast<float>(K), leastKernel(elements_, g.center, e)) * strength(leaf, e);
  if (potential > 0) out.push_back({by.link, e, potential, by.open, by.rays});
}

float DirectSenders::strength(hierarchy::ElementId receiver, hierarchy::ElementId sender) const {
  if (!elements_.isCluster(sender)) return strengthOf_(elements_, sender);
  const Vec3f between = elements_.shape(receiver).center - elements_.shape(sender).center;
  const float distance = glm::length(between);
  const hierarchy::DirectionalRgb& intensity = elements_.cluster(sender).intensity;
  return gray(intensity.at(distance > 0 ? between / distance : Vec3f(0, 0, 1)));
}

void DirectSenders::addLink(hierarchy::LinkId id, hierarchy::ElementId leaf, std::vector<PossibleSender>& out) const {
  const hierarchy::Link& l = links_[id];
  const hierarchy::ElementId e = l.receiver;
  const hierarchy::ElementGeometry& g = elements_.shape(leaf);
  const bool sampled = l.visibility == hierarchy::Visibility::Sampled;
  PossibleSender a{id, l.sender, 0.0f, sampled ? maxChannel(l.V) : 1.0f, sampled ? l.samples : std::uint8_t{0}};
  if (elements_.isCluster(l.sender) && lightCount_[l.sender.index()] <= kFewLights)
    return addLights(l.sender, leaf, a, out);
  a.potential = std::max(l.K, leastKernel(elements_, elements_.shape(e).center, l.sender)) * strength(e, l.sender);
  if (elements_.isCluster(e)) {
    const hierarchy::ElementGeometry& s = elements_.shape(l.sender);
    const bool distant = elements_.isDistant(l.sender);
    const Vec3f between = distant ? s.center : s.center - g.center;
    const float distance = std::max(glm::length(between), 1e-20f);
    // How far the sender and the patch's own curvature reach above the horizon.
    const float extent = std::min(1.0f, distant ? s.radius : (s.radius + g.radius) / distance);
    const float bend = g.normalCone > 0 ? std::sqrt(1 - g.normalCone * g.normalCone) : 1.0f;
    const float cosine = glm::dot(g.normal, between) / distance;
    if (cosine + extent + bend <= 0) return;
    a.potential *= std::max(cosine, kLeastCosine);
  }
  if (a.potential > 0) out.push_back(a);
}

std::vector<PossibleSender> DirectSenders::at(hierarchy::ElementId leaf) const {
  std::vector<PossibleSender> out;
  if (links_.size() == 0) {  // light is exchanged by lines
    const PossibleSender any{{}, {}, 0.0f, 1.0f, 0};
    if (elements_.lightRoot.valid()) addLights(elements_.lightRoot, leaf, any, out);
    for (const hierarchy::ElementId e : elements_.distant)
      hierarchy::forEachLeafBelow(elements_, e, [&](hierarchy::ElementId cell) { addLights(cell, leaf, any, out); });
    return out;
  }
  for (hierarchy::ElementId e = leaf; e.valid(); e = elements_.at(e).parent)
    for (hierarchy::LinkId id = links_.first(e, true); id.valid(); id = links_[id].nextArriving) addLink(id, leaf, out);
  return joined(out);
}

std::vector<PossibleSender> DirectSenders::over(std::span<const hierarchy::LinkId> links,
                                                hierarchy::ElementId leaf) const {
  std::vector<PossibleSender> out;
  for (const hierarchy::LinkId id : links)
    if (links_[id].carries()) addLink(id, leaf, out);
  return joined(out);
}

std::vector<PossibleSender> DirectSenders::joined(const std::vector<PossibleSender>& parts) const {
  std::vector<PossibleSender> out;
  for (PossibleSender s : parts) {
    if (!paper::isPartOfCurved(elements_, s.sender)) {
      out.push_back(s);
      continue;
    }
    s.link = paper::toWholeLight(links_, elements_, s.link);
    s.sender = links_[s.link].sender;
    s.rays = std::max<std::uint8_t>(s.rays, 1);  // other parts may be hidden: rays will tell
    const auto at = std::find_if(out.begin(), out.end(), [&](const PossibleSender& o) { return o.sender == s.sender; });
    if (at == out.end()) {
      out.push_back(s);
      continue;
    }
    const float potential = at->potential + s.potential;
    at->open = (at->open * at->potential + s.open * s.potential) / potential;
    at->potential = potential;
    at->rays = static_cast<std::uint8_t>(std::min(255, at->rays + s.rays));
  }
  return out;
}

std::vector<PossibleSender> DirectSenders::at(const Vec3f& x, const Vec3f& normal) const {
  std::vector<PossibleSender> out;
  if (elements_.lightRoot.valid()) collectAll(elements_.lightRoot, x, normal, out);
  for (const hierarchy::ElementId e : elements_.distant) collectAll(e, x, normal, out);
  return out;
}

void DirectSenders::collectAll(hierarchy::ElementId e, const Vec3f& x, const Vec3f& normal,
                               std::vector<PossibleSender>& out) const {
  if (elements_.isCluster(e) || (elements_.isDistant(e) && !elements_.isLeaf(e))) {
    for (std::size_t i = 0; i < elements_.at(e).childCount; ++i) collectAll(elements_.child(e, i), x, normal, out);
    return;
  }
  double K = paper::kernelAtPoint(elements_, scene_, x, normal, e);
  const hierarchy::ElementGeometry& g = elements_.shape(e);
  const bool above = elements_.isDistant(e) || glm::dot(g.center - x, normal) + g.radius > 0;
  if (above) K = std::max(K, double(leastKernel(elements_, x, e)));
  const float potential = static_cast<float>(K) * strengthOf_(elements_, e);
  if (potential > 0) out.push_back({{}, e, potential, 1.0f, 0});
}

}  // namespace deltalux::radiosity
