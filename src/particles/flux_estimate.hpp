#pragma once
// What passes over a link of particles, by pilots: first segments of its own, followed over one event to the next
// surface (what only leaves the scene is worth no particle). More pilots at a link add to those before, as samples of
// one stratified sequence. Cost: 0.2 microseconds a look, and a ray or two.
#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "particles/bounce.hpp"
#include "particles/coarse_exitance.hpp"
#include "particles/emission.hpp"
#include "particles/tuning.hpp"

namespace deltalux::particles {

/// Looks at a link that might carry much although nothing arrived, at each root for the sum of all, and along lines
/// through a box that something has left; and particles that tell what each costs: as many as a standard error takes,
/// each of as many.
inline constexpr int kMostLooks = deltalux::tuning::kFewestEstimates * deltalux::tuning::kFewestEstimates;

/// What some pilots at a link have seen.
class PilotSamples {
 public:
  /// `bound`: flux of the look if nothing stood in its way.
  void expect(double bound) { ++count_, bound_ += bound, boundSquares_ += bound * bound; }
  void see(double flux) { ++arrived_, sum_ += flux, squares_ += flux * flux; }

  int count() const { return count_; }
  bool arrived() const { return arrived_ > 0; }
  /// Estimates of flux and of the share that arrives, with hope for what no look found: `most` it can be.
  double flux(double most) const {
    return std::min((sum_ + kHopeful * std::min(bound_ / count_, most)) / (count_ + 1), most);
  }
  double passing() const { return (arrived_ + kHopeful) / (count_ + 1); }
  /// Root mean square of pilots, had they arrived.
  double bound() const { return std::sqrt(boundSquares_ / count_); }
  /// PilotSamples differ much, or only some of them passed.
  bool uneven() const { return squares_ * count_ > (1 + tuning::kUneven * tuning::kUneven) * sum_ * sum_ || sum_ == 0; }

 private:
  static constexpr double kHopeful = 0.5;  // that arrived of one more look [Jeffreys46: prior] [defined]

  int count_ = 0, arrived_ = 0;
  double sum_ = 0, squares_ = 0, bound_ = 0, boundSquares_ = 0;
};

class FluxEstimate {
 public:
  /// All must outlive this.
  FluxEstimate(const Scene&, const tracing::RayTracer&, const ParticleEmission&, const Senders&, const Receivers&,
               const CoarseExitance&);

  /// Memory for pilots, used again by the next.
  struct Workspace {
    std::vector<FirstSegment> segments;
    std::vector<LinkEnds> links;
    std::vector<FirstHit> arrivals;
    FirstRays rays;
    std::uint64_t traced = 0;
  };
  /// PilotSamples until there are `count` of them; `key` names the link.
  void sample(const LinkEnds&, std::uint64_t key, int count, PilotSamples&, Workspace&) const;
  /// Greatest of the receiver.
  double albedo(const LinkEnds& ends) const { return albedo_[ends.receiver]; }
  /// More flux than this cannot pass, whatever stands where.
  double most(const LinkEnds&) const;

 private:
  SenderKind kindOf(std::uint32_t node) const { return senders_.cells()[senders_.nodes()[node].begin].kind; }
  double exitanceOf(std::uint32_t cell) const {
    return senders_.cells()[cell].kind == SenderKind::Side ? exitance_.perCell[cell] : 1.0;
  }
  double albedoOf(const FirstSegment&, const LinkEnds&) const;
  double passedOn(const FirstHit&, const EventNumbers&, std::uint64_t& rays) const;

  const tracing::RayTracer& tracer_;
  const ParticleEmission& emission_;
  const Senders& senders_;
  const Receivers& receivers_;
  const CoarseExitance& exitance_;
  ParticleSurfaces surfaces_;
  std::vector<double> brightest_;       // exitance, by node of senders
  std::vector<double> takes_, albedo_;  // area of both sides times albedo, and greatest albedo, by node of receivers
};

}  // namespace deltalux::particles
