#pragma once
// The points of pieces that touch, each once, and the edges of the pieces with all points that lie on them: so that
// there are no T-vertices.
#include <deltalux/math.hpp>
#include <unordered_map>
#include <vector>

namespace deltalux::rendering {

class TouchingPoints {
 public:
  /// Points nearer than this are one.
  explicit TouchingPoints(double tolerance) : tolerance_(tolerance) {}

  /// The number of a point, new or known.
  std::uint32_t add(const Vec3&);
  const Vec3& at(std::uint32_t point) const { return points_[point]; }
  std::size_t size() const { return points_.size(); }

  /// Closed rings of points, one after the other.
  struct Rings {
    std::vector<std::uint32_t> points, begin{0};

    std::size_t size() const { return begin.size() - 1; }
    void close() { begin.push_back(static_cast<std::uint32_t>(points.size())); }
  };
  /// The rings with all points on their edges. Cost: a search in a box tree an edge.
  Rings withTouching(const Rings&) const;

 private:
  std::uint64_t cellOf(const Vec3& p) const;

  double tolerance_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> nextInCell_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;  // by cell: its last point
};

}  // namespace deltalux::rendering
