#pragma once
// Which primitives have a group of their own in the ray tracer, so that moving them builds nothing but that: those that
// were selected, and what has moved before, but not of more than a few moves at a time, since every group is a step for
// every ray. Cost: of separating, the whole scene once; then that of what moves.
#include "tracing/ray_tracer.hpp"

namespace deltalux {

class MovingGroups {
 public:
  /// Puts primitives into a group of their own, unless they are one.
  void separate(RayTracer&, const Scene&, std::span<const PrimitiveId>);
  /// Takes in where these are now.
  void rebuild(RayTracer&, const Scene&, std::span<const PrimitiveId> moved);

 private:
  GroupId groupOf(PrimitiveId p) const { return p.index() < groups_.size() ? groups_[p.index()] : GroupId(0); }

  static constexpr int kMost = 16;

  void setApart(RayTracer&, const Scene&, std::span<const PrimitiveId>);

  std::vector<GroupId> groups_;  // by primitive
  int separated_ = 0;
};

}  // namespace deltalux
