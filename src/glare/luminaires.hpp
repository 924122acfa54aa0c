#pragma once
// The lights of a scene as luminaires, and what an eye sees of them: luminance and solid angle by rays to their
// luminous areas. Suns and skies are none. Cost: some hundred rays a light and eye, some thousand
// where it is hidden in part.
#include <deltalux/glare.hpp>

#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::glare {

struct LuminaireLights {
  std::string name;
  std::vector<LightId> lights;
};

/// Lights of one object, or of objects that are parts of one, are together where they touch.
std::vector<LuminaireLights> luminairesOf(const Scene&);

/// Of lights, as they are seen from an eye.
struct SeenLight {
  double solidAngle = 0;   // of what is seen of it [sr]
  double normalLux = 0;    // sum of L omega: illuminance on a plane that faces it [lux]
  double illuminance = 0;  // on the eye [lux]
  double area = 0;         // of what is seen, across the line to the eye [m2]
  Vec3 middle{0};          // from the eye, weighted by L dA

  SeenLight& operator+=(const SeenLight&);
  SeenLight& operator/=(double);
};

class LuminaireMeter {
 public:
  /// Scene and tracer must outlive this.
  LuminaireMeter(const Scene&, const tracing::RayTracer&);

  std::vector<LuminaireSeen> seen(const Eye&) const;
  /// The discs of suns, as far as they are seen.
  std::vector<GlareSource> suns(const Eye&) const;
  const std::vector<LuminaireLights>& luminaires() const { return luminaires_; }

 private:
  SeenLight seen(LightId, const Eye&, const Vec3& ahead) const;
  SeenLight seenArea(LightId, const Eye&, const Vec3& ahead) const;
  SeenLight seenPoint(LightId, const Eye&, const Vec3& ahead) const;
  double distanceSquared(LightId pointLike, const Eye&) const;  // [m2]

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  scene::LightSampler sampler_;
  std::vector<LuminaireLights> luminaires_;
};

}  // namespace deltalux::glare
