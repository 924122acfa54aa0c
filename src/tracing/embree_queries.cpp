#include "tracing/embree_queries.hpp"

#include <algorithm>
#include <variant>

namespace deltalux::tracing {

ClosestQuery::ClosestQuery(const Ray& ray)
    : ray_(&ray), originSize_(std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)})) {
  rtcInitIntersectContext(this);
}

double ClosestQuery::refined() const {
  const double t = approximate_->meet(Vec3(ray_->origin), Vec3(ray_->direction), static_cast<float>(nearest_));
  return t >= ray_->tNear && t <= ray_->tFar ? t : nearest_;
}

bool ClosestQuery::take(double t, const PrimitiveId* id) {
  const auto rounded = static_cast<float>(t);
  if (!(rounded >= ray_->tNear && rounded <= ray_->tFar)) return false;
  if (approximate_ && t + doubt(rounded) > nearest_) nearest_ = refined(), approximate_ = nullptr;
  const auto best = static_cast<float>(nearest_);
  if (rounded > best) return false;
  if (rounded == best && holder_ && (*holder_ < *id || (*holder_ == *id && holder_ < id))) return false;
  nearest_ = t, holder_ = id, approximate_ = nullptr;
  return true;
}

bool PassageQuery::isRepeat(const Crossed& crossed) const {
  // A flat pane is crossed once; others are met twice at one place only on an edge between two of their triangles.
  const bool flat = std::holds_alternative<Polygon>(scene[crossed.pane].shape);
  const auto same = [&](const Crossed& other) {
    return other.pane == crossed.pane && (flat || std::abs(other.t - crossed.t) <= 4e-6f * std::abs(crossed.t));
  };
  const auto end = few_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kFew));
  return std::any_of(few_.begin(), end, same) || std::any_of(more_.begin(), more_.end(), same);
}

bool PassageQuery::cross(PrimitiveId pane, float t, double cosIncidence) {
  const Crossed crossed{pane, t};
  if (isRepeat(crossed)) return true;
  if (count_ < kFew)
    few_[count_] = crossed;
  else
    more_.push_back(crossed);
  ++count_;
  passed *= straightTransmittance(scene.materialOf(pane), std::clamp(cosIncidence, 1e-6, 1.0));
  return !isBlack(passed);
}

}  // namespace deltalux::tracing
