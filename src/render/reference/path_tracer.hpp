#pragma once
// Unbiased light transport along one path: what a surface point scatters towards a direction, and what a ray sees.
//
// Path tracing with connections to lights and multiple importance sampling (power heuristic) [Veach97]. At
// every surface with a finite part a connection is drawn from the table of its grid cell (at a light meter two, with
// stratified choices): straight to a light, or by way of up
// to two bends: plane mirrors (virtual images), and one curved mirror or refracting ball (all ways solved for). The
// same paths found by scattering are weighted against exactly the strategy that also makes them, so these caustics of
// suns, points and lamps converge like direct light. Panes are passed straight on the way. Russian roulette after some
// bounces keeps the throughput per channel: no colour is averaged away.
//
// Geometric normals throughout, so that energy is conserved; vertex normals of meshes are for the display.
//
// What remains slow, though unbiased: suns and small lamps by way of two curved bends or more than two of any kind, of
// meshes, or of refracting bodies other than balls; these are found by scattering alone (rare bright samples).
// Point-like lights by such ways cannot be found at all: the only light that is missing. Rough lobes are met by
// scattering; light that they throw onto a point is found by paths that happen to meet the lobe's surface and connect
// there.
//
// Cost per bounce: one closest hit, one shadow ray (one more per bend).
#include <functional>

#include "render/reference/connection_table.hpp"
#include "render/reference/path_sampler.hpp"

namespace deltalux::rendering {

/// A point where light scatters: its side towards `wo`, and what it does there.
struct PathVertex {
  Vec3 position;
  Vec3 normal;  // unit, on the side of wo
  Vec3 wo;      // unit, back along the path
  const scene::Bsdf* bsdf = nullptr;
  const Dielectric* medium = nullptr;  // that the vertex is in
};

/// Radiance that the diffuse parts of a surface send back from where it was hit [W/(sr m2)].
using KnownRadiance = std::function<Rgb(const tracing::Hit&)>;

class PathTracer {
 public:
  /// `maxDepth`: scatterings after which a path ends in any case; 0: none. `known`: paths take what diffuse surfaces
  /// send from there, and go on over what is not diffuse alone.
  PathTracer(const ReferenceScene&, const LightConnections&, const ConnectionTable&, int maxDepth,
             KnownRadiance known = {});

  /// Irradiance at a point [W/m2], one path's estimate.
  RgbSum irradiance(const Vec3& position, const Vec3& normal, PathSampler&, std::uint64_t& rays) const;
  /// Radiance that comes back along a ray [W/(sr m2)], one path's estimate.
  RgbSum radiance(const Vec3& origin, const Vec3& direction, PathSampler&, std::uint64_t& rays) const;

 private:
  /// Where the path last scattered by a finite density, and over what it has gone since.
  struct Anchor {
    enum class Since : unsigned char { Camera, Connectable, InBall, Unconnectable };
    Vec3 position{0}, normal{0};
    int connections = 1;  // that were drawn there
    double pdf = 0;
    Since since = Since::Camera;
    BendChain chain;
    Vec3 bendPoint{0};       // on the chain's curved bend
    double distance = 0;     // from the anchor along the path
    double fromSurface = 0;  // from the last surface that was not a pane
  };
  struct Walk {
    Vec3 origin, direction, offsetNormal;
    Rgb throughput{1.0f};
    const Dielectric* medium = nullptr;
    Anchor anchor;
    int depth = 0;
  };

  RgbSum follow(Walk walk, PathSampler&, std::uint64_t& rays) const;
  /// Light that `count` connections bring to a vertex and on towards wo.
  Rgb connect(const PathVertex&, int count, PathSampler&, std::uint64_t& rays) const;
  Rgb arriving(const PathVertex&, const ConnectionTable::Choice&, int count, const Vec2& u, std::uint64_t& rays) const;
  bool scatter(Walk&, const PathVertex&, PrimitiveId, bool front, PathSampler&) const;
  void follow(Anchor&, const PathVertex&, const scene::BsdfSample&, PrimitiveId, bool front) const;
  double meetingWeight(const Walk&, LightId, const Vec3& normal, const Vec3& point, double distance) const;
  RgbSum lightAtInfinity(const Walk&) const;
  Rgb lightOf(const Walk&, PrimitiveId, const tracing::Hit&) const;

  const ReferenceScene& scene_;
  const LightConnections& connections_;
  const ConnectionTable& table_;
  int maxDepth_;
  KnownRadiance known_;
};

}  // namespace deltalux::rendering
