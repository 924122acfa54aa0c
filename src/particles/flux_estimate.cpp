#include "particles/flux_estimate.hpp"

namespace deltalux::particles {

namespace {
constexpr std::uint64_t kLookSeed = 0x6c6f6f6b7a7a7a7aull;  // [key]
}

FluxEstimate::FluxEstimate(const Scene& scene, const tracing::RayTracer& tracer, const ParticleEmission& emission,
                           const Senders& senders, const Receivers& receivers, const CoarseExitance& exitance)
    : tracer_(tracer),
      emission_(emission),
      senders_(senders),
      receivers_(receivers),
      exitance_(exitance),
      surfaces_(scene),
      brightest_(senders.nodes().size()),
      takes_(receivers.nodes().size()),
      albedo_(receivers.nodes().size()) {
  for (std::size_t n = brightest_.size(); n-- > 0;) {
    const RadixNode& node = senders.nodes()[n];
    brightest_[n] =
        node.isLeaf() ? exitanceOf(node.begin) : std::max(brightest_[node.child[0]], brightest_[node.child[1]]);
  }
  for (std::size_t n = takes_.size(); n-- > 0;) {
    const RadixNode& node = receivers.nodes()[n];
    if (node.isLeaf()) {
      albedo_[n] = receivers.albedo(node.begin);
      takes_[n] = 2 * receivers.area(node.begin) * albedo_[n];
    } else {
      albedo_[n] = std::max(albedo_[node.child[0]], albedo_[node.child[1]]);
      takes_[n] = takes_[node.child[0]] + takes_[node.child[1]];
    }
  }
}

double FluxEstimate::most(const LinkEnds& ends) const {
  if (kindOf(ends.sender) != SenderKind::Side) return kInfinity;
  // All that is sent (glass reflects more at grazing angles), and all that is taken of the brightest light.
  return std::min(senders_.weightOf(senders_.nodes()[ends.sender]) * std::min(1.0, 2 * albedo_[ends.receiver]),
                  brightest_[ends.sender] * takes_[ends.receiver]);
}

void FluxEstimate::sample(const LinkEnds& ends, std::uint64_t key, int count, PilotSamples& pilots,
                          Workspace& w) const {
  const int first = pilots.count(), more = count - first;
  if (more <= 0) return;
  w.segments.resize(more), w.arrivals.resize(more), w.links.assign(more, ends);
  const std::uint64_t own = combineKeys(key, kLookSeed);
  const EmissionSequence numbers(own);
  const EventSequence events(own, 0);
  std::array<EmissionNumbers, EmissionSequence::kMost> some;
  for (int i = 0; i < more; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) % some.size();
    if (at == 0)
      numbers(static_cast<std::uint32_t>(first + i),
              std::span(some).first(std::min(some.size(), static_cast<std::size_t>(more - i))));
    emission_.sample(ends, some[at], w.segments[i]);
    const FirstSegment& s = w.segments[i];
    pilots.expect(exitanceOf(s.senderCell) * s.bound * albedoOf(s, ends));
  }
  emission_.arrive(w.links, w.segments, w.arrivals, w.rays, w.traced);
  for (int i = 0; i < more; ++i) {
    const FirstHit& a = w.arrivals[i];
    if (!a.primitive.valid()) continue;
    pilots.see(exitanceOf(w.segments[i].senderCell) *
               passedOn(a, events(static_cast<std::uint32_t>(first + i)), w.traced));
  }
}

double FluxEstimate::albedoOf(const FirstSegment& s, const LinkEnds& ends) const {
  if (s.kind == FirstSegment::Kind::Target) return receivers_.albedo(s.receiverCell);
  return receivers_.albedo(receivers_.nodes()[ends.receiver].begin);
}

/// Gray flux behind the first event, if it meets a surface.
double FluxEstimate::passedOn(const FirstHit& a, const EventNumbers& u, std::uint64_t& rays) const {
  const SurfaceSpot spot{a.primitive, a.triangle, a.position, a.normal, a.front()};
  const auto event = surfaces_.scatter(spot, a.direction, true, u);
  if (!event) return 0;
  tracing::Ray ray;
  ray.direction = event->direction;
  ray.origin = tracing::offsetOrigin(a.position, a.normal, ray.direction);
  ++rays;
  return tracer_.occluded(ray) ? gray(a.flux * event->weight) : 0;
}

}  // namespace deltalux::particles
