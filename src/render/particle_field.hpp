#pragma once
// Irradiance of particles at any point: the flux of the impacts around it on the same surface side, over the area that
// they fell on.
//
// The disc around the point is cut into sectors, and each reaches as far as its light agrees with that at the point
// within their noise: all round where light is even, and only to one side at the edge of a caustic (intersection of
// confidence intervals [GN97], by directions [Foi07]). What is known at the point comes from discs that grow from less
// than an impact on; an empty one tells, too: it must be as large as it is by chance. No threshold is set in lengths.
// Area is what of the disc is surface in sight of the point: edges and corners do not darken, and what stands on a
// surface, or is behind a wall on it, is left out of account.
// Cost: a kd-tree over the impacts; a query takes some 10 microseconds.
#include "base/usual_error.hpp"
#include "particles/particles.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

struct Solution;

}  // namespace deltalux

namespace deltalux::rendering {

/// Particles that light at a point is estimated from, at most: as many as have the usual error.
inline constexpr auto kMostParticles = static_cast<std::size_t>(kSamplesOfUsualError + 0.5);  // [defined]

class ParticleField {
 public:
  /// Reads today's fluxes. The solution must outlive this.
  explicit ParticleField(const Solution&);

  /// At a point of a surface; `normal` is the unit normal of the side [W/m2].
  Rgb at(PrimitiveId, bool front, const Vec3& position, const Vec3& normal) const;

 private:
  struct Deposit {
    Vec3f position;
    std::uint32_t axis = 0;  // that its node of the tree divides
    Rgb flux;
  };
  /// A deposit near the query point.
  struct Neighbour {
    float squared;
    std::uint32_t deposit;
  };
  struct Query {
    PrimitiveId primitive;
    Vec3 position, normal;
    std::vector<Neighbour> found;  // ascending by distance
    double radius = 0;             // of the widest disc
  };
  /// Points of the unit disc, and which of them around the query are surface in sight.
  struct Surroundings {
    std::vector<char> open;  // by disc point
    bool blocked = false;    // something stands on the surface: neighbours must be in sight, too
  };

  void sortTree(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t begin, std::uint32_t end, Query&) const;
  Surroundings lookAround(const Query&) const;
  bool inSight(const Query&, const Vec3& q) const;
  struct Rings;
  Rings ringsOf(const Query&, const Surroundings&) const;
  Rgb estimate(Query&, const Surroundings&) const;

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  std::vector<std::uint32_t> begin_;  // per primitive and side, one more
  std::vector<Deposit> deposits_;     // implicit kd-trees
};

}  // namespace deltalux::rendering
