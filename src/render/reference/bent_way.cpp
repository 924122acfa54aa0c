#include "render/reference/bent_way.hpp"

#include <cmath>

namespace deltalux::rendering {

void BentWay::leg(const Vec3& to, const Vec3& toNormal) {
  const Vec3 d = to - at_;
  const double distance = glm::length(d);
  lastLeg(distance > 0.0 ? d / distance : Vec3(0, 0, 1), distance, toNormal);
  at_ = to, normal_ = toNormal;
}

void BentWay::lastLeg(const Vec3& direction, double distance, const Vec3& toNormal) {
  if (count_ == 0) first_ = direction;
  if (count_ < static_cast<int>(legs_.size()))
    legs_[count_++] = tracing::shadowRay(at_, normal_, direction, distance, toNormal);
}

bool BentWay::mirrorAt(PrimitiveId flat, const Vec3& corner, double cosine) {
  const Plane plane = *planeOf(scene_.scene()[flat].shape);
  const bool front = plane.height(at_) > 0.0;
  if (!scene_.isConnectableMirror(flat, front)) return false;
  attenuation_ *= scene::mirrorReflectance(scene_.bsdf(flat, front), std::abs(cosine));
  if (isBlack(attenuation_)) return false;
  leg(corner, plane.normal);
  return true;
}

bool BentWay::mirrorOn(PrimitiveId flat, const Vec3& start, const Vec3& direction, double reach, double& t) {
  const Shape& shape = scene_.scene()[flat].shape;
  const Plane plane = *planeOf(shape);
  const double slope = glm::dot(direction, plane.normal);
  t = -plane.height(start) / slope;
  if (!(t > 0.0) || !(t < reach)) return false;
  const Vec3 corner = start + t * direction;
  return contains(shape, corner) && mirrorAt(flat, corner, slope);
}

void BentWay::finish(Arrival& arrival) const {
  arrival.direction = first_;
  arrival.legs = legs_;
  arrival.legCount = count_;
}

}  // namespace deltalux::rendering
