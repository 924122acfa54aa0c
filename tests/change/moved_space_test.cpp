// What rays may pass where something has moved: never too little.
#include "change/moved_space.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "change/line_sieve.hpp"
#include "lines/line_code.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A room with a box in it that has come from elsewhere.
struct Moved {
  Scene scene;
  std::vector<SceneChange::Moved> parts;

  Moved() {
    const MaterialId white = addMaterial(scene, "white", lambert(0.7f));
    addBox(scene, white, Vec3(0), {4, 4, 3}, true);
    const std::size_t first = scene.primitives.size();
    addBox(scene, white, {1, 1, 0}, {1.5, 1.4, 0.8}, false);
    for (std::size_t i = first; i < scene.primitives.size(); ++i) {
      const Box now = bounds(scene.primitives[i].shape);
      parts.push_back({PrimitiveId(i), {now.lower + Vec3(1, 0.5, 0), now.upper + Vec3(1, 0.5, 0)}, now});
    }
  }
};

const Box kBoxes[] = {{{1, 1, 0}, {1.5, 1.4, 0.8}}, {{2, 1.5, 0}, {2.5, 1.9, 0.8}}};

/// Whether a segment meets one of the boxes, by many points of it.
bool meets(const Vec3& from, const Vec3& to) {
  for (int i = 0; i <= 2000; ++i) {
    const Vec3 p = from + (i / 2000.0) * (to - from);
    for (const Box& b : kBoxes)
      if (glm::all(glm::greaterThanEqual(p, b.lower)) && glm::all(glm::lessThanEqual(p, b.upper))) return true;
  }
  return false;
}

TEST(MovedSpace, KnowsEverySegmentThatMeetsWhereThingsWereOrAre) {
  const Moved m;
  const change::MovedSpace space(m.scene, m.parts);
  Rng random(5);
  int met = 0, free = 0, passed = 0, apart = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto point = [&] {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      return Vec3(4 * x, 4 * y, 3 * z);
    };
    const Vec3 from = point(), to = point();
    const auto length = static_cast<float>(glm::length(to - from));
    const Vec3f way(glm::normalize(to - from));
    const bool meeting = meets(from, to), said = space.crosses({Vec3f(from), Vec3f(from)}, way, length);
    EXPECT_TRUE(said || !meeting);
    met += meeting, free += !said;
    // From anywhere about a point that holds `from`, by the code of the line.
    const lines::LineCode code = lines::lineCode(way, length);
    const Vec3f near = Vec3f(from) + Vec3f(0.05f, -0.05f, 0.05f), half(0.1f);
    const BoxF about{near - half, near + half};
    EXPECT_TRUE(space.crosses(about, lines::direction(code), lines::lengthOf(code), lines::kDirectionError) ||
                !meeting);
    char marked = 0;
    change::LineSieve(space, about, lines::kDirectionError).mark({&code, 1}, {&marked, 1});
    EXPECT_TRUE(marked || !meeting);
    passed += !marked;
    EXPECT_TRUE(space.between(about, {Vec3f(to) - half, Vec3f(to) + half}) || !meeting);
    apart += !space.between({Vec3f(from), Vec3f(from)}, {Vec3f(to), Vec3f(to)});
  }
  EXPECT_GT(met, 200);
  EXPECT_GT(free, 2000);  // and it does not say so of all
  EXPECT_GT(passed, 1000);
  EXPECT_GT(apart, 2000);
}

TEST(MovedSpace, KnowsWhatMovedAndWhatIsBeside) {
  const Moved m;
  change::MovedSpace space(m.scene, m.parts);
  EXPECT_FALSE(space.moved(PrimitiveId(0)));
  EXPECT_TRUE(space.moved(m.parts.front().primitive));
  EXPECT_TRUE(space.touches({Vec3f{1.2f, 1.2f, 0.79f}, Vec3f{1.2f, 1.2f, 1}}));
  EXPECT_FALSE(space.touches({Vec3f{1.2f, 1.2f, 0.81f}, Vec3f{1.2f, 1.2f, 1}}));
  EXPECT_FALSE(space.touches({Vec3f{3, 3, 1.5f}, Vec3f{4, 4, 2.5f}}));
  space.add(PrimitiveId(0), {{3, 3, 1.5f}, {4, 4, 1.6f}});
  EXPECT_TRUE(space.moved(PrimitiveId(0)) && space.touches({Vec3f{3, 3, 1.5f}, Vec3f{4, 4, 2.5f}}));
  EXPECT_TRUE(change::MovedSpace(m.scene, {}).empty());
}

}  // namespace
}  // namespace deltalux
