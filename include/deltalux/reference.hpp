#pragma once
// The trusted answer: unbiased light transport by path tracing, with standard errors. Slow by design; the solver is
// judged by it. How it samples, and what remains slow, is said in src/render/reference/.
#include <cstdint>
#include <deltalux/image.hpp>
#include <deltalux/probe.hpp>
#include <deltalux/progress.hpp>
#include <deltalux/scene.hpp>
#include <memory>
#include <span>
#include <vector>

namespace deltalux {

struct ReferenceSettings {
  std::uint64_t samples = 1024;  // paths per point or pixel; 0: until `seconds` have passed
  double seconds = 0;            // time limit; 0: none
  bool diffuseOnly = false;      // drop specular lobes and mirrors, keep thin glass straight-through
  std::uint64_t seed = 1;
  int maxDepth = 0;        // bounces after which a path ends in any case; 0: Russian roulette alone ends it (unbiased)
  double targetError = 0;  // relative standard error at which a point stops; 0: never
};

struct ReferenceStats {
  std::uint64_t rays = 0, paths = 0;
  double seconds = 0;
};

/// Results depend on scene, settings and seed alone, not on the number of threads (unless `seconds` ends them).
class ReferenceIntegrator {
 public:
  ReferenceIntegrator(const Scene&, ReferenceSettings);
  ~ReferenceIntegrator();
  ReferenceIntegrator(const ReferenceIntegrator&) = delete;
  ReferenceIntegrator& operator=(const ReferenceIntegrator&) = delete;

  /// Irradiance at every point, in their order. Throws Interrupted when `progress` asks to stop.
  std::vector<ProbeResult> probe(std::span<const ProbePoint>, Progress* progress = nullptr);
  /// Radiance seen through the view [W/(sr m2)]. Throws Interrupted when `progress` asks to stop.
  Image render(const View&, int width, int height, Progress* progress = nullptr);
  /// Work done so far by this integrator.
  ReferenceStats stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace deltalux
