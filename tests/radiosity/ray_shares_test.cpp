// How leaves round what they deal out: right in the mean, and together with the leaves beside them.
#include "radiosity/ray_shares.hpp"

#include <gtest/gtest.h>

#include <set>

#include "hierarchy/below.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "paper/sender_sampling.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace paper;
using namespace radiosity;

namespace {

class RayShares : public testing::Test {
 protected:
  /// A plate of 4 x 4 leaves.
  void SetUp() override {
    Scene scene;
    test::addPolygon(scene, test::addMaterial(scene, "plate", test::lambert(0.5f)),
                     {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    const hierarchy::ElementId plate = elements.inputs.front();
    ASSERT_TRUE(hierarchy::subdivide(elements, scene, plate));
    for (std::size_t i = 0; i < 4; ++i) ASSERT_TRUE(hierarchy::subdivide(elements, scene, elements.child(plate, i)));
    hierarchy::forEachLeafBelow(elements, plate, [&](hierarchy::ElementId e) { leaves.push_back(e); });
    ASSERT_EQ(leaves.size(), 16u);
  }

  hierarchy::Elements elements;
  std::vector<hierarchy::ElementId> leaves;  // four of a patch, then those of the next
};

TEST_F(RayShares, RoundingsOfLeavesBesideEachOtherAreStratified) {
  for (std::uint64_t thing = 0; thing < 200; ++thing) {
    std::set<int> sixteenths;
    for (std::size_t i = 0; i < leaves.size(); i += 4) {
      std::set<int> quarters;
      for (std::size_t k = i; k < i + 4; ++k) {
        const double u = Roundings(elements, leaves[k]).of(thing);
        ASSERT_TRUE(u >= 0 && u < 1);
        quarters.insert(static_cast<int>(4 * u)), sixteenths.insert(static_cast<int>(16 * u));
      }
      EXPECT_EQ(quarters.size(), 4u);
    }
    EXPECT_EQ(sixteenths.size(), 16u);
  }
}

TEST_F(RayShares, FirstSamplesOfLeavesBesideEachOtherAreStratified) {
  constexpr int kSide = 4, kExpected = LeafGroup::kPlaces / (kSide * kSide);
  for (std::uint64_t key = 0; key < 200; ++key) {
    std::array<std::array<int, kSide * kSide>, 2> cells{};  // in the first two dimensions, and in the others
    for (unsigned place = 0; place < LeafGroup::kPlaces; ++place) {
      const auto u = stratified4(SampleKey{key, place}, 0);
      for (std::size_t k = 0; k < 2; ++k)
        ++cells[k][static_cast<std::size_t>(kSide * u[2 * k]) * kSide + static_cast<std::size_t>(kSide * u[2 * k + 1])];
    }
    for (const auto& plane : cells)
      for (const int n : plane) EXPECT_NEAR(n, kExpected, 3);
  }
}

TEST_F(RayShares, LeavesOfAGroupHaveTheirPlaces) {
  std::set<unsigned> places;
  for (const hierarchy::ElementId leaf : leaves) {
    EXPECT_EQ(groupOf(elements, leaf).key, groupOf(elements, leaves.front()).key);
    places.insert(groupOf(elements, leaf).place);
  }
  EXPECT_EQ(places.size(), leaves.size());
  EXPECT_LT(*places.rbegin(), LeafGroup::kPlaces);
  const hierarchy::ElementId above = elements.at(leaves.front()).parent;
  EXPECT_NE(groupOf(elements, above).key, groupOf(elements, leaves.front()).key) << "leaves of other sizes draw alone";
}

TEST_F(RayShares, RoundingsOfOneLeafAreEven) {
  constexpr int kThings = 40000, kBins = 50;
  const Roundings roundings(elements, leaves[5]);
  std::array<int, kBins> bins{};
  double squares = 0;
  for (std::uint64_t thing = 0; thing < kThings; ++thing) ++bins[static_cast<std::size_t>(kBins * roundings.of(thing))];
  for (const int n : bins) squares += std::pow(n - kThings / kBins, 2) / (kThings / kBins);
  EXPECT_LT(squares, kBins - 1 + 4 * std::sqrt(2.0 * (kBins - 1)));
}

TEST_F(RayShares, LeavesTogetherDealOutWhatAPartIsWorth) {
  double sum = 0;
  constexpr int kDeals = 400;
  for (std::uint32_t deal = 0; deal < kDeals; ++deal) {
    std::vector<RayShare> parts{{2 * deal, 0, 0, 0.3f}, {2 * deal + 1, 0, 1, 0.7f}};
    int first = 0;
    for (const hierarchy::ElementId leaf : leaves)
      dealOut(parts, 1, Roundings(elements, leaf), [&](std::uint32_t i, int rays) { first += i == 0 ? rays : 0; });
    EXPECT_TRUE(first == 4 || first == 5) << first;
    sum += first;
  }
  EXPECT_NEAR(sum / kDeals, 16 * 0.3, 0.1);
}

}  // namespace
}  // namespace deltalux
