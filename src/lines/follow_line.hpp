#pragma once
// One line: from a point of a surface into a direction, through panes and over mirrors, gloss and glass, to the diffuse
// surface where it ends.
#include <vector>

#include "base/random.hpp"
#include "hierarchy/side_table.hpp"
#include "lines/surface_responses.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::lines {

enum class LineTermination : std::uint8_t {
  Ended,    // on a diffuse side
  Escaped,  // out of the scene
  Lost,     // absorbed, or at its last event
};

struct LineEnd {
  LineTermination termination = LineTermination::Lost;
  bool turned = false;                 // it has gone on over something else than straight passages
  bool rough = false;                  // some of that were rough lobes: the way back has another chance
  bool dimmed = false;                 // weight is not 1
  bool met = false;                    // the first surface, through clear air, could have ended it
  hierarchy::Side side;                // where it ended
  Vec3f position{0.0f}, normal{0.0f};  // the same; of the side
  float distance = std::numeric_limits<float>::infinity();  // to the first surface that it did not pass straight
  std::uint32_t straight = 0;                               // rays to there, where it turned
  /// Throughput over the chance of going this way, that of ending left out; of a line that escapes straight, `chance`
  /// is that of its passages.
  Rgb weight{1.0f};
  float chance = 1;
  /// Of light that is sent along: what mirrors, panes and bodies on its way absorb, and the last event cuts off, over
  /// the chance of coming there.
  Rgb absorbed{0.0f};
};

/// One ray of a line.
struct LineSegment {
  Vec3f from{0.0f}, direction{0.0f};  // unit
  float length = 0;                   // infinite where it left the scene
};

class LineTracer {
 public:
  /// All must outlive this.
  LineTracer(const Scene& scene, const tracing::RayTracer& tracer, const SurfaceResponses& responses)
      : scene_(scene), tracer_(tracer), responses_(responses) {}

  /// From surface point `p` with the unit normal of its side, into unit `direction`. `random` decides at branches.
  /// `way`, if any: its rays are added there.
  LineEnd follow(const Vec3f& p, const Vec3f& normal, const Vec3f& direction, Rng random,
                 std::vector<LineSegment>* way = nullptr) const {
    tracing::Ray ray;
    ray.origin = tracing::offsetOrigin(p, normal, direction), ray.direction = direction;
    return follow(ray, tracer_.closestHit(ray), random, way);
  }
  /// The same with the first hit known.
  LineEnd follow(tracing::Ray ray, tracing::Hit hit, Rng random, std::vector<LineSegment>* way = nullptr) const;

  const Scene& scene() const { return scene_; }
  const tracing::RayTracer& tracer() const { return tracer_; }
  const SurfaceResponses& responses() const { return responses_; }

 private:
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const SurfaceResponses& responses_;
};

}  // namespace deltalux::lines
