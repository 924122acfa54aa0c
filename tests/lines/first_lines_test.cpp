// Lines that were traced with the mesh are those that are traced without it.
#include "lines/first_lines.hpp"

#include <gtest/gtest.h>

#include "lines/enclosed_sides.hpp"
#include "lines/leaf_scale.hpp"
#include "solution/solution.hpp"
#include "support/solution_scenes.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

Scene everything() {
  Scene scene;
  addEveryShape(scene);
  addEveryLight(scene);
  // A rug on the floor.
  addBox(scene, MaterialId(0u), {0.2, 0.2, 0}, {0.9, 0.8, 0.01}, false);
  return scene;
}

void expectTheSameWithFirstLines(const SolutionView& view) {
  const Solution& s = view.get();
  const hierarchy::LeafTable leaves(s.elements);
  const hierarchy::LeafLocator locator(s.elements, s.scene, leaves);
  const lines::SurfaceResponses responses(s.scene, true);
  const lines::LineTracer tracer(s.scene, *s.tracer, responses);
  const lines::Cover cover(s.scene, *s.tracer);
  std::vector<lines::LightWalks> walks;
  lines::walkForLight(s.elements, tracer, lines::nothingHolds, walks);
  std::vector<char> enclosed;
  for (const lines::LightWalks& w : walks) enclosed.push_back(w.enclosed);
  const std::vector<std::uint32_t> counts(leaves.size(), 24);
  const lines::ScaleMeter meter(s.elements, tracer, cover, enclosed);
  std::vector<std::unique_ptr<lines::FirstLines>> first(s.elements.size());
  for (std::size_t i = 0; i < leaves.size(); i += i % 3 == 0 ? 1 : 2)
    meter.measure(leaves[i], *(first[leaves[i].index()] = std::make_unique<lines::FirstLines>()));
  const lines::TracedLines all = lines::traceLines({s.elements, leaves, locator, tracer, cover, enclosed}, counts);
  const lines::TracedLines rest =
      lines::traceLines({s.elements, leaves, locator, tracer, cover, enclosed, first}, counts);
  EXPECT_LT(rest.rays, all.rays);
  EXPECT_EQ(rest.lines.end, all.lines.end);
  EXPECT_EQ(rest.covered, all.covered);
  for (std::size_t k = 0; k < all.lines.code.size(); ++k) {
    const lines::LineCode a = all.lines.code[k], b = rest.lines.code[k];
    ASSERT_TRUE(a.x == b.x && a.y == b.y && a.reach == b.reach) << k;
  }
  ASSERT_EQ(rest.lines.exceptions.size(), all.lines.exceptions.size());
  for (std::size_t k = 0; k < all.lines.exceptions.size(); ++k) {
    EXPECT_EQ(rest.lines.exceptions[k].line, all.lines.exceptions[k].line);
    EXPECT_EQ(rest.lines.exceptions[k].end, all.lines.exceptions[k].end);
    EXPECT_EQ(rest.lines.exceptions[k].weight, all.lines.exceptions[k].weight);
  }
  ASSERT_EQ(rest.escaped.size(), all.escaped.size());
  for (std::size_t k = 0; k < all.escaped.size(); ++k) {
    EXPECT_EQ(rest.escaped[k].leaf, all.escaped[k].leaf);
    EXPECT_EQ(rest.escaped[k].direction, all.escaped[k].direction);
    EXPECT_EQ(rest.escaped[k].cosine, all.escaped[k].cosine);
    EXPECT_EQ(rest.escaped[k].weight, all.escaped[k].weight);
  }
}

TEST(FirstLines, AreTheLinesOfTheLeaf) { expectTheSameWithFirstLines(solved(everything(), 0.05).solution()); }

}  // namespace
}  // namespace deltalux
