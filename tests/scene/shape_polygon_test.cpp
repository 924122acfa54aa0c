#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/shape.hpp>

#include "base/random.hpp"
#include "scene/triangulation.hpp"

namespace deltalux {
using namespace scene;

namespace {

using Outline = std::vector<Vec2>;

double signedArea(const Outline& o) {
  double sum = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const Vec2 &a = o[i], &b = o[(i + 1) % o.size()];
    sum += a.x * b.y - b.x * a.y;
  }
  return 0.5 * sum;
}

/// Even-odd rule; the two passes along a seam cancel.
bool insideByCrossings(const Outline& o, Vec2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < o.size(); ++i) {
    Vec2 a = o[i], b = o[(i + 1) % o.size()];
    if (a.y > b.y || (a.y == b.y && a.x > b.x)) std::swap(a, b);
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

int trianglesOver(const Outline& o, const std::vector<std::array<std::uint32_t, 3>>& triangles, Vec2 p) {
  const auto side = [](Vec2 a, Vec2 b, Vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
  return static_cast<int>(std::count_if(triangles.begin(), triangles.end(), [&](const auto& t) {
    return side(o[t[0]], o[t[1]], p) > 0 && side(o[t[1]], o[t[2]], p) > 0 && side(o[t[2]], o[t[0]], p) > 0;
  }));
}

/// Triangles tile the outline: right area, and each inner point under exactly one of them.
void expectTiling(const Outline& o, const char* what) {
  const auto triangles = triangulate(o);
  double sum = 0;
  for (const auto& t : triangles) {
    const double area = signedArea({o[t[0]], o[t[1]], o[t[2]]});
    EXPECT_GT(area, 0) << what;
    sum += area;
  }
  EXPECT_NEAR(sum, signedArea(o), 1e-11 * std::abs(signedArea(o))) << what;
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec2& p : o) low = glm::min(low, p), high = glm::max(high, p);
  Rng rng(11);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 p = low + (high - low) * Vec2(rng.uniform(), rng.uniform());
    EXPECT_EQ(trianglesOver(o, triangles, p), insideByCrossings(o, p) ? 1 : 0) << what << " at " << p.x << " " << p.y;
  }
}

Outline square(double low, double high) { return {{low, low}, {high, low}, {high, high}, {low, high}}; }

/// Walks `hole` (clockwise) from vertex `at` of `outer`, by a seam.
Outline withHole(Outline outer, std::size_t at, Outline hole) {
  Outline loop = hole;
  loop.push_back(hole.front());
  loop.push_back(outer[at]);
  outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(at) + 1, loop.begin(), loop.end());
  return outer;
}

Outline clockwise(Outline o) {
  std::reverse(o.begin(), o.end());
  return o;
}

TEST(Triangulation, ConcaveOutlines) {
  expectTiling({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, "L");
  expectTiling({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}}, "U");
  Outline star, comb;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * kPi * i / 40, radius = i % 2 ? 0.2 : 1.0;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  expectTiling(star, "star");
  for (int i = 0; i < 30; ++i) comb.emplace_back(30 - i, i % 2 ? 0.1 : 5.0);
  comb.insert(comb.end(), {{0, 0}, {30, 0}});
  expectTiling(comb, "comb");
}

TEST(Triangulation, RandomStarShapedOutlines) {
  Rng rng(3);
  for (int round = 0; round < 50; ++round) {
    Outline o;
    const int n = 3 + static_cast<int>(rng.uniform() * 60);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * kPi * (i + 0.8 * rng.uniform()) / n, radius = 0.05 + rng.uniform();
      o.emplace_back(100 + radius * std::cos(angle), -50 + radius * std::sin(angle));
    }
    if (n > 4) expectTiling(o, "random star-shaped");
  }
}

TEST(Triangulation, HolesBySeams) {
  const Outline hole = clockwise(square(1, 2));
  for (std::size_t at = 0; at < 4; ++at) {
    Outline rotated = hole;
    for (int turn = 0; turn < 4; ++turn) {
      // Only where the seam runs through the solid part.
      if ((at + 2) % 4 != static_cast<std::size_t>(turn)) expectTiling(withHole(square(0, 3), 0, rotated), "one hole");
      std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
      if (rotated.front() == Vec2(2, 2)) std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
    }
  }
  // Two holes whose seams start at one and the same vertex, and a hole that touches its neighbour's corner.
  Outline two = withHole(square(0, 6), 0, {{3, 1}, {3, 2}, {4, 2}, {4, 1}});
  two = withHole(two, 0, {{1, 1}, {1, 2}, {2, 2}, {2, 1}});
  expectTiling(two, "two holes");
  Outline touching = withHole(square(0, 6), 0, {{1, 1}, {1, 2}, {2, 2}, {2, 1}});
  touching = withHole(touching, 4, {{2, 2}, {2, 3}, {3, 3}, {3, 2}});
  expectTiling(touching, "touching holes");
}

TEST(Triangulation, SeamsFromOneVertexInAnyOrder) {
  // Six holes in a row, each by a seam from the lower left corner that passes the others, in shuffled order.
  Rng rng(21);
  for (int round = 0; round < 40; ++round) {
    std::vector<Outline> holes;
    for (int i = 0; i < 6; ++i) {
      const double x = 2 + i, y = 6 - i;
      Outline hole = clockwise({{x, y}, {x + 0.3, y}, {x + 0.3, y + 0.3}, {x, y + 0.3}});
      std::rotate(hole.begin(), std::find(hole.begin(), hole.end(), Vec2(x, y)), hole.end());
      holes.push_back(hole);
    }
    Outline o = square(0, 8);
    while (!holes.empty()) {
      const auto at = static_cast<std::size_t>(rng.uniform() * static_cast<double>(holes.size()));
      o = withHole(o, 0, holes[at]);
      holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(at));
    }
    expectTiling(o, "seams in any order");
  }
}

TEST(Triangulation, OutlineThroughOnePointTwice) {
  // Two squares that share a corner, walked straight across it, and walked by turning there.
  expectTiling({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}, "turning");
  expectTiling({{1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}, {0, 0}, {1, 0}}, "crossing");
}

TEST(Triangulation, RepeatedAndCollinearVertices) {
  expectTiling({{0, 0}, {0, 0}, {1, 0}, {2, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}, "square with extras");
  expectTiling({{0, 0}, {1, 0}, {2, 0}, {0, 2}}, "triangle with a vertex on an edge");
  expectTiling({{0, 0}, {2, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}}, "spike outside");
  expectTiling({{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {1, 2}, {0, 2}}, "slit inside");
  // Vertices inside straight edges become corners of triangles: no gap for rays to slip through.
  const Outline o{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_EQ(triangulate(o).size(), 3u);
}

TEST(Triangulation, CrossingOutlineEnds) {
  EXPECT_LE(triangulate(Outline{{0, 0}, {3, 0}, {0, 2}, {3, 3}}).size(), 2u);
  Rng rng(5);
  for (int round = 0; round < 200; ++round) {
    Outline o;
    for (int i = 0; i < 12; ++i) o.emplace_back(std::floor(rng.uniform() * 4), std::floor(rng.uniform() * 4));
    EXPECT_LE(triangulate(o).size(), 10u);
  }
}

TEST(MakePolygon, RectangleFillsItsFrame) {
  const auto p = makePolygon({{1, 2, 3}, {4, 2, 3}, {4, 7, 3}, {1, 7, 3}});
  ASSERT_TRUE(p);
  EXPECT_TRUE(p->fillsFrame);
  EXPECT_EQ(p->normal, Vec3(0, 0, 1));
  EXPECT_DOUBLE_EQ(p->area, 15);
  EXPECT_EQ(pointAt(*p, {1, 1}).position, Vec3(4, 7, 3));
  EXPECT_EQ(p->triangles.size(), 2u);
}

TEST(MakePolygon, ParallelogramWithVerticesOnItsEdges) {
  const auto p = makePolygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 1, 0}, {1, 1, 0}});
  ASSERT_TRUE(p);
  EXPECT_TRUE(p->fillsFrame);
  EXPECT_DOUBLE_EQ(p->area, 2);
}

TEST(MakePolygon, HoleBySeamIsNotCovered) {
  const auto p = makePolygon(
      {{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}, {0, 0, 1}, {1, 1, 1}, {1, 3, 1}, {3, 3, 1}, {3, 1, 1}, {1, 1, 1}});
  ASSERT_TRUE(p);
  EXPECT_DOUBLE_EQ(p->area, 12);
  EXPECT_FALSE(covers(*p, parameterAt(*p, {2, 2, 1})));
  EXPECT_TRUE(covers(*p, parameterAt(*p, {0.5, 2, 1})));
  EXPECT_TRUE(covers(*p, parameterAt(*p, {4, 4, 1})));
}

TEST(MakePolygon, NoAreaOrNoPlane) {
  EXPECT_FALSE(makePolygon({{0, 0, 0}, {1, 0, 0}}));
  EXPECT_FALSE(makePolygon({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}));
  EXPECT_FALSE(makePolygon({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}));
  EXPECT_FALSE(makePolygon({{0.1, 0.2, 0.3}, {30.1, 60.2, 90.3}, {20.1, 40.2, 60.3}, {10.1, 20.2, 30.3}}));
  EXPECT_FALSE(makePolygon({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}})) << "bow tie: signed areas cancel";
  EXPECT_FALSE(makePolygon({{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1, 0.2}})) << "not planar";
  EXPECT_FALSE(makePolygon({{0, 0, 0}, {1, 0, 0}, {std::nan(""), 1, 0}}));
  EXPECT_FALSE(makePolygon({{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}}));
}

TEST(MakePolygon, SliversAndNearlyPlanarOnesStand) {
  const auto sliver = makePolygon({{30, 30, 30}, {31, 30, 30}, {31, 30 + 1e-7, 30}});
  ASSERT_TRUE(sliver);
  EXPECT_NEAR(sliver->area, 5e-8, 1e-14);
  const auto warped = makePolygon({{0, 0, 0}, {1, 0, 4e-4}, {1, 1, 0}, {0, 1, 4e-4}});
  ASSERT_TRUE(warped);
  for (const Vec3& v : warped->vertices) EXPECT_NEAR(glm::dot(v - warped->vertices[0], warped->normal), 0, 1e-15);
}

TEST(MakePolygon, FrontSeesCounterClockwiseAnyOrientation) {
  Rng rng(9);
  for (int round = 0; round < 200; ++round) {
    const Vec3 axis = glm::normalize(Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5));
    const Frame frame(axis);
    const Outline o{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    std::vector<Vec3> vertices;
    for (const Vec2& v : o) vertices.push_back(Vec3(17, -4, 9) + frame.toWorld({v, 0}));
    const auto p = makePolygon(vertices);
    ASSERT_TRUE(p);
    EXPECT_NEAR(glm::dot(p->normal, axis), 1, 1e-14);
    EXPECT_NEAR(p->area, 5, 1e-12);
    EXPECT_GT(glm::dot(glm::cross(p->edgeU, p->edgeV), p->normal), 0);
    EXPECT_NEAR(glm::length(glm::cross(p->edgeU, p->edgeV)), 9, 1e-12) << "bounding rectangle";
    for (const auto& [a, b, c] : p->triangles)
      EXPECT_GT(glm::dot(glm::cross(p->vertices[b] - p->vertices[a], p->vertices[c] - p->vertices[a]), axis), 0);
  }
}

}  // namespace
}  // namespace deltalux
