#pragma once
// A few short light paths from a side of an input-level surface: what irradiance it may have, how far its surroundings
// are, and whether light reaches it at all. Estimates of different sides may run in parallel; they depend on scene and
// side alone, but for what they tell of each other: a side that a ray from a lit point meets is lit. Of surfaces in one
// place that counts as reached which rays meet: light must not count twice.
//
// Lights that are switched off count, faintly: sides that they can reach will be lit by them one day.
// Cost: about 2^17 paths of up to four vertices for all sides together, and in large scenes 24 of every side (8 of a
// mesh's triangle): fewer, and sides that little light reaches are lost.
#include <atomic>
#include <mutex>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

class SideEstimator {
 public:
  /// Both must outlive this.
  SideEstimator(const Scene&, const RayTracer&);

  /// Those of surfaceSides(), by index.
  const std::vector<SurfaceSide>& sides() const { return sides_; }
  std::size_t indexOf(PrimitiveId, std::uint32_t triangle, bool front) const;
  std::size_t indexOf(const Hit& hit) const { return indexOf(hit.primitive, hit.triangle, hit.front); }

  /// Paths from the side's surface: light found at every vertex counts, so that a lit part of a floor does not light
  /// what sees only its dark part.
  void estimate(std::size_t side);
  /// What rays from the side meet first, panes aside.
  std::vector<Hit> firstMet(std::size_t side, std::size_t rays) const;

  /// Whether light reaches it, by the estimates so far; glass always has its elements.
  bool reached(std::size_t side) const;
  /// Whether a path of a side that light reaches has met it.
  bool met(std::size_t side) const { return met_[side]; }
  /// The side, with what is estimated of it.
  SurfaceSide estimated(std::size_t side) const;
  std::uint64_t rays() const;

 private:
  struct Estimate {
    Rgb E{0.0f};
    float typical = 0, meanFreePath = 0;
    std::uint64_t rays = 0;
  };
  struct Origin {
    Vec3 position, normal;
  };

  double diagonal() const;
  bool isGlass(std::size_t i) const { return !twoSided_[sides_[i].primitive.index()]; }
  bool isLit(std::size_t i) const { return !isBlack(estimates_[i].E) || lit_[i]; }
  bool hidden(const SurfaceSide&, const Origin&) const;
  bool hidden(const SurfaceSide&, std::size_t points) const;
  Origin pointOnSide(const SurfaceSide&, Vec2 u) const;
  Rgb wholeReflectance(const SurfaceSide&) const;
  Hit look(const Origin&, const Vec3f& w, Rgb& through, float& t) const;
  Rgb directAt(const Origin&, Rng&) const;
  Rgb fromLight(const Origin&, const Light&, Rng&) const;
  Rgb fromArea(const Vec3f& x, const Vec3f& n, PrimitiveId, const Rgb& scale, Rng&) const;

  const Scene& scene_;
  const RayTracer& tracer_;
  std::vector<SurfaceSide> sides_;
  std::vector<std::uint32_t> first_;
  std::vector<char> twoSided_;
  std::size_t rays_ = 0;  // paths of a side
  mutable std::once_flag measured_;
  mutable double diagonal_ = 0;  // once it is asked for
  std::vector<Estimate> estimates_;
  std::vector<std::atomic<char>> lit_, met_;  // by a ray from a lit point; by a path of a lit side
};

}  // namespace deltalux
