#include "scene/outline_loops.hpp"

#include <algorithm>
#include <numeric>

namespace deltalux::scene {

namespace {

using Indices = std::vector<std::uint32_t>;

/// Clockwise angle from `from` to `to` in (0, 2 pi]: leaving the way one came is the last choice.
double clockwiseAngle(const Vec2& from, const Vec2& to) {
  const double angle = std::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
  return angle < 0 ? -angle : 2 * kPi - angle;
}

/// For each vertex, the vertex whose outgoing edge follows its incoming edge.
class Junctions {
 public:
  explicit Junctions(std::span<const Vec2> outline) : outline_(outline), leaveAs_(outline.size()) {
    std::iota(leaveAs_.begin(), leaveAs_.end(), 0u);
    Indices order = leaveAs_;
    const auto key = [&](std::uint32_t i) { return std::pair(outline[i].x, outline[i].y); };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    for (auto first = order.begin(); first != order.end();) {
      const auto last = std::find_if(first, order.end(), [&](auto i) { return key(i) != key(*first); });
      if (last - first > 1) join({first, last});
      first = last;
    }
  }

  bool changed() const { return changed_; }

  std::vector<Indices> loops() const {
    std::vector<Indices> loops;
    std::vector<bool> done(outline_.size(), false);
    for (std::uint32_t start = 0; start < outline_.size(); ++start) {
      if (done[start]) continue;
      Indices& loop = loops.emplace_back();
      for (std::uint32_t i = start; !done[i]; i = next(leaveAs_[i])) {
        done[i] = true;
        loop.push_back(i);
      }
    }
    return loops;
  }

 private:
  std::uint32_t next(std::uint32_t i) const { return i + 1 < outline_.size() ? i + 1 : 0; }
  std::uint32_t previous(std::uint32_t i) const {
    return i > 0 ? i - 1 : static_cast<std::uint32_t>(outline_.size()) - 1;
  }

  void join(const Indices& passes) {
    std::vector<bool> taken(passes.size(), false);
    for (const std::uint32_t in : passes) {
      const Vec2 back = outline_[previous(in)] - outline_[in];
      std::size_t best = passes.size();
      double least = kInfinity;
      for (std::size_t k = 0; k < passes.size(); ++k) {
        const double angle = clockwiseAngle(back, outline_[next(passes[k])] - outline_[passes[k]]);
        if (!taken[k] && angle < least) best = k, least = angle;
      }
      if (best == passes.size()) return;  // not a number among the vertices
      taken[best] = true;
      leaveAs_[in] = passes[best];
      changed_ = changed_ || passes[best] != in;
    }
  }

  std::span<const Vec2> outline_;
  Indices leaveAs_;
  bool changed_ = false;
};

double signedArea(std::span<const Vec2> outline, const Indices& loop) {
  const Vec2& origin = outline[loop[0]];
  double sum = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec2 a = outline[loop[i]] - origin, b = outline[loop[i + 1]] - origin;
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

}  // namespace

std::vector<Indices> outlineLoops(std::span<const Vec2> outline) {
  Indices all(outline.size());
  std::iota(all.begin(), all.end(), 0u);
  const Junctions junctions(outline);
  if (!junctions.changed()) return {all};
  auto loops = junctions.loops();
  // A loop that turns clockwise is a hole on its own: the outline crosses itself elsewhere too.
  const bool sound =
      std::none_of(loops.begin(), loops.end(), [&](const Indices& l) { return signedArea(outline, l) < 0; });
  if (!sound) return {all};
  return loops;
}

}  // namespace deltalux::scene
