#pragma once
// The first segment of particles: from a point of a sender towards the receivers below a node, with the flux that the
// sample stands for. The expected flux is exact whatever the two ends are:
//
//   Target  a point is drawn on a receiver (flat ones near the sender by solid angle [UFK13], others by area, cells of
//   a
//           cluster by area and reflectance); the segment to it must be free but for thin glass. Suns and skies always.
//   Open    a direction is drawn into the bounding sphere of the node, or any where the sphere is near; what it meets
//           first must be below the node.
//
// Near clusters and near curved receivers take either with even chances, weighted by the balance heuristic [Veach97
// 9.2.2]: the first is bad where receivers are close, the second where they fill little of what bounds them. A target
// behind glass is met by the first alone. Which strategies serve a sample depends on its origin and the node.
// Cost: 0.1-0.3 microseconds without the ray.
#include <array>
#include <span>

#include "base/sobol.hpp"
#include "particles/receivers.hpp"
#include "particles/senders.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

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
  static constexpr std::size_t kMost = 16;
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
  enum class Kind : std::uint8_t { None, Target, Open };
  Kind kind = Kind::None;
  bool atInfinity = false;  // the sender is: `ray` then starts at the target
  std::uint32_t senderCell = 0, originTriangle = 0;
  std::uint32_t receiverCell = 0;       // Target
  float bound = 0;                      // gray flux if nothing stood between and the sender shone this way
  float density = 0;                    // per solid angle, of this strategy where the other might have done the same
  float balance = 1;                    // Target: its share where the other strategy would have met it, too
  Vec3f origin{0.0f}, direction{0.0f};  // of the light
  Ray ray;                              // to be traced
  Vec3 target{0}, normal{0};            // Target: where it arrives
  Rgb flux{0.0f};                       // throughput: of a surface per radiosity [unit^2], of a light per scale [W]
};

/// Where a particle first meets a receiver.
struct Arrival {
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
  std::vector<Ray> straight, open;
  std::vector<Passing> passed;
  std::vector<Hit> hits;
};

/// A distance beyond everything: in steps, so that small motions do not change it.
double farDistance(const Scene&);

class ParticleEmission {
 public:
  /// All must outlive this.
  ParticleEmission(const Scene&, const RayTracer&, const Senders&, const Receivers&);

  // Results are written where they stay: to copy what was just written in parts stalls.
  void sample(const LinkEnds&, const EmissionNumbers&, FirstSegment&) const;
  /// Traces first segments: what of each arrives where.
  void arrive(std::span<const LinkEnds>, std::span<const FirstSegment>, std::span<Arrival>, FirstRays&,
              std::uint64_t& rays) const;
  /// Whether provably nothing passes from sender to receiver: it lies behind the plane of a flat sender.
  bool averted(const LinkEnds&) const;

 private:
  struct Origin {
    Vec3 position{0}, normal{0};
    bool lambertian = false;  // has a normal, and a cosine about it
  };
  struct Aim {
    FirstSegment::Kind kind = FirstSegment::Kind::None;
    std::uint32_t cell = 0;
    Vec3 direction{0}, target{0}, normal{0};
    double distance = 0;
    double density = 0;  // per solid angle
    double balance = 1;
  };

  Senders::Choice choose(const LinkEnds&, double u) const;
  std::optional<double> behind(const Origin&, std::uint32_t node) const;
  /// `Aim`: none as yet.
  void aim(const Origin&, std::uint32_t node, double choice, const Vec2& u, Aim&) const;
  void aimAtCell(const Vec3& from, const RadixNode&, double choice, const Vec2& u, Aim&) const;
  void aimAtFlat(const Vec3& from, std::uint32_t cell, const Vec2& u, Aim&) const;
  void aimAtCurved(const Vec3& from, std::uint32_t cell, const Vec2& u, Aim&) const;
  void aimAround(const Origin&, const BoundingSphere&, const Vec2& u, Aim&) const;
  /// Densities per solid angle of those: of a point of a cell below the node, and of a direction.
  double densityAtCell(const Vec3& from, const RadixNode&, std::uint32_t cell, const Vec3& at,
                       const Vec3& normal) const;
  double densityAround(const Origin&, const BoundingSphere&, const Vec3& direction) const;
  bool seenBySolidAngle(const Vec3& from, const Rectangle&) const;
  bool hidesItself(std::uint32_t cell, const Vec3& position, const Vec3& towardsLight, const Vec3* from) const;
  void fromInfinity(const LinkEnds&, const EmissionNumbers&, double share, FirstSegment&) const;
  void fromPlace(const LinkEnds&, const EmissionNumbers&, double share, FirstSegment&) const;
  void meet(const LinkEnds&, const FirstSegment&, const Hit&, Arrival&) const;
  const Emission& emission(const SenderCell&) const;

  const Scene& scene_;
  const RayTracer& tracer_;
  const Senders& senders_;
  const Receivers& receivers_;
  double far_;  // distance at which suns and skies are drawn from
};

}  // namespace deltalux
