#pragma once
// The ways in which a surface point can be joined with a light without luck: straight, or by way of up to two bends:
// plane mirrors (virtual images) and one curved one, a mirror (curved_mirror.hpp) or a refracting ball
// (refracting_ball.hpp). Panes in between are passed.
//
// Which ways there are is found once: straight to every light, and by way of bends to every light except skies, kept
// when test rays find flux there, brightest first. What is left out, and any way that the solvers miss, is found by
// scattering alone, and the weights of multiple importance sampling know it, so nothing is lost or counted twice.
#include <array>
#include <unordered_map>
#include <vector>

#include "render/reference/curved_mirror.hpp"
#include "render/reference/plane.hpp"
#include "render/reference/reference_scene.hpp"

namespace deltalux::rendering {

/// Inner reflections of a ball that are connected through: of the primary and the secondary rainbow.
inline constexpr int kMostInner = 2;  // [defined]

/// A surface that turns light in one known way.
struct Bend {
  enum class Kind : unsigned char { Plane, Curved, Ball };
  Kind kind = Kind::Plane;
  PrimitiveId surface;
  int inner = 0;  // reflections inside a ball
  friend bool operator==(const Bend&, const Bend&) = default;
};

/// Up to two bends, in the order met from the surface point.
struct BendChain {
  std::array<Bend, 2> bends;
  int count = 0;

  bool add(const Bend& bend) {
    if (count == 2) return false;
    bends[count++] = bend;
    return true;
  }
  /// Index of the bend that is not a plane mirror; -1 when all are.
  int curved() const;
};

struct Connection {
  LightId light;
  BendChain chain;
  double flux = 0;  // estimate of what leaves the bend nearest to the surface point, gray [W]
};

/// Light that a connection brings to a point, before shadows.
struct Arrival {
  Vec3 direction;                    // unit, where it comes from at the point
  Rgb value{0.0f};                   // radiance over density; of point-like lights their irradiance at normal incidence
  double pdf = 0;                    // of this direction, per solid angle at the point [1/sr]; 0: point-like
  std::array<tracing::Ray, 8> legs;  // to be tested for shadows
  int legCount = 0;
};

struct Arrivals {
  std::array<Arrival, 8> list;
  int count = 0;
};

/// Where a path that scattered at `from` has met a light, by way of a chain of bends.
struct LightMeeting {
  Vec3 from;            // the point that a connection would start from
  Vec3 direction;       // of the path's last leg, towards the light
  double distance = 0;  // along the path from `from`; infinite for suns and skies
  Vec3 normal{0};       // of the light where it is met
  Vec3 bendPoint{0};    // on the curved bend: the mirror point, or where the ball is entered
  Vec3 lightPoint{0};   // where the light is met, if not infinitely distant
};

class LightConnections {
 public:
  explicit LightConnections(const ReferenceScene&);

  const std::vector<Connection>& list() const { return list_; }
  /// Index of the connection to a light by way of a chain; -1 when there is none such.
  int find(LightId, const BendChain&) const;
  /// What kind of mirror a primitive's side is to connections; nullopt for none (meshes, inside of bodies).
  std::optional<Bend> mirror(PrimitiveId, bool front) const;
  /// The primitive as a refracting ball.
  std::optional<Bend> ball(PrimitiveId, int inner = 0) const;

  /// Light brought to `position` (surface normal `normal`, zero in free space) by two numbers in [0,1).
  Arrivals sample(int connection, const Vec3& position, const Vec3& normal, const Vec2& u) const;
  /// Density with which sample() finds that meeting, per solid angle at `from` [1/sr].
  double pdf(int connection, const LightMeeting&) const;

 private:
  /// A sampled place on a light; its density per area, per solid angle of a sun, 0 of a point.
  struct LightEnd {
    LightPlace place;
    Vec3 normal{0};
    double density = 0;
  };

  void add(const Connection&);
  std::vector<Bend> findBends() const;
  std::vector<Connection> withFlux(std::vector<Connection> candidates, int samples) const;
  double fluxLeaving(const Bend&, const Connection& before, int samples) const;
  Arrivals sample(const Connection&, const Vec3& x, const Vec3& n, const Vec2& u) const;
  void samplePlanes(const Connection&, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals&) const;
  void sampleCurved(const Connection&, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals&) const;
  LightEnd sampleEnd(LightId, const Vec2& u) const;
  bool shine(Arrival&, LightId, LightEnd&, const Vec3& onward, double distance, double spread) const;
  Plane plane(const Bend&) const;
  LightPlace mirrored(const LightPlace&, const Bend& flat) const;

  const ReferenceScene& scene_;
  std::vector<Connection> list_;
  std::unordered_multimap<std::uint64_t, int> index_;
};

}  // namespace deltalux::rendering
