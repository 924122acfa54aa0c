#pragma once
// Indirect light at a point by lines of its own, which read the radiosity of the leaves that they end on: until their
// standard error is what is asked for. They go on over mirrors, gloss and glass where particles do not bring what
// surfaces send that way. [lines.md]
#include <deltalux/probe.hpp>
#include <functional>

#include "lines/lines.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

class LineGather {
 public:
  /// The solution must outlive this.
  explicit LineGather(const Solution&);

  /// Irradiance from leaves, direct light and particles left out, at a point with the unit normal of its side, to a
  /// standard error of `error` times itself plus `ambient`, by at most `most` lines. `key` names the random numbers.
  ProbeResult at(const Vec3f& p, const Vec3f& normal, double ambient, double error, std::uint64_t most,
                 std::uint64_t key) const;
  /// visit(leaf, E) for each of `count` lines that ends on a leaf: the sum of all is the irradiance.
  void forEachLine(const Vec3f& p, const Vec3f& normal, std::uint32_t count, std::uint64_t key,
                   const std::function<void(hierarchy::ElementId, const Rgb&)>& visit) const;

 private:
  /// Radiosity that line `i` reads, and where; an invalid leaf where it ends on none.
  Rgb follow(const Vec3f& p, const Vec3f& normal, lines::LineDirections&, std::uint64_t key, std::uint32_t i,
             hierarchy::ElementId& leaf) const;

  const Solution& s_;
  hierarchy::LeafTable leaves_;
  hierarchy::LeafLocator locator_;
  lines::SurfaceResponses responses_;
  lines::LineTracer tracer_;
};

}  // namespace deltalux::rendering
