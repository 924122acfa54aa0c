// Which cell below a node a particle starts from: by what cells send, and, towards a place close by, by how far they
// are.
#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "particles/senders.hpp"
#include "particles/tuning.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::particles {

namespace {
/// A few digits only, see Receivers.
double rounded(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 12)), exponent - 12);
}
}  // namespace

void Senders::weigh(std::span<const float> strength) {
  cumulative_.assign(1, 0.0);
  for (std::size_t i = 0; i < cells_.size(); ++i)
    cumulative_.push_back(cumulative_.back() + rounded(double(restMeasure_[i]) * strength[i]));
  for (std::size_t n = 0; n < nodes_.size(); ++n) near_[n].weight = weightOf(nodes_[n]);
}

Senders::Choice Senders::choose(std::uint32_t at, double u) const {
  const RadixNode& node = nodes_[at];
  if (node.isLeaf()) return {node.begin, 1};
  const double target = cumulative_[node.begin] + u * weightOf(node);
  const auto first = cumulative_.begin() + node.begin + 1, last = cumulative_.begin() + node.end;
  const auto cell = static_cast<std::uint32_t>(std::upper_bound(first, last, target) - cumulative_.begin() - 1);
  return {cell, weight(cell) / weightOf(node)};
}

void Senders::rememberRest() {
  near_.resize(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    NearNode& near = near_[n];
    const RadixNode& node = nodes_[n];
    near.center = bounds_[n].center, near.squaredRadius = bounds_[n].radius * bounds_[n].radius;
    near.child[0] = node.child[0], near.child[1] = node.child[1];
    const SenderCell &first = cells_[node.begin], &last = cells_[node.end - 1];
    if (normals_[n].cosine < 1 || first.primitive != last.primitive || first.front != last.front) continue;
    near.normal = normals_[n].axis;
    const SurfacePoint p = samplePoint(scene::edits::restShape(scene_, first.primitive), first.rect.at({0.5, 0.5}));
    near.offset = glm::dot(near.normal, p.position);
  }
}

Senders::Choice Senders::chooseNear(std::uint32_t at, const BoundingSphere& towards, double u) const {
  const double least = towards.radius * towards.radius;  // what is within stands about so far from something there
  const auto spread = [&](const NearNode& n) {
    const Vec3 d = n.center - towards.center;
    return glm::dot(d, d) + n.squaredRadius + least;
  };
  double chance = 1;
  while (near_[at].child[0] != RadixNode::kNone) {
    const std::uint32_t* child = near_[at].child;
    const NearNode &one = near_[child[0]], &other = near_[child[1]];
    // Weight over spread of the one, as a share of both.
    const double a = one.weight * spread(other) * (one.averted(towards) ? deltalux::tuning::kDefensive : 1.0);
    const double b = other.weight * spread(one) * (other.averted(towards) ? deltalux::tuning::kDefensive : 1.0);
    const double place = u * (a + b);
    const bool second = place >= a && b > 0;
    u = std::min(second ? (place - a) / b : place / a, 0x1.fffffffffffffp-1);
    chance *= (second ? b : a) / (a + b);
    at = child[second ? 1 : 0];
  }
  return {nodes_[at].begin, chance};
}

}  // namespace deltalux::particles
