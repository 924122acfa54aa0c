#pragma once
#include "tracing/shadow_ray.hpp"
// A way from a point to a light over known corners, as it is put together: its legs for shadow rays, its attenuation.
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>

#include "render/reference/light_connections.hpp"

namespace deltalux::rendering {

class BentWay {
 public:
  BentWay(const ReferenceScene& scene, const Vec3& x, const Vec3& n) : scene_(scene), at_(x), normal_(n) {}

  /// Goes straight on to a corner.
  void leg(const Vec3& to, const Vec3& toNormal);
  /// Goes straight on to the light, which may be infinitely far along `direction`.
  void lastLeg(const Vec3& direction, double distance, const Vec3& toNormal);
  /// Goes on to `corner` of a plane mirror and reflects there; false when that side does not reflect.
  bool mirrorAt(PrimitiveId flat, const Vec3& corner, double cosine);
  /// The same where the line from `start` along `direction` meets the mirror, at distance `t` below `reach`. `start`
  /// may be the image of the present place. False when it misses.
  bool mirrorOn(PrimitiveId flat, const Vec3& start, const Vec3& direction, double reach, double& t);
  void attenuate(const Rgb& factor) { attenuation_ *= factor; }

  const Rgb& attenuation() const { return attenuation_; }
  /// Direction of the first leg, and the legs, for the arrival.
  void finish(Arrival&) const;

 private:
  const ReferenceScene& scene_;
  Vec3 at_, normal_;
  Vec3 first_{0};
  Rgb attenuation_{1.0f};
  std::array<tracing::Ray, 8> legs_;
  int count_ = 0;
};

}  // namespace deltalux::rendering
