#pragma once
// Light seen from a point: a direction towards every kind of emitter, its density, and the radiance that arrives.
//
// Polygons by solid angle (Arvo) where they are large to the eye, else by area; spheres by the cone of visible
// directions, from inside by all directions; cylinders, cones, rings and meshes by area; suns by their disc; skies by
// an importance table; point-like lights have one direction and no density. Shadows are the caller's.
//
// A spotlight of area A shines only within its cone, and its radiance depends on the distance d to what it lights
// first, L (d / (d + |direction|))^2, so that E = L A cos cos' / (d + |direction|)^2. [Radiance, spotlight]
#include <deltalux/scene.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/light_sampling_dome.hpp"

namespace deltalux::scene {

struct LightSample {
  Vec3 direction;       // unit, from the point to the light
  double distance = 0;  // infinite for suns and skies
  Vec3 normal{0};       // unit, of the emitting side; zero for points and at infinity
  Rgb radiance{0.0f};   // that arrives unshadowed [W/(sr m2)]; of point-like lights I / d^2 [W/m2]
  double pdf = 0;       // per solid angle [1/sr]; 0: point-like, the only direction
};

/// Radiance that an emitting material sends along unit `direction` to a surface at `distance`; `front`: from its front
/// side. A light's scale comes on top.
Rgb emittedRadiance(const Emission&, const Vec3& direction, double distance, bool front);
/// The same of a material whose emission is seen only; 0 of all others.
Rgb seenRadiance(const Material&, const Vec3& direction, double distance, bool front);

class LightSampler {
 public:
  /// Prepares every light of the scene, which must outlive this. Lights whose primitive does not emit are dark.
  /// `scales`, one a light, stand for those that the lights have at present.
  explicit LightSampler(const Scene&, std::vector<Rgb> scales = {});
  ~LightSampler();
  LightSampler(const LightSampler&) = delete;
  LightSampler& operator=(const LightSampler&) = delete;

  std::size_t size() const { return prepared_.size(); }
  /// The light that a primitive is, if it emits.
  LightId lightOf(PrimitiveId p) const { return lightOf_[p.index()]; }
  /// Suns and skies: where a ray that leaves the scene may still find light.
  std::span<const LightId> atInfinity() const { return atInfinity_; }
  /// Point-like lights are reached by sample() alone, never by a ray.
  bool isPointLike(LightId) const;
  /// Where a point-like light is, and its intensity into unit `direction` [W/sr].
  Vec3 position(LightId) const;
  Rgb intensity(LightId, const Vec3& direction) const;

  /// A direction from `from` to the light by two numbers in [0,1); nullopt when that sample does not shine on it.
  std::optional<LightSample> sample(LightId, const Vec3& from, const Vec2& u) const;
  /// Density of sample() from `from` for the direction that meets the light at `distance`, on the side with `normal`
  /// (both ignored for lights at infinity) [1/sr].
  double pdf(LightId, const Vec3& from, const Vec3& direction, double distance, const Vec3& normal) const;

  /// Unshadowed irradiance at a point with such a unit normal, where a closed form is known: of polygons and of spheres
  /// seen from outside and wholly above the horizon, which shine alike into all directions. [W/m2]
  std::optional<Rgb> irradiance(LightId, const Vec3& at, const Vec3& normal) const;

  /// A point uniform by area on an area light; its density is 1 / area().
  SurfacePoint samplePoint(LightId, const Vec2& u) const;
  /// Area of an area light's one side [unit^2]; 0 for all other lights.
  double area(LightId) const;

  /// Radiance that an area light sends along unit `direction` to a surface at `distance`; `front`: from its front side.
  Rgb emittedRadiance(LightId, const Vec3& direction, double distance, bool front) const;
  /// Radiance that a sun or sky sends from `towards`.
  Rgb radianceFrom(LightId, const Vec3& towards) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };
  /// What area sampling needs besides the shape itself: triangles of polygons and meshes with summed areas.
  struct AreaData {
    PrimitiveId primitive;
    std::vector<Triangle> triangles;
    std::vector<double> cumulative;
    double area = 0;
    /// Of one that shines within a cone only: a ball about it, the cone's axis, and cosine and sine of its half angle.
    struct Beam {
      Vec3 center, axis;
      double radius, cosine, sine;
    };
    std::optional<Beam> beam = {};

    /// Whether none of it shines on a point: that is further from the cone about the ball's centre than its radius.
    bool shinesPast(const Vec3& p) const;
  };
  class LazyDome;
  struct Prepared {
    std::optional<AreaData> area;
    std::unique_ptr<LazyDome> dome;
  };

  Rgb scaleOf(LightId id) const { return scales_.empty() ? scene_[id].scale : scales_[id.index()]; }
  AreaData prepareArea(PrimitiveId) const;
  bool bySolidAngle(const AreaData&, const Vec3& from, double& solidAngle) const;
  std::optional<LightSample> samplePointLike(LightId, const Vec3& from) const;
  std::optional<LightSample> sampleArea(LightId, const AreaData&, const Vec3& from, const Vec2& u) const;
  std::optional<LightSample> finishArea(LightId, const AreaData&, const Vec3& from, const Vec3& point,
                                        const Vec3& normal, double solidAngle) const;

  const Scene& scene_;
  std::vector<Rgb> scales_;
  std::vector<Prepared> prepared_;
  std::vector<LightId> lightOf_;
  std::vector<LightId> atInfinity_;
};

}  // namespace deltalux::scene
