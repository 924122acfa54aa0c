#include "scene/hole_winding.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "scene/flat_outline.hpp"

namespace deltalux::scene {

namespace {

using VertexOrder = std::vector<std::uint32_t>;
constexpr std::uint32_t kNone = ~std::uint32_t{0};  // [sentinel]

// A number for each vertex, equal for vertices at one point.
VertexOrder pointsOf(const std::vector<Vec2>& outline, std::size_t& count) {
  VertexOrder order(outline.size()), point(outline.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::pair(outline[i].x, outline[i].y); };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  count = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && key(order[k]) != key(order[k - 1])) ++count;
    point[order[k]] = static_cast<std::uint32_t>(count);
  }
  ++count;
  return point;
}

struct Corner {
  std::uint32_t vertex;
  VertexOrder hanging = {};  // loops that the walk makes from here before it goes on
};

struct Loop {
  std::vector<Corner> corners;  // the first one is the other loop's, where this one hangs
  std::uint32_t closing =
      kNone;        // the vertex with which the walk comes back to the first corner; none for the last loop
  double area = 0;  // signed
  Vec2 low{kInfinity}, high{-kInfinity};
  bool backwards = false;
};

// Loops that pass no point twice; the last one is what is left of the walk.
std::vector<Loop> loopsOf(const std::vector<Vec2>& outline, const VertexOrder& point, std::size_t points) {
  std::vector<Loop> loops;
  std::vector<Corner> walk;
  VertexOrder placeInWalk(points, kNone);
  for (std::uint32_t i = 0; i < outline.size(); ++i) {
    const std::uint32_t place = placeInWalk[point[i]];
    if (place == kNone) {
      placeInWalk[point[i]] = static_cast<std::uint32_t>(walk.size());
      walk.push_back({i});
      continue;
    }
    Loop loop;
    loop.closing = i;
    loop.corners.push_back({walk[place].vertex});
    for (std::size_t k = place + 1; k < walk.size(); ++k) {
      placeInWalk[point[walk[k].vertex]] = kNone;
      loop.corners.push_back(std::move(walk[k]));
    }
    walk.resize(place + 1);
    walk[place].hanging.push_back(static_cast<std::uint32_t>(loops.size()));
    loops.push_back(std::move(loop));
  }
  loops.emplace_back().corners = std::move(walk);
  return loops;
}

void measure(Loop& loop, const std::vector<Vec2>& outline) {
  const Vec2& origin = outline[loop.corners[0].vertex];
  for (std::size_t i = 0; i < loop.corners.size(); ++i) {
    const Vec2& p = outline[loop.corners[i].vertex];
    loop.low = glm::min(loop.low, p), loop.high = glm::max(loop.high, p);
    if (i + 1 >= loop.corners.size()) break;
    const Vec2 a = p - origin, b = outline[loop.corners[i + 1].vertex] - origin;
    loop.area += 0.5 * (a.x * b.y - a.y * b.x);
  }
}

// Where the horizontal line at `y` crosses the loop, ascending.
std::vector<double> crossings(const Loop& loop, const std::vector<Vec2>& outline, double y) {
  std::vector<double> xs;
  for (std::size_t i = 0, n = loop.corners.size(); i < n; ++i) {
    const Vec2 &a = outline[loop.corners[i].vertex], &b = outline[loop.corners[(i + 1) % n].vertex];
    if ((a.y > y) != (b.y > y)) xs.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
  }
  std::sort(xs.begin(), xs.end());
  return xs;
}

// A point well inside the loop: on the line midway between the two heights of corners that lie farthest apart.
std::optional<Vec2> innerPoint(const Loop& loop, const std::vector<Vec2>& outline) {
  std::vector<double> heights;
  for (const Corner& corner : loop.corners) heights.push_back(outline[corner.vertex].y);
  std::sort(heights.begin(), heights.end());
  double y = 0, gap = 0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    if (heights[i] - heights[i - 1] <= gap) continue;
    gap = heights[i] - heights[i - 1];
    y = 0.5 * (heights[i] + heights[i - 1]);
  }
  const std::vector<double> xs = crossings(loop, outline, y);
  std::optional<Vec2> inner;
  double width = 0;
  for (std::size_t i = 1; i < xs.size(); i += 2) {
    if (xs[i] - xs[i - 1] <= width) continue;
    width = xs[i] - xs[i - 1];
    inner = Vec2(0.5 * (xs[i] + xs[i - 1]), y);
  }
  return inner;
}

bool contains(const Loop& loop, const std::vector<Vec2>& outline, const Vec2& p) {
  if (p.x < loop.low.x || p.x > loop.high.x || p.y < loop.low.y || p.y > loop.high.y) return false;
  const std::vector<double> xs = crossings(loop, outline, p.y);
  return (xs.end() - std::upper_bound(xs.begin(), xs.end(), p.x)) % 2 == 1;
}

// Marks the loops to walk backwards; false when there are none.
bool turnLoops(std::vector<Loop>& loops, const std::vector<Vec2>& outline) {
  std::vector<std::size_t> bySize;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    measure(loops[i], outline);
    const Vec2 size = loops[i].high - loops[i].low;
    constexpr double kNothing = 1e-12;  // of the square of its size: a seam [rounding]
    if (loops[i].corners.size() > 2 && std::abs(loops[i].area) > kNothing * glm::dot(size, size)) bySize.push_back(i);
  }
  std::stable_sort(bySize.begin(), bySize.end(),
                   [&](auto a, auto b) { return std::abs(loops[a].area) > std::abs(loops[b].area); });
  bool any = false;
  for (std::size_t k = 0; k < bySize.size(); ++k) {
    Loop& loop = loops[bySize[k]];
    const std::optional<Vec2> inner = innerPoint(loop, outline);
    if (!inner) continue;
    // Only larger loops can lie around this one.
    const auto around = std::count_if(bySize.begin(), bySize.begin() + static_cast<std::ptrdiff_t>(k),
                                      [&](std::size_t other) { return contains(loops[other], outline, *inner); });
    loop.backwards = (loop.area > 0) != (around % 2 == 0);
    any = any || loop.backwards;
  }
  return any;
}

// The walk over all loops, each in its direction.
VertexOrder walkOf(const std::vector<Loop>& loops, std::size_t vertices) {
  struct Step {
    std::uint32_t index;
    bool isLoop;
  };
  std::vector<Step> todo;  // the next one last
  const auto push = [&](const Corner& corner, bool withVertex) {
    for (auto loop = corner.hanging.rbegin(); loop != corner.hanging.rend(); ++loop) todo.push_back({*loop, true});
    if (withVertex) todo.push_back({corner.vertex, false});
  };
  const auto pushLoop = [&](const Loop& loop) {
    if (loop.closing != kNone) todo.push_back({loop.closing, false});
    const std::size_t n = loop.corners.size();
    for (std::size_t i = 1; i < n; ++i) push(loop.corners[loop.backwards ? i : n - i], true);
    push(loop.corners[0], loop.closing == kNone);
  };
  VertexOrder walk;
  walk.reserve(vertices);
  for (pushLoop(loops.back()); !todo.empty();) {
    const Step step = todo.back();
    todo.pop_back();
    if (step.isLoop) {
      pushLoop(loops[step.index]);
    } else {
      walk.push_back(step.index);
    }
  }
  return walk;
}

VertexOrder asItIs(std::size_t count) {
  VertexOrder order(count);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

}  // namespace

VertexOrder windingOrder(const std::vector<Vec2>& outline) {
  std::size_t points = 0;
  const VertexOrder point = pointsOf(outline, points);
  if (points == outline.size()) return asItIs(outline.size());
  std::vector<Loop> loops = loopsOf(outline, point, points);
  return turnLoops(loops, outline) ? walkOf(loops, outline.size()) : asItIs(outline.size());
}

VertexOrder windingOrder(const std::vector<Vec3>& vertices) {
  if (vertices.size() < 6) return asItIs(vertices.size());  // two loops with an area have six edges
  return windingOrder(flatOutline(vertices, newellVector(vertices)));
}

}  // namespace deltalux::scene
