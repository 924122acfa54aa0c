// What rows gather beyond what can come goes to their neighbours: none of it is lost, nobody gets more than there is
// room for, and what follows a change is what a list made afresh says.
#include "radiosity/row_surplus.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "base/random.hpp"
#include "radiosity/gather_rays.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace radiosity;

namespace {

class RowSurpluses : public testing::Test {
 protected:
  void SetUp() override {
    Scene scene;
    const MaterialId bright = test::addMaterial(scene, "bright", test::lambert(0.9f));
    test::addBox(scene, bright, {0, 0, 0}, {4, 3, 2.5}, true);
    test::addBox(scene, test::addMaterial(scene, "grey", test::lambert(0.4f)), {1, 1, 0}, {2, 2, 1}, false);
    const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(10.0f), false, {}});
    test::addPolygon(scene, lamp, {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
    SolveSettings settings;
    settings.error = 0.1, settings.diffuseOnly = true;
    Engine engine(std::move(scene), settings);
    engine.solve();
    elements = engine.solution().get().elements;
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (elements.isReceivingLeaf(hierarchy::ElementId(i))) leaves.emplace_back(i);
    for (const hierarchy::ElementId leaf : leaves) factors.push_back(about(leaf, 1));
  }

  /// One in the mean, twice as much here and there.
  float about(hierarchy::ElementId leaf, std::uint64_t salt) const {
    const double u = toUnit(mix64(combineKeys(elements.key[leaf.index()], salt)));
    return elements.shape(leaf).exposed * static_cast<float>(u < 0.1 ? 2.0 : 0.8 + 0.2 * u);
  }
  RowSurplus listed() const {
    RowSurplus surplus;
    surplus.resize(elements);
    for (std::size_t i = 0; i < leaves.size(); ++i) surplus.set(leaves[i], factors[i]);
    std::vector<hierarchy::ElementId> concerned;
    surplus.follow(elements, leaves, concerned);
    surplus.validate(elements);
    return surplus;
  }
  /// Irradiances when every leaf of the scene sends this much.
  std::vector<float> received(const RowSurplus& surplus, float B) {
    std::vector<float> E;
    for (std::size_t i = 0; i < leaves.size(); ++i)
      elements.radiometry[leaves[i].index()].indirect = Rgb(surplus.scale(leaves[i]) * factors[i] * B);
    const RowSurplus::Pools pools = surplus.pools(elements);
    for (const hierarchy::ElementId leaf : leaves)
      E.push_back(gray(elements.radiometry[leaf.index()].indirect + surplus.share(elements, leaf, pools)));
    return E;
  }

  hierarchy::Elements elements;
  std::vector<hierarchy::ElementId> leaves;
  std::vector<float> factors;
};

TEST_F(RowSurpluses, LoseNothingAndGiveNobodyTooMuch) {
  const RowSurplus surplus = listed();
  const std::vector<float> E = received(surplus, 3);
  double gathered = 0, given = 0;
  int scaled = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const hierarchy::ElementGeometry& g = elements.shape(leaves[i]);
    const float rho = maxChannel(elements.radiometry[leaves[i].index()].rho);
    gathered += double(g.area) * factors[i] * 3, given += double(g.litArea()) * E[i];
    EXPECT_LE(E[i], 3 * std::max(1.0f, 0.98f / rho) * 1.0001f);
    scaled += surplus.scale(leaves[i]) * g.exposed < 0.999f;
  }
  EXPECT_GT(scaled, 10);
  EXPECT_NEAR(given, gathered, 1e-4 * gathered);
}

/// Every other leaf sees next to nothing: what its neighbours have too much of must not light it.
TEST_F(RowSurpluses, LeaveInTheDarkWhatSeesLittle) {
  constexpr float little = 0.001f;
  for (std::size_t i = 0; i < leaves.size(); i += 2) factors[i] = little * elements.shape(leaves[i]).exposed;
  const std::vector<float> E = received(listed(), 1);
  float most = 0;
  for (std::size_t i = 0; i < leaves.size(); i += 2) most = std::max(most, E[i]);
  EXPECT_GT(most, little * 1.001f);  // some do share
  EXPECT_LE(most, 2 * little * 1.001f);
}

TEST_F(RowSurpluses, FollowChangesAsIfListedAnew) {
  RowSurplus surplus = listed();
  const std::vector<float> before = received(surplus, 1);
  std::vector<hierarchy::ElementId> changed, concerned;
  for (std::size_t i = 0; i < leaves.size(); i += 17) {
    factors[i] = about(leaves[i], 2 + i);
    surplus.set(leaves[i], factors[i]);
    changed.push_back(leaves[i]);
  }
  surplus.follow(elements, changed, concerned);
  surplus.validate(elements);
  const std::vector<float> E = received(surplus, 1), anew = received(listed(), 1);
  std::sort(concerned.begin(), concerned.end());
  int others = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    EXPECT_NEAR(E[i], anew[i], 1e-5);
    if (i % 17 == 0 || std::abs(E[i] - before[i]) < 1e-3) continue;
    ++others;
    EXPECT_TRUE(std::binary_search(concerned.begin(), concerned.end(), leaves[i])) << i;
  }
  EXPECT_GT(others, 0);
}

TEST_F(RowSurpluses, AreHeardOfWhereTheyAreAnother) {
  const RowSurplus surplus = listed();
  received(surplus, 1);
  RowSurplus::Pools heard = surplus.pools(elements);
  std::vector<hierarchy::ElementId> sharing;
  surplus.listen(elements, surplus.pools(elements), 1e-3f, heard, sharing);
  EXPECT_TRUE(sharing.empty());
  received(surplus, 1.1f);
  const RowSurplus::Pools now = surplus.pools(elements);
  surplus.listen(elements, now, 1e-3f, heard, sharing);
  EXPECT_EQ(heard, now);
  EXPECT_FALSE(sharing.empty());
  for (const hierarchy::ElementId leaf : sharing) EXPECT_GT(maxChannel(surplus.share(elements, leaf, now)), 0);
}

TEST_F(RowSurpluses, RaysGoByAreaAndLight) {
  LeafTransferSettings settings;
  settings.inAll = 0;
  const MeanLeaf mean = meanOf(leaves, elements);
  const GatherRays rays(settings, leaves.size(), mean);
  const hierarchy::ElementId leaf = leaves.front();
  hierarchy::ElementGeometry& g = elements.geometry[leaf.index()];
  Rgb& E = elements.radiometry[leaf.index()].indirect;
  const auto with = [&](double area, double light) {
    g.exposed = 1, g.area = static_cast<float>(area * mean.area);
    E = Rgb(static_cast<float>(light * mean.light / g.area));
    return rays.of(leaf, elements);
  };
  EXPECT_EQ(with(1, 1), settings.gatherRays);
  EXPECT_EQ(with(5, 1), 2 * settings.gatherRays);
  EXPECT_EQ(with(1, 5), 2 * settings.gatherRays);
  EXPECT_EQ(with(1, 17), 4 * settings.gatherRays);
  EXPECT_EQ(with(1e6, 1e6), 8 * settings.gatherRays);
}

}  // namespace
}  // namespace deltalux
