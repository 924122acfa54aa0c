// Lights that edits move, dim and switch: rows follow them, and hold those that are off for now.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/random.hpp"
#include "support/furnished_room.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

SolveSettings diffuseOnly() {
  SolveSettings settings;
  settings.diffuseOnly = true;
  return settings;
}

Engine solvedRoom() {
  Engine engine(test::furnishedRoom(), diffuseOnly());
  engine.solve();
  return engine;
}

Edit move(const char* object, const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return TransformObject{object, matrix};
}

TEST(LightEdits, ALightThatWasOffWhileThingsMovedIsThereWhenItIsOn) {
  Engine engine = solvedRoom();
  for (const char* light : {"globe", "spot"}) engine.apply(SwitchLight{light, false});
  engine.update();
  engine.apply(move("table", {0.1, 0.2, 0}));
  engine.update();
  engine.apply(move("box", {-0.1, 0.1, 0.1}));
  engine.update();
  for (const char* light : {"globe", "spot"}) engine.apply(SwitchLight{light, true});
  EXPECT_EQ(engine.update().rays, 0u);
  test::expectValid(engine, "on");
  test::expectAsSolved(engine, diffuseOnly(), 0.01, 0.03);
}

bool isFrom(const Solution& s, const radiosity::LeafTransfer& t, const std::string& light) {
  return s.scene[s.elements.light[t.leaf.index()]].name == light;
}

/// Sum over leaves of what a light brings them. [W]
double powerFrom(const Solution& s, const std::string& light) {
  double sum = 0;
  for (const radiosity::LeafRow& row : s.transfers.rows())
    for (const radiosity::LeafTransfer& t : row.direct.transfers)
      if (isFrom(s, t, light))
        sum += double(s.elements.shape(row.leaf).area) * gray(t.T * s.elements.radiometry[t.leaf.index()].B);
  return sum;
}

TEST(LightEdits, ACurvedLampMayComeCloseToASurfaceThatItLights) {
  Engine engine = solvedRoom();
  for (int i = 0; i < 4; ++i) {  // up to 4 cm below the ceiling, where links split it
    engine.apply(MoveLight{"globe", {-0.05, 0.02, 0.135}});
    engine.update();
  }
  test::expectValid(engine, "close");
  Engine fresh(engine.solution().scene(), diffuseOnly());
  fresh.solve();
  const double expected = powerFrom(fresh.solution().get(), "globe");
  EXPECT_NEAR(powerFrom(engine.solution().get(), "globe") / expected, 1.0, 0.02);
}

/// Irradiance that a light brings to leaves, by their keys. [W/m^2, gray]
std::map<std::uint64_t, float> irradianceFrom(const Solution& s, const std::string& light) {
  std::map<std::uint64_t, float> E;
  for (const radiosity::LeafRow& row : s.transfers.rows()) {
    float& sum = E[s.elements.key[row.leaf.index()]];
    for (const radiosity::LeafTransfer& t : row.direct.transfers)
      if (isFrom(s, t, light)) sum += gray(t.T * s.elements.radiometry[t.leaf.index()].B);
  }
  return E;
}

TEST(LightEdits, RowsFollowALampThatMovesTogetherWithThings) {
  Engine engine = solvedRoom();
  Rng rng(3);
  for (int i = 0; i < 8; ++i) {
    const auto some = [&] { return 0.5 * (rng.uniform() - 0.5); };
    engine.apply(move("box", {some() - 0.3 * (i % 2), some(), 0.3 * (i % 2)}));
    engine.apply(MoveLight{"spot", {some(), some(), some() * 0.5}});
    engine.apply(AimLight{"spot", {some(), some(), -1}});
    engine.update();
    Engine fresh(engine.solution().scene(), diffuseOnly());
    fresh.solve();
    const auto is = irradianceFrom(engine.solution().get(), "spot");
    double off = 0, all = 0;
    for (const auto& [leaf, E] : irradianceFrom(fresh.solution().get(), "spot")) {
      const auto at = is.find(leaf);
      if (at == is.end()) continue;
      off += std::abs(at->second - E), all += E;
    }
    ASSERT_GT(all, 0) << i;
    EXPECT_LT(off / all, 0.005) << i;
  }
}

TEST(LightEdits, AMovedLampLeavesTheRowsOfOthersAlone) {
  Engine engine = solvedRoom();
  struct Known {
    hierarchy::ElementId leaf;
    std::vector<radiosity::LeafTransfer> of;
  };
  const auto ofSpot = [&](const Solution& s, const radiosity::LeafRow& row) {
    std::vector<radiosity::LeafTransfer> of;
    for (const radiosity::LeafTransfer& t : row.direct.transfers)
      if (isFrom(s, t, "spot")) of.push_back(t);
    return of;
  };
  std::vector<Known> before;
  for (const radiosity::LeafRow& row : engine.solution().get().transfers.rows())
    if (auto of = ofSpot(engine.solution().get(), row); !of.empty()) before.push_back({row.leaf, std::move(of)});
  ASSERT_GT(before.size(), 100u);
  engine.apply(MoveLight{"globe", {0.05, -0.05, -0.05}});
  engine.update();
  const Solution& s = engine.solution().get();
  std::size_t same = 0;
  for (const radiosity::LeafRow& row : s.transfers.rows())
    for (const Known& k : before)
      if (k.leaf == row.leaf) {
        const auto of = ofSpot(s, row);
        same += of.size() == k.of.size() && of[0].T == k.of[0].T;
      }
  EXPECT_GT(static_cast<double>(same), 0.9 * static_cast<double>(before.size()));
  test::expectAsSolved(engine, diffuseOnly(), 0.01, 0.03);
}

}  // namespace
}  // namespace deltalux
