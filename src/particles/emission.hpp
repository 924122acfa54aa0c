#pragma once
// The first segment of particles: from a point of a sender towards the receivers below a node, with the flux that the
// sample stands for. The expected flux is exact whatever the two ends are:
//
//   Target  goes to a point of a receiver; it must be free but for thin glass. Suns and skies always.
//   Open    goes in a direction; what it meets first must be below the node.
//
// How they are drawn: aiming.hpp. A target behind glass is met by the first alone.
// Cost: 0.1-0.3 microseconds without the ray.
#include <array>
#include <span>

#include "base/sobol.hpp"
#include "particles/aiming.hpp"
#include "particles/senders.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::particles {

/// One sender node and one receiver node: a link from diffuse or emitted light to specular surfaces (DS).
struct LinkEnds {
  std::uint32_t sender = 0, receiver = 0;  // nodes
};

/// Numbers in [0,1) of one sample.
struct EmissionNumbers {
  Vec2 choice, origin, direction;
};

/// Those of the samples of a key: stratified, and the same for any count.
class EmissionSequence {
 public:
  explicit EmissionSequence(std::uint64_t key)
      : choice_(combineKeys(key, 1)), origin_(combineKeys(key, 2)), direction_(combineKeys(key, 3)) {}
  static constexpr std::size_t kMost = 16;  // [task]
  /// Those of up to kMost samples, from `first` on.
  void operator()(std::uint32_t first, std::span<EmissionNumbers> numbers) const {
    std::array<UnitPair, kMost> a, b, c;
    const auto some = [&](auto& points) { return std::span(points).first(numbers.size()); };
    choice_.points(first, some(a)), origin_.points(first, some(b)), direction_.points(first, some(c));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = {{a[i].x, a[i].y}, {b[i].x, b[i].y}, {c[i].x, c[i].y}};
  }

 private:
  ScrambledSobol choice_, origin_, direction_;
};

struct FirstSegment {
  using Kind = Aim::Kind;
  Kind kind = Kind::None;
  bool atInfinity = false;  // the sender is: `ray` then starts at the target
  std::uint32_t senderCell = 0, originTriangle = 0;
  std::uint32_t receiverCell = 0;       // Target
  float bound = 0;                      // gray flux if nothing stood between and the sender shone this way
  float density = 0;                    // per solid angle, of this strategy where the other might have done the same
  float balance = 1;                    // Target: its share where the other strategy would have met it, too
  Vec3f origin{0.0f}, direction{0.0f};  // of the light
  tracing::Ray ray;                     // to be traced
  Vec3 target{0}, normal{0};            // Target: where it arrives
  Rgb flux{0.0f};                       // throughput: of a surface per radiosity [unit^2], of a light per scale [W]
};

/// Where a particle first meets a receiver.
struct FirstHit {
  PrimitiveId primitive;  // invalid: nowhere; an open segment then ends at `position`, if its distance is finite
  PrimitiveId blocker;    // what keeps it from arriving, if anything does
  std::uint32_t triangle = 0;
  Vec3f position{0.0f}, normal{0.0f}, direction{0.0f};      // normal: of the front
  float distance = std::numeric_limits<float>::infinity();  // infinite from suns and skies
  Rgb flux{0.0f};

  bool front() const { return glm::dot(normal, direction) < 0; }
};

/// Memory for tracing first segments, used again by the next.
struct FirstRays {
  std::vector<std::uint32_t> targets, opens;
  std::vector<tracing::Ray> straight, open;
  std::vector<tracing::Passing> passed;
  std::vector<tracing::Hit> hits;
};

/// A distance beyond everything: in steps, so that small motions do not change it.
double farDistance(const Scene&);

class ParticleEmission {
 public:
  /// All must outlive this.
  ParticleEmission(const Scene&, const tracing::RayTracer&, const Senders&, const Receivers&);

  // Results are written where they stay: to copy what was just written in parts stalls.
  void sample(const LinkEnds&, const EmissionNumbers&, FirstSegment&) const;
  /// Traces first segments: what of each arrives where.
  void arrive(std::span<const LinkEnds>, std::span<const FirstSegment>, std::span<FirstHit>, FirstRays&,
              std::uint64_t& rays) const;
  /// Whether provably nothing passes from sender to receiver: it lies behind the plane of a flat sender.
  bool averted(const LinkEnds&) const;

 private:
  Senders::Choice choose(const LinkEnds&, double u) const;
  void fromInfinity(const LinkEnds&, const EmissionNumbers&, double share, FirstSegment&) const;
  void fromPlace(const LinkEnds&, const EmissionNumbers&, double share, FirstSegment&) const;
  void meet(const LinkEnds&, const FirstSegment&, const tracing::Hit&, FirstHit&) const;
  const Emission& emission(const SenderCell&) const;

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const Senders& senders_;
  const Receivers& receivers_;
  Aiming aiming_;
  double far_;  // distance at which suns and skies are drawn from
};

}  // namespace deltalux::particles
