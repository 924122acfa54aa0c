#pragma once
// Measures irradiance at points of surfaces and in free space: direct light by shadow rays, indirect light by lines,
// until their error is small, particles from their textures or impacts; in free space by paths that read what they see.
#include <deltalux/render.hpp>
#include <memory>
#include <mutex>

#include "render/eye_path.hpp"
#include "render/line_gather.hpp"
#include "render/particle_field.hpp"
#include "render/space_meter.hpp"

namespace deltalux::rendering {

/// A point of a surface side.
struct SurfaceSpot {
  PrimitiveId primitive;
  std::uint32_t triangle = 0;
  bool front = true;
  Vec3 position, normal;
};

class LightMeter {
 public:
  /// Both must outlive this.
  LightMeter(const Solution&, const Reconstruction&);

  /// Makes what is needed for these points, if it is not there yet: not while other threads measure.
  void prepare(std::span<const ProbePoint>) const;
  /// `key` names the random numbers.
  ProbeResult measure(const ProbePoint&, const ProbeSettings&, std::uint64_t key) const;
  /// The nearest surface that faces the point's normal, where the point lies on one.
  std::optional<SurfaceSpot> surfaceAt(const ProbePoint&) const;
  const LineGather& lines() const { return lines_; }
  /// What particles bring there [W/m2].
  Rgb particleLight(const SurfaceSpot&) const;

 private:
  double reachAt(const Vec3&) const;
  ProbeResult onSurface(const SurfaceSpot&, const ProbeSettings&, std::uint64_t key) const;
  ProbeResult directAt(const direct::Receiver&, std::optional<hierarchy::ElementId> leaf, const Rgb& ambient,
                       double error, const ProbeSettings&, std::uint64_t key) const;
  /// Made when first asked for.
  const ParticleField& particles() const;

  const Solution& solution_;
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const Reconstruction& reconstruction_;
  EyePaths paths_;
  LineGather lines_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const ParticleField> particles_;
  mutable std::unique_ptr<const SpaceMeter> space_;  // by prepare()
};

/// As deltalux::probe().
std::vector<ProbeResult> measureAll(const LightMeter&, std::span<const ProbePoint>, const ProbeSettings&, Progress*);

}  // namespace deltalux::rendering
