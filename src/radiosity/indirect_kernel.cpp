// Kernels of rows at a leaf.
#include <algorithm>
#include <cmath>

#include "paper/kernel.hpp"
#include "paper/rounding.hpp"
#include "radiosity/indirect_sampler.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kNearSender = 8.0f;  // in radii of the leaf: nearer to a sender than this, K is taken at all its nodes
constexpr float kSmall = 0.5f;       // radius of a sender, in those of the leaf, that counts as small
constexpr int kFewSets = 2;          // of pairs of points, where K only shares out rays
constexpr int kPoints = 16;          // of the smaller of two patches
constexpr float kGauss = 0.57735027f;  // place of the two nodes that integrate cubics, from the middle to the end
constexpr float kMostPieces = 6.0f;    // of a rectangle that is longer than wide

bool isRectangle(const hierarchy::Elements& elements, hierarchy::ElementId patch) {
  const hierarchy::ElementNodes& n = elements.nodes[patch.index()];
  return elements.outline(patch).size() == 4 &&
         std::all_of(n.weight, n.weight + 4, [](float w) { return std::abs(w - 0.25f) < 1e-4f; });
}

/// Visits where Gauss has the nodes of a whole rectangle, 2 x 2; where it is longer than wide and `pieces` are asked
/// for, of each of some about as long as they are wide.
template <class Visit>
void forEachGaussNode(const hierarchy::ElementGeometry& g, const hierarchy::ElementNodes& n, bool pieces,
                      const Visit& visit) {
  Vec3f u = n.position[1] - n.position[0], v = n.position[2] - n.position[0];  // halves of the sides
  if (glm::dot(u, u) < glm::dot(v, v)) std::swap(u, v);
  const float ratio = glm::length(u) / std::max(glm::length(v), 1e-30f);
  const int count = pieces ? static_cast<int>(std::clamp(std::round(ratio), 1.0f, kMostPieces)) : 1;
  u /= static_cast<float>(count);
  for (int piece = 0; piece < count; ++piece) {
    const Vec3f middle = g.center + static_cast<float>(2 * piece + 1 - count) * u;
    for (const float a : {-kGauss, kGauss})
      for (const float b : {-kGauss, kGauss}) visit(middle + a * u + b * v, 0.25f / static_cast<float>(count));
  }
}

/// Whether the plane of a flat patch runs through another: nodes of that may all lie behind it.
bool crosses(const hierarchy::ElementGeometry& g, const hierarchy::ElementGeometry& plane) {
  const Vec3f half = 0.5f * (g.upper - g.lower);
  const float extent = glm::dot(half, glm::abs(plane.normal));
  const float above = glm::dot(0.5f * (g.upper + g.lower) - plane.center, plane.normal);
  return extent - std::abs(above) > paper::roundingAlong(plane.normal, g, plane);
}

}  // namespace

/// What is in plain view has no noise that would hide an error of K: then at all nodes, or, for a curved leaf close by,
/// at many points. What a large leaf gets of a smaller patch close to it lies between its nodes: then at the nodes of
/// that, the other way round, or, where the leaf is narrow, at many points. What faces a part of it may face none of
/// its nodes: at many points, too. What is curved and close has its light go between other places than nodes: then
/// between many points.
float IndirectSampler::kernelAtLeaf(hierarchy::ElementId leaf, hierarchy::ElementId sender, bool clear) const {
  const hierarchy::ElementGeometry &r = elements_.shape(leaf), &s = elements_.shape(sender);
  const bool flat = elements_.at(leaf).flat;
  const bool close = exact(sender) && areClose(elements_, leaf, sender);
  if (close && !flat && clear) return kernelOverPoints(leaf, sender);
  if (close && flat) {
    const bool turned = s.area < r.area;
    const bool missed = turned ? crosses(s, r) : crosses(r, s) || s.radius < kSmall * r.radius;
    if (missed) return kernelOverPoints(leaf, sender);
    if (turned) return s.area / r.area * kernelOverNodes(sender, leaf);
  }
  if (!exact(sender) && isClosePatch(leaf, sender)) return kernelOverPairs(leaf, sender, kFewSets);
  const float reach = kNearSender * r.radius + s.radius;
  const Vec3f d = s.center - r.center;
  if (!clear && !measures(leaf) && glm::dot(d, d) > reach * reach)
    return static_cast<float>(paper::kernelAtPoint(elements_, scene_, r.center, r.normal, sender));
  return kernelOverNodes(leaf, sender);
}

float IndirectSampler::kernelOverNodes(hierarchy::ElementId at, hierarchy::ElementId of) const {
  const hierarchy::ElementGeometry& g = elements_.shape(at);
  const hierarchy::ElementNodes& n = elements_.nodes[at.index()];
  double K = 0;
  const auto add = [&](const Vec3f& x, const Vec3f& normal, float weight) {
    if (weight > 0) K += weight * paper::kernelAtPoint(elements_, scene_, x, normal, of);
  };
  if (elements_.at(at).flat && isRectangle(elements_, at)) {
    const auto visit = [&](const Vec3f& x, float weight) { add(x, g.normal, weight); };
    forEachGaussNode(g, n, areClose(elements_, at, of), visit);
  } else {
    for (int i = 0; i < 4; ++i) add(n.position[i], n.normal[i], n.weight[i]);
  }
  return static_cast<float>(K);
}

/// At points of the smaller of the two, each of which knows the part of the other that it faces. By chance, right in
/// the mean.
float IndirectSampler::kernelOverPoints(hierarchy::ElementId leaf, hierarchy::ElementId sender) const {
  const float A = elements_.shape(leaf).area, ofSender = elements_.shape(sender).area;
  const bool turned = elements_.at(leaf).flat && ofSender < A;
  const hierarchy::ElementId at = turned ? sender : leaf, of = turned ? leaf : sender;
  const std::uint64_t key = combineKeys(combineKeys(elements_.key[leaf.index()], elements_.key[sender.index()]), 12);
  double sum = 0;
  for (int k = 0; k < kPoints; ++k) {
    const auto u = paper::stratified4(key, k);
    const hierarchy::PatchPoint x = hierarchy::samplePatch(elements_, scene_, at, u[0], u[1]);
    sum += paper::kernelAtPoint(elements_, scene_, x.position, x.normal, of);
  }
  return static_cast<float>(sum / kPoints) * (turned ? ofSender / A : 1.0f);
}

/// From points of the smaller of the two. By chance, right in the mean.
float IndirectSampler::kernelOverPairs(hierarchy::ElementId leaf, hierarchy::ElementId sender, int sets) const {
  const float A = elements_.shape(leaf).area, ofSender = elements_.shape(sender).area;
  const bool turned = ofSender < A;
  const hierarchy::ElementId from = turned ? sender : leaf, to = turned ? leaf : sender;
  const std::uint64_t key = combineKeys(combineKeys(elements_.key[leaf.index()], elements_.key[sender.index()]), 11);
  double sum = 0;
  for (int k = 0; k < sets * kClosePairs; ++k) {
    const auto u = paper::stratified4(key, k);
    const hierarchy::PatchPoint x = hierarchy::samplePatch(elements_, scene_, from, u[2], u[3]);
    sum += closePair(elements_, scene_, x, to, k % kClosePairs, u[0], u[1]).weight;
  }
  return static_cast<float>(sum / sets) * (turned ? ofSender / A : 1.0f);
}

}  // namespace deltalux::radiosity
