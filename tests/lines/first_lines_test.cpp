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
  lines::walkForLight(s.elements, tracer, lines::nothingHolds, {}, walks);
  std::vector<char> enclosed;
  for (const lines::LightWalks& w : walks) enclosed.push_back(w.enclosed);
  const std::vector<std::uint32_t> counts(leaves.size(), 24);
  const lines::ScaleMeter meter(s.elements, tracer, cover, enclosed);
  std::vector<std::unique_ptr<lines::FirstLines>> first(s.elements.size());
  for (std::size_t i = 0; i < leaves.size(); i += i % 3 == 0 ? 1 : 2)
    meter.measure(leaves[i], *(first[leaves[i].index()] = std::make_unique<lines::FirstLines>()));
  lines::TracedLines all, rest;
  lines::traceLines({s.elements, leaves, locator, tracer, cover, enclosed}, counts, all);
  lines::traceLines({s.elements, leaves, locator, tracer, cover, enclosed, first}, counts, rest);
  EXPECT_LT(rest.rays, all.rays);
  for (const hierarchy::ElementId leaf : leaves.leaves) {
    ASSERT_TRUE(std::ranges::equal(rest.lines.endsOf(leaf), all.lines.endsOf(leaf)));
    ASSERT_EQ(rest.lines.at(leaf).covered, all.lines.at(leaf).covered);
    ASSERT_TRUE(std::ranges::equal(
        rest.lines.codesOf(leaf), all.lines.codesOf(leaf),
        [](lines::LineCode a, lines::LineCode b) { return a.x == b.x && a.y == b.y && a.reach == b.reach; }));
    ASSERT_TRUE(std::ranges::equal(rest.lines.exceptions.at(leaf), all.lines.exceptions.at(leaf),
                                   [](const lines::ExceptionalLine& a, const lines::ExceptionalLine& b) {
                                     return a.number == b.number && a.end == b.end && a.weight == b.weight;
                                   }));
    ASSERT_TRUE(std::ranges::equal(rest.escaped.at(leaf), all.escaped.at(leaf),
                                   [](const lines::EscapedLine& a, const lines::EscapedLine& b) {
                                     return a.direction == b.direction && a.cosine == b.cosine && a.weight == b.weight;
                                   }));
  }
}

TEST(FirstLines, AreTheLinesOfTheLeaf) { expectTheSameWithFirstLines(solved(everything(), 0.05).solution()); }

}  // namespace
}  // namespace deltalux
