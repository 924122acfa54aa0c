#pragma once
// The ways in which a surface point can be joined with a light without luck: straight, by one bounce off a plane mirror
// (the light's virtual image), or by one bounce off a curved mirror (curved_mirror.hpp). Panes in between are passed.
//
// Which ways there are is found once: straight to every light, and mirror by mirror to every light except skies, kept
// when test rays find flux on the mirror, brightest first. What is left out is found by scattering alone, and the
// weights of multiple importance sampling know it, so nothing is lost or counted twice.
#include <unordered_map>
#include <vector>

#include "render/reference/reference_scene.hpp"

namespace deltalux {

struct Connection {
  enum class Kind : unsigned char { Straight, Plane, Curved };
  Kind kind = Kind::Straight;
  LightId light;
  PrimitiveId mirror;  // of Plane and Curved
  double flux = 0;     // estimate of the light that the mirror throws back, gray [W]
};

/// Light that a connection brings to a point, before shadows.
struct Arrival {
  Vec3 direction;         // unit, where it comes from at the point
  Rgb value{0.0f};        // radiance over density; of point-like lights their irradiance at normal incidence
  double pdf = 0;         // of this direction, per solid angle at the point [1/sr]; 0: point-like
  Ray first, second;      // to be tested for shadows; `second` when `rays` is 2
  int rays = 1;
};

struct Arrivals {
  std::array<Arrival, 4> list;
  int count = 0;
};

/// Where a path that scattered at `from` has met a light, possibly over one mirror.
struct LightMeeting {
  Vec3 from;               // the point that a connection would start from
  Vec3 direction;          // of the path's last segment, towards the light
  double distance = 0;     // along the path from `from`; infinite for suns and skies
  Vec3 normal{0};          // of the light where it is met
  Vec3 mirrorPoint{0};     // of a mirror connection
};

class LightConnections {
 public:
  explicit LightConnections(const ReferenceScene&);

  const std::vector<Connection>& list() const { return list_; }
  /// Index of a connection; -1 when there is none such.
  int straight(LightId) const;
  int mirrored(PrimitiveId mirror, LightId) const;

  /// Light brought to `position` (surface normal `normal`, zero in free space) by two numbers in [0,1).
  Arrivals sample(int connection, const Vec3& position, const Vec3& normal, const Vec2& u) const;
  /// Density with which sample() finds that meeting, per solid angle at `from` [1/sr].
  double pdf(int connection, const LightMeeting&) const;

 private:
  void addMirrors();
  double mirroredFlux(PrimitiveId mirror, LightId, int samples) const;
  void sampleStraight(const Connection&, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals&) const;
  void samplePlane(const Connection&, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals&) const;
  void sampleCurved(const Connection&, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals&) const;

  const ReferenceScene& scene_;
  std::vector<Connection> list_;
  std::vector<int> straight_;
  std::unordered_map<std::uint64_t, int> mirrored_;
};

}  // namespace deltalux
