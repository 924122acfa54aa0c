#pragma once
// Irradiance of suns and lamps at points: what each would bring unshadowed, in closed form where one is known, times
// the share of it that shadow rays find open. Without shadows the light is therefore exact.
//
// Rays have the same numbers at every point: what few of them are off by varies as smoothly as the light, and is no
// grain. Every lamp that may shine on the point has some; one that some of them see and others do not has many more.
// Cost: a ray a lamp that is faint there, some twenty a bright one, some hundreds one in whose penumbra the point is.
#include "direct/lamps.hpp"
#include "hierarchy/patch.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::direct {

class LampMeter {
 public:
  /// At these scales of lights; skies are left out. Scene and tracer must outlive this.
  LampMeter(const Scene&, const tracing::RayTracer&, const std::vector<Rgb>& scales);

  bool dark() const { return lamps_.all().empty(); }
  struct Reading {
    Rgb E{0.0f};      // [W/m2]
    double open = 0;  // about what all would bring unshadowed [W/m2, gray]
  };
  /// How many rays have to agree on a lamp for no more to be asked: few where all around is known to be lit alike.
  enum class Doubt { Much, Little };
  /// `ambient`: other light there [W/m2, gray]. `error`: about what may be wrong, relative to all of it.
  Reading read(const Vec3& position, const Vec3& normal, float ambient, double error, Doubt = Doubt::Much) const;

 private:
  struct Reaching {
    const Lamp* lamp;
    double potential;
  };
  std::vector<Reaching> reaching(const Vec3& position, const Vec3& normal) const;
  Rgb of(const Reaching&, const hierarchy::PatchPoint&, double allowed, Doubt) const;

  Lamps lamps_;
  const tracing::RayTracer& tracer_;
};

}  // namespace deltalux::direct
