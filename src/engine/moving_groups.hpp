#pragma once
// Which primitives have a group of their own in the ray tracer, so that moving them builds nothing but that: those that
// were selected, and what has moved before, but not of more than a few moves at a time, since every group is a step for
// every ray. Cost: of separating, the whole scene once; then that of what moves.
#include "tracing/ray_tracer.hpp"

namespace deltalux::engine {

class MovingGroups {
 public:
  /// Puts primitives into a group of their own, unless they are one.
  void separate(tracing::RayTracer&, const Scene&, std::span<const PrimitiveId>);
  /// Takes in where these are now.
  void rebuild(tracing::RayTracer&, const Scene&, std::span<const PrimitiveId> moved);

 private:
  tracing::GroupId groupOf(PrimitiveId p) const {
    return p.index() < groups_.size() ? groups_[p.index()] : tracing::GroupId(0);
  }

  void setApart(tracing::RayTracer&, const Scene&, std::span<const PrimitiveId>);

  std::vector<tracing::GroupId> groups_;  // by primitive
  int separated_ = 0;
};

}  // namespace deltalux::engine
