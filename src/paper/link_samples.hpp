#pragma once
// The rays by which the visibility of a link is sampled: between points of its ends, weighted by the kernel. Points of
// clusters are points of their surfaces, so that what a cluster hides of itself counts. They depend on the link's
// stable key alone, and more of them extend the same sequence.
#include <array>

#include "hierarchy/patch.hpp"
#include "paper/space_change.hpp"
#include "tracing/ray.hpp"

namespace deltalux::paper {

/// A four-dimensional sequence shifted by the key: stratified for any prefix (additive recurrence with the powers of
/// the generalised golden ratio [Roberts18]).
class Stratified4 {
 public:
  explicit Stratified4(std::uint64_t key);
  /// Sample i, from 0.
  std::array<double, 4> operator[](int i) const;

 private:
  std::array<double, 4> start_;
};

/// Points of an element by two numbers in [0,1), uniform by area; clusters pick surfaces by area. What all have in
/// common is looked up once.
class ElementPoints {
 public:
  /// Elements and scene must outlive this.
  ElementPoints(const hierarchy::Elements&, const Scene&, hierarchy::ElementId);

  hierarchy::PatchPoint at(double a, double b) const {
    if (!frame_) return onAny(a, b);
    const double u = domain_->u0 + a * du_, v = domain_->v0 + b * dv_;
    return {Vec3f(frame_->at({u, v})), normal_};
  }

 private:
  hierarchy::PatchPoint onAny(double a, double b) const;

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  hierarchy::ElementId element_;
  const hierarchy::PatchDomain* domain_;
  const hierarchy::PlaneFrame* frame_ = nullptr;  // of a flat patch that fills its rectangle
  double du_ = 0, dv_ = 0;
  Vec3f normal_{0.0f};
};

struct LinkSample {
  tracing::Ray ray;
  double weight = 0;         // not above 0: the points do not face each other, and the ray is none
  std::size_t quadrant = 0;  // of the receiver
};

class LinkSamples {
 public:
  /// Elements and scene must outlive this.
  LinkSamples(const hierarchy::Elements&, const Scene&, hierarchy::ElementId receiver, hierarchy::ElementId sender);

  LinkSample operator[](int i) const { return at(sequence_[i]); }
  /// Which of the first `count` rays may fare otherwise after a move, by bits: one that passed, as those of `passed`
  /// tell, where it meets what moves where it is or will be (`all`); one that did not, where it is (`before`): nothing
  /// that comes lets it pass.
  std::uint32_t meeting(int count, std::uint32_t passed, const SpaceChange& all, const SpaceChange& before) const;

 private:
  LinkSample at(const std::array<double, 4>& u) const;
  bool mayMeet(std::array<double, 4> u, const SpaceChange&) const;

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  hierarchy::ElementId receiver_, sender_;
  Stratified4 sequence_;
  ElementPoints from_, to_;
};

}  // namespace deltalux::paper
