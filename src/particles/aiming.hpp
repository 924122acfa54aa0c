#pragma once
// Where a first segment goes from a point of a sender: towards the receivers below a node, by one of two strategies.
//
//   Target  a point is drawn on a receiver: on flat ones near the sender by solid angle [UFK13], on others by area; the
//           cells of a cluster by area and reflectance.
//   Open    a direction is drawn into the bounding sphere of the node, or any where the sphere is near.
//
// Near clusters and near curved receivers take either with even chances, weighted by the balance heuristic [Veach97
// 9.2.2]: the first is bad where receivers are close, the second where they fill little of what bounds them. Which
// strategies serve depends on the point and the node.
#include <cstdint>
#include <optional>

#include "particles/receivers.hpp"

namespace deltalux::particles {

/// A point of a sender.
struct SendingPoint {
  Vec3 position{0}, normal{0};
  bool lambertian = false;  // has a normal, and a cosine about it
};

struct Aim {
  enum class Kind : std::uint8_t { None, Target, Open };
  Kind kind = Kind::None;
  std::uint32_t cell = 0;          // Target
  double density = 0;              // per solid angle; 0: nothing else is set
  double balance = 1;              // Target: its share where the other strategy would have met it, too
  Vec3 direction, target, normal;  // the latter two of a Target
  double distance;                 // to the target
};

class Aiming {
 public:
  /// Both must outlive this.
  Aiming(const Scene& scene, const Receivers& receivers) : scene_(scene), receivers_(receivers) {}

  /// `Aim`: none as yet.
  void aim(const SendingPoint&, std::uint32_t node, double choice, const Vec2& u, Aim&) const;
  /// About the solid angle of a receiver that lies behind the surface of the point, whatever its own points.
  std::optional<double> behind(const SendingPoint&, std::uint32_t node) const;
  /// Density per solid angle by which aiming at a cell below the node draws this point of the cell.
  double densityAtCell(const Vec3& from, const RadixNode&, std::uint32_t cell, const Vec3& at,
                       const Vec3& normal) const;
  /// The far side of a ball that light does not pass straight through: known without a ray. `from`: of light that comes
  /// from a place.
  bool hidesItself(std::uint32_t cell, const Vec3& position, const Vec3& towardsLight, const Vec3* from) const;

 private:
  void aimAtCell(const Vec3& from, const RadixNode&, double choice, const Vec2& u, Aim&) const;
  void aimAtFlat(const Vec3& from, std::uint32_t cell, const Vec2& u, Aim&) const;
  void aimAtCurved(const Vec3& from, std::uint32_t cell, const Vec2& u, Aim&) const;
  void aimAround(const SendingPoint&, const BoundingSphere&, const Vec2& u, Aim&) const;
  /// Density per solid angle of a direction.
  double densityAround(const SendingPoint&, const BoundingSphere&, const Vec3& direction) const;

  const Scene& scene_;
  const Receivers& receivers_;
};

}  // namespace deltalux::particles
