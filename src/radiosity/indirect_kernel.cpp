// Kernels of rows at a leaf.
#include <algorithm>
#include <cmath>

#include "radiosity/indirect_sampler.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/rounding.hpp"

namespace deltalux {

namespace {

constexpr float kNear = 8.0f;         // in radii of the leaf: nearer to a sender than this, K is taken at all its nodes
constexpr float kSmall = 0.5f;        // radius of a sender, in those of the leaf, that counts as small
constexpr int kFewSets = 2;           // of pairs of points, where K only shares out rays
constexpr int kPoints = 16;           // of the smaller of two patches
constexpr float kGauss = 1.1547005f;  // from centroids of quadrants to nodes that integrate cubics

bool isRectangle(const Elements& elements, ElementId patch) {
  const ElementNodes& n = elements.nodes[patch.index()];
  return elements.outline(patch).size() == 4 &&
         std::all_of(n.weight, n.weight + 4, [](float w) { return std::abs(w - 0.25f) < 1e-4f; });
}

/// Whether the plane of a flat patch runs through another: nodes of that may all lie behind it.
bool crosses(const ElementGeometry& g, const ElementGeometry& plane) {
  const Vec3f half = 0.5f * (g.upper - g.lower);
  const float extent = glm::dot(half, glm::abs(plane.normal));
  const float above = glm::dot(0.5f * (g.upper + g.lower) - plane.center, plane.normal);
  return extent - std::abs(above) > roundingAlong(plane.normal, g, plane);
}

}  // namespace

/// What is in plain view has no noise that would hide an error of K: then at all nodes, or, for a curved leaf close by,
/// at many points. What a large leaf gets of a small patch close to it lies between its nodes: then at the nodes of
/// that, the other way round, or, where the leaf is narrow, at many points. What faces a part of it may face none of
/// its nodes: at many points, too. What is curved and close has its light go between other places than nodes: then
/// between many points.
float IndirectSampler::kernelAtLeaf(ElementId leaf, ElementId sender, bool clear) const {
  const ElementGeometry &r = elements_.shape(leaf), &s = elements_.shape(sender);
  const bool flat = elements_.at(leaf).flat;
  if (exact(sender) && areClose(elements_, leaf, sender)) {
    if (flat ? crosses(r, s) : clear) return kernelOverPoints(leaf, sender);
    if (flat && s.radius < kSmall * r.radius)
      return s.area < r.area ? s.area / r.area * kernelOverNodes(sender, leaf) : kernelOverPoints(leaf, sender);
  }
  if (!exact(sender) && isClosePatch(leaf, sender)) return kernelOverPairs(leaf, sender, kFewSets);
  const float reach = kNear * r.radius + s.radius;
  const Vec3f d = s.center - r.center;
  if (!clear && !measures(leaf) && glm::dot(d, d) > reach * reach)
    return static_cast<float>(kernelAtPoint(elements_, scene_, r.center, r.normal, sender));
  return kernelOverNodes(leaf, sender);
}

float IndirectSampler::kernelOverNodes(ElementId at, ElementId of) const {
  const ElementGeometry& g = elements_.shape(at);
  const ElementNodes& n = elements_.nodes[at.index()];
  // Nodes of whole rectangles are moved to where Gauss has them.
  const float stretch = elements_.at(at).flat && isRectangle(elements_, at) ? kGauss : 1.0f;
  double K = 0;
  for (int i = 0; i < 4; ++i) {
    if (n.weight[i] <= 0) continue;
    const Vec3f x = g.center + stretch * (n.position[i] - g.center);
    K += n.weight[i] * kernelAtPoint(elements_, scene_, x, n.normal[i], of);
  }
  return static_cast<float>(K);
}

/// At points of the smaller of the two, each of which knows the part of the other that it faces. By chance, right in
/// the mean.
float IndirectSampler::kernelOverPoints(ElementId leaf, ElementId sender) const {
  const float A = elements_.shape(leaf).area, ofSender = elements_.shape(sender).area;
  const bool turned = elements_.at(leaf).flat && ofSender < A;
  const ElementId at = turned ? sender : leaf, of = turned ? leaf : sender;
  const std::uint64_t key = combineKeys(combineKeys(elements_.key[leaf.index()], elements_.key[sender.index()]), 12);
  double sum = 0;
  for (int k = 0; k < kPoints; ++k) {
    const auto u = stratified4(key, k);
    const PatchPoint x = samplePatch(elements_, scene_, at, u[0], u[1]);
    sum += kernelAtPoint(elements_, scene_, x.position, x.normal, of);
  }
  return static_cast<float>(sum / kPoints) * (turned ? ofSender / A : 1.0f);
}

/// From points of the smaller of the two. By chance, right in the mean.
float IndirectSampler::kernelOverPairs(ElementId leaf, ElementId sender, int sets) const {
  const float A = elements_.shape(leaf).area, ofSender = elements_.shape(sender).area;
  const bool turned = ofSender < A;
  const ElementId from = turned ? sender : leaf, to = turned ? leaf : sender;
  const std::uint64_t key = combineKeys(combineKeys(elements_.key[leaf.index()], elements_.key[sender.index()]), 11);
  double sum = 0;
  for (int k = 0; k < sets * kClosePairs; ++k) {
    const auto u = stratified4(key, k);
    const PatchPoint x = samplePatch(elements_, scene_, from, u[2], u[3]);
    sum += closePair(elements_, scene_, x, to, k % kClosePairs, u[0], u[1]).weight;
  }
  return static_cast<float>(sum / sets) * (turned ? ofSender / A : 1.0f);
}

}  // namespace deltalux
