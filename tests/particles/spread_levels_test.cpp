// How much of what lands on a surface is taken, where it is too small for its particles.
#include "particles/spread_levels.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "hierarchy/patch.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace particles;

namespace {

/// A room whose floor reflects as much as asked for, and all of whose other surfaces are grey.
class Floor {
 public:
  explicit Floor(float rho) {
    Scene scene;
    test::addBox(scene, test::addMaterial(scene, "grey", test::lambert(0.5f)), {0, 0, 0.1}, {2, 2, 2}, true);
    floor_ = test::addPolygon(scene, test::addMaterial(scene, "floor", test::lambert(rho)),
                              {{0, 0, 0.2}, {2, 0, 0.2}, {2, 2, 0.2}, {0, 2, 0.2}});
    test::addLight(scene, PointLight{{1.6, 1.7, 0.6}, Rgb(1.0f)});
    SolveSettings settings;
    settings.error = 0.05, settings.diffuseOnly = true;
    Engine engine(std::move(scene), settings);
    engine.solve();
    elements_ = engine.solution().get().elements;
    for (std::size_t i = 0; i < elements_.size(); ++i)
      if (const hierarchy::ElementId e(i);
          elements_.isReceivingLeaf(e) && elements_.topology[i].front && elements_.domain[i].primitive == floor_) {
        top_ = hierarchy::surfaceOf(elements_, e), leaves_.push_back(e);
      }
  }

  /// Share that is taken of `flux` per radiosity and area of the floor, over links of that albedo, on its first leaf.
  double damping(double flux, float albedo) {
    std::vector<DepositSums> sums(elements_.size());
    sums[leaves_.front().index()] = {1, 1, feedbackOf(flux * elements_.shape(top_).area, albedo), 1};
    levels_.choose(std::array{top_}, elements_, sums);
    return levels_.damping(levels_.of(leaves_.front()));
  }
  bool spreadOverAll() const { return levels_.of(leaves_.front()) == top_.value; }
  std::size_t leaves() const { return leaves_.size(); }

 private:
  PrimitiveId floor_;
  hierarchy::Elements elements_;
  hierarchy::ElementId top_;
  std::vector<hierarchy::ElementId> leaves_;
  SpreadLevels levels_;
};

TEST(SpreadLevels, LittleIsTakenWhole) {
  for (const float rho : {0.05f, 0.5f, 0.95f}) EXPECT_EQ(Floor(rho).damping(0.6, 0.7f), 1.0) << rho;
}

TEST(SpreadLevels, WhatIsTooMuchForALeafIsSpreadOverTheSurface) {
  Floor floor(0.9f);
  ASSERT_GT(floor.leaves(), 1u);
  EXPECT_EQ(floor.damping(0.6, 0.7f), 1.0);
  EXPECT_TRUE(floor.spreadOverAll());
}

TEST(SpreadLevels, NothingComesBackBrighterAndBrighter) {
  for (const float rho : {0.2f, 0.4f, 0.6f, 0.8f, 0.95f}) {
    Floor floor(rho);
    for (const float albedo : {0.15f, 0.7f, 0.95f}) {
      const double taken = 50 * floor.damping(50, albedo);
      // As much as over one surface, or what, with the 1 that comes straight, does not grow on its way round.
      EXPECT_TRUE(taken <= albedo * 1.001 || rho * (1 + taken) < 1) << rho << ' ' << albedo << ' ' << taken;
    }
  }
}

TEST(SpreadLevels, WithinATubeMoreThanOneWallsWorthIsTaken) {
  const float albedo = 0.7f;
  EXPECT_EQ(Floor(0.2f).damping(albedo / (1 - albedo), albedo), 1.0);
}

}  // namespace
}  // namespace deltalux
