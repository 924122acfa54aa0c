#pragma once
// Rays between patches so close to each other that it matters between which of their points light passes: what is near
// and seen weighs more than what is farther and hidden. Points are drawn in proportion to the kernel between them, by
// resampling [TCE05] a few candidates: some uniform on the patch, some in cosine directions, weighted by the balance
// heuristic [Veach97]. So the share of these rays that pass is the share of light that does, and K times it is right
// (with uniform points, what a table gets through the gap under a box that stands on it is not).
// Cost: eight kernels between points a ray.
#include <array>
#include <optional>

#include "base/random.hpp"
#include "paper/sender_sampling.hpp"

namespace deltalux::radiosity {

/// Whether rays between two patches are worth being drawn so.
bool areClose(const hierarchy::Elements&, hierarchy::ElementId a, hierarchy::ElementId b);

/// One candidate: a point of either end, and what it weighs.
struct ClosePair {
  hierarchy::PatchPoint from, to;
  double weight = 0;
};

inline constexpr int kClosePairs = 8;

/// Candidate `i` from the point `from` to a leaf patch, by two numbers in [0,1).
ClosePair closePair(const hierarchy::Elements&, const Scene&, const hierarchy::PatchPoint& from,
                    hierarchy::ElementId patch, int i, double a, double b);

/// From a point of `pointAt` (of two numbers in [0,1)) to one of a leaf patch; none when all candidates face away.
/// Its weight is that of all candidates: in the mean the kernel.
template <class PointAt>
std::optional<ClosePair> sampleClosePair(const hierarchy::Elements& elements, const Scene& scene,
                                         const PointAt& pointAt, hierarchy::ElementId patch, paper::SampleKey key,
                                         int index) {
  std::array<ClosePair, kClosePairs> pairs;
  double total = 0;
  for (int i = 0; i < kClosePairs; ++i) {
    const auto u = paper::stratified4(key.with(static_cast<std::uint64_t>(i)), index);
    ClosePair& p = pairs[static_cast<std::size_t>(i)];
    p = closePair(elements, scene, pointAt(u[2], u[3]), patch, i, u[0], u[1]);
    total += p.weight;
  }
  const double u = paper::stratified4(key.with(kClosePairs), index)[0];
  ClosePair* picked = paper::pickByWeight(std::span<ClosePair>(pairs), total, u);
  if (!picked) return std::nullopt;
  picked->weight = total;
  return *picked;
}

}  // namespace deltalux::radiosity
