#pragma once
// The region over which a leaf patch takes part in reconstruction: its parameter rectangle, widened by three quarters
// of its size on every side, with a smooth weight that falls from 1 at its centre to 0 at the rim. It moves with the
// patch alone, so a blend of patches is continuous whatever the mesh.
//
// Flat patches measure in the affine frame of their plane. Curved ones measure in their primitive's parameters, around
// the axis by arc length at the height of the point, which closes the seam and brings all patches together at a pole.
// Patches of many faces measure in space, from their centre.
#include "base/box_tree.hpp"
#include "hierarchy/element.hpp"
#include "render/tuning.hpp"

namespace deltalux::rendering {

/// A surface point as supports see it. `radius` is that of the primitive's circle through the point, up to a factor
/// per primitive (curved ones; see relativeRadius).
struct SupportPoint {
  Vec3f position;
  glm::vec2 uv{0.0f};
  float radius = 1.0f;
};

/// Radius of the circle at parameter v of a shape of revolution, up to a factor; 1 for flat shapes.
float relativeRadius(const Shape&, double v);

class PatchSupport {
 public:
  PatchSupport() = default;
  PatchSupport(const hierarchy::Elements&, const Scene&, hierarchy::ElementId leaf);

  bool flat() const { return kind_ == Kind::Flat; }
  bool round() const { return kind_ == Kind::Round; }
  /// In [0,1]; 0 outside.
  float weight(const SupportPoint& p) const {
    if (kind_ == Kind::Faces) return falloff(glm::length(p.position - origin_) * dualU_.x);
    const glm::vec2 t = coordinates(p);
    return falloff(t.x) * falloff(t.y);
  }
  /// Whether a point of `leaf` may have a weight (never missed; may be said of a few that have none).
  bool reaches(const hierarchy::Elements&, const Scene&, hierarchy::ElementId leaf) const;
  /// Bounds of all points with a weight.
  BoxF bounds(const hierarchy::Elements&, hierarchy::ElementId leaf) const;

  bool operator==(const PatchSupport&) const = default;

 private:
  enum class Kind : char { Flat, Round, Faces };
  static constexpr float kReach = tuning::kReach;
  static constexpr float kFacesSize = 0.70710678f;  // half size of many faces, in radii: that of a square [defined]

  static float falloff(float t) {
    const float s = 1.0f - t * t * (1.0f / (kReach * kReach));
    return s > 0.0f ? s * s : 0.0f;
  }
  /// In half sizes from the centre of the patch's rectangle.
  glm::vec2 coordinates(const SupportPoint& p) const {
    if (flat()) {
      const Vec3f d = p.position - origin_;
      return {glm::dot(d, dualU_), glm::dot(d, dualV_)};
    }
    const float du = p.uv.x - origin_.x;
    return {(du - std::floor(du + 0.5f)) * p.radius * dualU_.x, (p.uv.y - origin_.y) * dualV_.x};
  }

  Vec3f origin_{0.0f};  // centre: in space, or (u, v, 0) for curved patches
  // Curved: x is what one unit of arc, of v, measures in half sizes; many faces: one unit of length in space.
  Vec3f dualU_{0.0f}, dualV_{0.0f};
  Kind kind_ = Kind::Flat;
};

}  // namespace deltalux::rendering
