#include "particles/reached_sides.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numeric>

#include "base/check.hpp"
#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"
#include "particles/surface_normal.hpp"
#include "scene/stops_light.hpp"

namespace deltalux::particles {

namespace {

/// In the order of surfaceSides().
bool before(const hierarchy::SurfaceSide& a, const hierarchy::SurfaceSide& b) { return a.side() < b.side(); }

double areaOf(const Scene& scene, const hierarchy::SurfaceSide& s) {
  const Shape& shape = scene[s.primitive].shape;
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return area(shape);
  return mesh->cumulativeArea[s.triangle] - (s.triangle > 0 ? mesh->cumulativeArea[s.triangle - 1] : 0.0);
}

struct PlacedDeposits {
  RgbSum flux{0.0};
  std::vector<std::uint32_t> paths;  // some of them
};

/// PilotSamples round from points of surfaces for light.
class LampSight {
 public:
  LampSight(const Scene& scene, const tracing::RayTracer& tracer, const IsLit& lit)
      : scene_(scene), tracer_(tracer), lit_(lit) {}

  /// Whether anything is seen from here but sides that are dark. A lit side may be dark just there, in a hollow that it
  /// closes: so it must see light itself.
  bool sees(const Vec3f& p, const Vec3f& normal, Rng& rng, bool again = true) const {
    const Frame frame{Vec3(normal)};
    for (int k = 0; k < deltalux::tuning::kPilots; ++k) {
      const double u = rng.uniform();
      tracing::Ray ray;
      ray.direction = Vec3f(cosineDirection(frame, u, rng.uniform()));
      ray.origin = tracing::offsetOrigin(p, normal, ray.direction);
      const tracing::Hit hit = tracer_.closestHit(ray);
      if (!hit || !scene::stopsLight(scene_.materialOf(hit.primitive))) return true;
      if (!lit_(hit.primitive, hit.triangle, hit.front)) continue;
      if (!again || sees(hit.position, hit.front ? hit.normal : -hit.normal, rng, false)) return true;
    }
    return false;
  }

 private:
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const IsLit& lit_;
};

/// Whether a path starts at a light, or at a point that sees light.
bool startsInLight(const Particles& p, std::uint32_t path, const Scene& scene, const LampSight& sight) {
  const SenderCell& cell = p.senderCells[p.sender[path]];
  if (cell.kind != SenderKind::Side) return true;
  const Vec3f origin = p.verticesOf(path)[0];
  const Vec3 up = normalAt(scene[cell.primitive].shape, Vec3(origin), p.originTriangle[path]);
  Rng rng(path, 0x6c69u);
  return sight.sees(origin, Vec3f(cell.front ? up : -up), rng);
}

}  // namespace

void addReachedSides(std::vector<hierarchy::SurfaceSide>& sides, const Particles& particles, const Scene& scene,
                     const tracing::RayTracer& tracer) {
  std::vector<std::uint32_t> all(particles.paths());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<hierarchy::SurfaceSide> known = sides;
  addReachedSides(sides, particles, all, scene, tracer, [&](PrimitiveId primitive, std::uint32_t triangle, bool front) {
    const hierarchy::SurfaceSide s{primitive, triangle, front, 0, Rgb(0.0f), 0};
    return std::binary_search(known.begin(), known.end(), s, before);
  });
}

void addReachedSides(std::vector<hierarchy::SurfaceSide>& sides, const Particles& particles,
                     std::span<const std::uint32_t> paths, const Scene& scene, const tracing::RayTracer& tracer,
                     const IsLit& lit) {
  const LampSight sight(scene, tracer, lit);
  std::map<std::pair<PrimitiveId, std::uint32_t>, PlacedDeposits> deposited;  // by primitive, triangle and side
  for (const std::uint32_t path : paths) {
    const double power =
        double(particles.links[particles.link[path]].scale) * particles.nominal[particles.sender[path]];
    for (std::uint32_t i = particles.firstImpact(path); i < particles.endImpact(path); ++i) {
      PlacedDeposits& l = deposited[{particles.primitive[i], particles.triangleAndSide[i]}];
      l.flux += power * RgbSum(particles.throughput[i]);
      if (l.paths.size() < deltalux::tuning::kPilots) l.paths.push_back(path);
    }
  }
  std::vector<hierarchy::SurfaceSide> added;
  for (const auto& [where, l] : deposited) {
    hierarchy::SurfaceSide s{where.first, where.second >> 1, (where.second & 1) == 0, 0, Rgb(0.0f), 0};
    if (std::binary_search(sides.begin(), sides.end(), s, before)) continue;
    const auto starts = [&](std::uint32_t path) { return startsInLight(particles, path, scene, sight); };
    if (!lit(s.primitive, s.triangle, s.front) && std::none_of(l.paths.begin(), l.paths.end(), starts)) continue;
    const double A = areaOf(scene, s);
    s.irradiance = Rgb(l.flux / A);
    s.typicalIrradiance = gray(s.irradiance);
    s.meanFreePath = static_cast<float>(std::sqrt(A));
    added.push_back(s);
  }
  sides.insert(sides.end(), added.begin(), added.end());
  std::sort(sides.begin(), sides.end(), before);
}

void dropReachedSides(std::vector<hierarchy::SurfaceSide>& sides, const Particles& particles) {
  if (sides.empty()) return;
  DELTALUX_CHECK(std::is_sorted(sides.begin(), sides.end(), before), "in the order of surfaceSides()");
  const PrimitiveId last = sides.back().primitive;
  std::vector<char> asked(last.index() + 1, 0), reached(sides.size(), 0);
  for (const hierarchy::SurfaceSide& s : sides) asked[s.primitive.index()] = 1;
  parallelFor(particles.paths(), 4096, [&](std::size_t path) {
    for (std::uint32_t i = particles.firstImpact(path); i < particles.endImpact(path); ++i) {
      const PrimitiveId primitive = particles.primitive[i];
      if (primitive > last || !asked[primitive.index()]) continue;
      const std::uint32_t side = particles.triangleAndSide[i];
      const hierarchy::SurfaceSide deposited{primitive, side >> 1, (side & 1) == 0, 0, Rgb(0.0f), 0};
      const auto at = std::lower_bound(sides.begin(), sides.end(), deposited, before);
      if (at != sides.end() && !before(deposited, *at))
        std::atomic_ref(reached[static_cast<std::size_t>(at - sides.begin())]).store(1, std::memory_order_relaxed);
    }
  });
  std::vector<hierarchy::SurfaceSide> others;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (!reached[i]) others.push_back(sides[i]);
  sides = std::move(others);
}

}  // namespace deltalux::particles
