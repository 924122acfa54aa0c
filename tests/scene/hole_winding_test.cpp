// Holes by seams, wound either way: what is solid is a matter of the parity of crossings, everywhere in the library.
#include "scene/hole_winding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/scene.hpp>

#include "base/random.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {
using namespace scene;

namespace {

using Outline = std::vector<Vec2>;

Outline rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

Outline turned(Outline o) {
  std::reverse(o.begin() + 1, o.end());
  return o;
}

/// `outer` with `hole` walked from its vertex `at` by a seam; both as they turn.
Outline withLoop(Outline outer, std::size_t at, Outline hole) {
  hole.push_back(hole.front());
  hole.push_back(outer[at]);
  outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(at) + 1, hole.begin(), hole.end());
  return outer;
}

bool insideByCrossings(const Outline& o, Vec2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < o.size(); ++i) {
    Vec2 a = o[i], b = o[(i + 1) % o.size()];
    if (a.y > b.y || (a.y == b.y && a.x > b.x)) std::swap(a, b);
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

std::vector<std::uint32_t> counted(std::size_t n) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < n; ++i) order.push_back(i);
  return order;
}

/// The polygon of `o` in a tilted plane has area `area`, and covers what lies inside by the parity of crossings; rays
/// meet it there and nowhere else.
void expectParity(const Outline& o, double area, const char* what) {
  const Frame frame(glm::normalize(Vec3(0.3, -0.5, 0.8)));
  const auto place = [&](const Vec2& p) { return Vec3(5, -2, 1) + frame.toWorld({p, 0}); };
  std::vector<Vec3> vertices;
  for (const Vec2& p : o) vertices.push_back(place(p));
  const auto polygon = makePolygon(vertices);
  ASSERT_TRUE(polygon) << what;
  EXPECT_NEAR(polygon->area, area, 1e-9) << what;
  EXPECT_EQ(windingOrder(polygon->vertices), counted(polygon->vertices.size()))
      << what << ": turned once is turned for good";
  EXPECT_NEAR(std::abs(glm::dot(polygon->normal, frame.normal)), 1, 1e-9) << what;

  Scene scene;
  scene.materials.push_back({"grey", Opaque{Rgb(0.5f), {}, {}}, std::nullopt});
  scene.primitives.push_back({Shape(*polygon), MaterialId(0), ObjectId()});
  const auto embree = tracing::makeEmbreeTracer(scene), bruteForce = tracing::makeBruteForceTracer(scene);
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec2& p : o) low = glm::min(low, p), high = glm::max(high, p);
  Rng rng(17);
  for (int i = 0; i < 500; ++i) {
    const Vec2 p = low + (high - low) * Vec2(rng.uniform(), rng.uniform());
    const bool solid = insideByCrossings(o, p);
    EXPECT_EQ(covers(*polygon, parameterAt(*polygon, place(p))), solid) << what << " at " << p.x << " " << p.y;
    const tracing::Ray ray{Vec3f(place(p) + frame.normal), 0, Vec3f(-frame.normal)};
    EXPECT_EQ(embree->closestHit(ray).primitive.valid(), solid) << what << " at " << p.x << " " << p.y;
    EXPECT_EQ(bruteForce->closestHit(ray).primitive.valid(), solid) << what << " at " << p.x << " " << p.y;
    const SurfacePoint sample = samplePoint(Shape(*polygon), {rng.uniform(), rng.uniform()});
    const Vec3 local = frame.toLocal(sample.position - Vec3(5, -2, 1));
    EXPECT_TRUE(insideByCrossings(o, {local.x, local.y})) << what << " samples " << local.x << " " << local.y;
  }
}

TEST(HoleWinding, OneHoleEitherWayFromAnyVertex) {
  for (const bool alike : {false, true}) {
    for (std::size_t at = 0; at < 4; ++at) {
      Outline hole = rectangle(1, 1, 2, 2.5);
      std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(at), hole.end());
      if (!alike) hole = turned(hole);
      const Outline o = withLoop(rectangle(0, 0, 4, 3), at, hole);
      expectParity(o, 10.5, alike ? "alike" : "against");
      EXPECT_EQ(windingOrder(o) == counted(o.size()), !alike);
    }
  }
}

TEST(HoleWinding, ManyHolesEachItsOwnWay) {
  Rng rng(4);
  for (int round = 0; round < 8; ++round) {
    // Three rows of holes, by seams from corners of the outline and from holes before them.
    Outline o = rectangle(0, 0, 12, 9);
    for (int row = 0; row < 3; ++row) {
      Outline chain;
      for (int i = 2; i >= 0; --i) {
        Outline hole = rectangle(1 + 3 * i, 1 + 2.5 * row, 2 + 3 * i, 2 + 2.5 * row);
        if (rng.uniform() < 0.5) hole = turned(hole);
        if (!chain.empty()) hole = withLoop(hole, hole[1] == Vec2(2 + 3 * i, 1 + 2.5 * row) ? 1 : 3, chain);
        chain = hole;
      }
      o = withLoop(o, 0, chain);
    }
    expectParity(o, 12 * 9 - 9, "chains");
  }
}

TEST(HoleWinding, IslandsInHoles) {
  for (int ways = 0; ways < 4; ++ways) {
    Outline island = rectangle(2, 2, 3, 3), hole = rectangle(1, 1, 4, 4);
    if (ways & 1) island = turned(island);
    hole = withLoop(hole, 0, island);
    if (ways & 2) hole = turned(hole);
    expectParity(withLoop(rectangle(0, 0, 6, 5), 0, hole), 30 - 9 + 1, "island");
  }
}

TEST(HoleWinding, HolesThatTouch) {
  for (const bool alike : {false, true}) {
    const auto wound = [&](Outline o) { return alike ? o : turned(o); };
    // A corner of the hole lies on the seam's vertex, on an edge, on another corner of the outline, on another hole.
    expectParity(withLoop({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}}, 1, wound({{2, 0}, {3, 1}, {2, 2}, {1, 1}})), 14,
                 "corner on the outline");
    expectParity(withLoop(rectangle(0, 0, 4, 4), 0, wound({{1, 1}, {4, 2}, {1, 3}})), 13, "corner on an edge");
    expectParity(withLoop(rectangle(0, 0, 4, 4), 0, wound({{1, 1}, {3, 1}, {4, 4}, {1, 3}})), 16 - 6,
                 "corner on a corner");
    Outline two = withLoop(rectangle(0, 0, 6, 6), 0, wound(rectangle(1, 1, 2, 2)));
    two = withLoop(two, 0, wound({{3, 1}, {3, 3}, {2, 2}}));
    expectParity(two, 36 - 1 - 1, "holes that touch");
    // The seam runs along an edge of the hole.
    expectParity(withLoop(rectangle(0, 0, 4, 4), 0, wound({{1, 1}, {2, 2}, {3, 3}, {3, 1}})), 14, "seam along an edge");
  }
}

TEST(HoleWinding, WalksThatBeginInAHole) {
  Outline o = withLoop(rectangle(0, 0, 4, 3), 0, rectangle(1, 1, 2, 2));
  for (std::size_t i = 0; i < o.size(); ++i) {
    std::rotate(o.begin(), o.begin() + 1, o.end());
    expectParity(o, 11, "begun elsewhere");
  }
}

TEST(HoleWinding, IslandsOutside) {
  for (const bool alike : {false, true}) {
    const Outline island = alike ? rectangle(6, 0, 7, 1) : turned(rectangle(6, 0, 7, 1));
    expectParity(withLoop(rectangle(0, 0, 4, 3), 1, island), 13, "island outside");
  }
}

TEST(HoleWinding, OutlinesWithoutHolesStayAsTheyAre) {
  EXPECT_EQ(windingOrder(Outline{{0, 0}, {1, 0}, {0, 1}}), counted(3));
  const Outline cornerToCorner{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}};
  EXPECT_EQ(windingOrder(cornerToCorner), counted(8));
  const Outline slit{{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_EQ(windingOrder(slit), counted(7));
}

TEST(HoleWinding, AnyWalkKeepsItsEdges) {
  Rng rng(8);
  for (int round = 0; round < 200; ++round) {
    Outline o;
    for (int i = 0; i < 14; ++i) o.emplace_back(std::floor(rng.uniform() * 4), std::floor(rng.uniform() * 4));
    const std::vector<std::uint32_t> order = windingOrder(o);
    const auto edges = [](const Outline& walk) {
      std::vector<std::array<double, 4>> all;
      for (std::size_t i = 0; i < walk.size(); ++i) {
        Vec2 a = walk[i], b = walk[(i + 1) % walk.size()];
        if (std::pair(b.x, b.y) < std::pair(a.x, a.y)) std::swap(a, b);
        all.push_back({a.x, a.y, b.x, b.y});
      }
      std::sort(all.begin(), all.end());
      return all;
    };
    EXPECT_EQ(edges(inOrder(o, order)), edges(o));
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, counted(o.size()));
  }
}

}  // namespace
}  // namespace deltalux
