#pragma once
// Irradiance of particles at any point: a kernel estimate over the impacts around it on the same surface side.
//
//   E(p) = sum of w_i K(|x_i - p| / r) / integral of K over what of the disc is surface in sight of p,  K = 1 - s^2
//
// The integral in the denominator keeps edges and corners from darkening, and leaves what stands on a surface, or is
// behind a wall on it, out of account. The radius is the largest whose estimate agrees with those of all smaller ones
// within their noise (intersection of confidence intervals [GN97]): wide where light is even, narrow at the edge of a
// caustic; no threshold is set in lengths.
// Cost: a kd-tree over the impacts; a query takes some 10 microseconds.
#include "particles/particles.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

struct Solution;

class ParticleField {
 public:
  /// Reads today's fluxes. The solution must outlive this.
  explicit ParticleField(const Solution&);

  /// At a point of a surface; `normal` is the unit normal of the side [W/m2].
  Rgb at(PrimitiveId, bool front, const Vec3& position, const Vec3& normal) const;

 private:
  struct Landing {
    Vec3f position;
    std::uint32_t axis = 0;  // that its node of the tree divides
    Rgb flux;
  };
  /// A landing near the query point.
  struct Neighbour {
    float squared;
    std::uint32_t landing;
  };
  struct Query {
    PrimitiveId primitive;
    Vec3 position, normal;
    std::vector<Neighbour> found;  // ascending by distance
    double radius = 0;             // of the widest kernel
  };
  /// Points of the unit disc, and how much of the kernel around the query is surface in sight.
  struct Surroundings {
    std::vector<char> open;  // by disc point
    bool blocked = false;    // something stands on the surface: neighbours must be in sight, too
  };

  void sortTree(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t begin, std::uint32_t end, Query&) const;
  Surroundings lookAround(const Query&) const;
  bool inSight(const Query&, const Vec3& q) const;
  Rgb estimate(Query&, const Surroundings&) const;

  const Scene& scene_;
  const RayTracer& tracer_;
  std::vector<std::uint32_t> begin_;  // per primitive and side, one more
  std::vector<Landing> landings_;     // implicit kd-trees
};

}  // namespace deltalux
