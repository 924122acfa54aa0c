#include "scene/triangulation.hpp"

#include <algorithm>
#include <utility>

#include "scene/outline_loops.hpp"

namespace deltalux::scene {

namespace {

class EarClipper {
 public:
  EarClipper(std::span<const Vec2> outline, std::vector<std::uint32_t> loop)
      : points_(outline), left_(std::move(loop)) {
    double largest = 0;
    for (const Vec2& p : points_) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    rounding_ = 8 * std::numeric_limits<double>::epsilon() * largest;
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::size_t at = 0, failures = 0;
    Patience patience = Patience::CleanEars;
    while (left_.size() > 2) {
      if (cut(at, patience)) {
        patience = Patience::CleanEars;
        failures = 0;
        // On past the neighbour: fans from one vertex make slivers.
        at = (at + 1) % left_.size();
      } else if (++failures == left_.size()) {
        patience = static_cast<Patience>(static_cast<int>(patience) + 1);
        failures = 0;
      } else {
        at = (at + 1) % left_.size();
      }
    }
    return std::move(triangles_);
  }

 private:
  /// What may be cut, tried in this order; a sound outline never gets past DegenerateVertices.
  enum class Patience { CleanEars, EarsOverVertices, DegenerateVertices, AnyConvex, Anything };

  const Vec2& point(std::size_t i) const { return points_[left_[i]]; }

  /// Twice the signed area of (a, b, c); 0 when rounding of the coordinates leaves its sign open.
  double orientation(const Vec2& a, const Vec2& b, const Vec2& c) const {
    const Vec2 ab = b - a, ac = c - a;
    const double area = ab.x * ac.y - ab.y * ac.x;
    const double doubt = rounding_ * (std::abs(ab.x) + std::abs(ab.y) + std::abs(ac.x) + std::abs(ac.y));
    return std::abs(area) <= doubt ? 0.0 : area;
  }

  /// Takes vertex `at` away, with its triangle if that has an area.
  bool cut(std::size_t at, Patience patience) {
    const std::size_t n = left_.size(), before = (at + n - 1) % n, after = (at + 1) % n;
    const double turn = orientation(point(before), point(at), point(after));
    if (!mayCut(before, at, after, turn, patience)) return false;
    if (turn > 0) triangles_.push_back({left_[before], left_[at], left_[after]});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
    return true;
  }

  bool mayCut(std::size_t before, std::size_t at, std::size_t after, double turn, Patience patience) const {
    if (patience == Patience::Anything) return true;
    if (turn > 0)
      return patience == Patience::AnyConvex ||
             (isEar(before, at, after) &&
              (patience >= Patience::EarsOverVertices || !touchesVertex(point(before), point(after))));
    const bool repeats = point(before) == point(at) || point(at) == point(after) || point(before) == point(after);
    return turn == 0 && (repeats || patience >= Patience::DegenerateVertices);
  }

  bool isEar(std::size_t before, std::size_t at, std::size_t after) const {
    const std::array<Vec2, 3> triangle{point(before), point(at), point(after)};
    const std::size_t n = left_.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (i == before || i == at) continue;
      if (enters(point(i), point(i + 1 < n ? i + 1 : 0), triangle)) return false;
    }
    return true;
  }

  /// Whether the segment pq meets the interior of the triangle: no edge of either separates the two.
  bool enters(const Vec2& p, const Vec2& q, const std::array<Vec2, 3>& triangle) const {
    for (int i = 0; i < 3; ++i) {
      const Vec2 &a = triangle[i], &b = triangle[(i + 1) % 3];
      if (orientation(a, b, p) <= 0 && orientation(a, b, q) <= 0) return false;
    }
    const double sides[] = {orientation(p, q, triangle[0]), orientation(p, q, triangle[1]),
                            orientation(p, q, triangle[2])};
    return *std::min_element(sides, sides + 3) < 0 && *std::max_element(sides, sides + 3) > 0;
  }

  /// Whether another vertex lies inside the segment ac.
  bool touchesVertex(const Vec2& a, const Vec2& c) const {
    return std::any_of(left_.begin(), left_.end(), [&](std::uint32_t v) {
      const Vec2& p = points_[v];
      return p != a && p != c && glm::dot(p - a, p - c) < 0 && orientation(a, c, p) == 0;
    });
  }

  std::span<const Vec2> points_;
  std::vector<std::uint32_t> left_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  double rounding_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec2> outline) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (auto& loop : outlineLoops(outline)) {
    const auto part = EarClipper(outline, std::move(loop)).run();
    triangles.insert(triangles.end(), part.begin(), part.end());
  }
  return triangles;
}

}  // namespace deltalux::scene
