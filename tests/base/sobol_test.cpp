#include "base/sobol.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace deltalux {
namespace {

// A (0,2)-sequence: of 2^m points, every elementary interval of area 2^-m holds exactly one.
TEST(Sobol, PowersOfTwoAreStratified) {
  for (std::uint64_t key : {1u, 2u, 77u}) {
    for (int m : {4, 6, 8}) {
      for (int split = 0; split <= m; ++split) {
        std::set<std::pair<int, int>> cells;
        for (std::uint32_t i = 0; i < (1u << m); ++i) {
          const UnitPair p = scrambledSobol(i, key);
          ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
          cells.insert({static_cast<int>(p.x * (1 << split)), static_cast<int>(p.y * (1 << (m - split)))});
        }
        EXPECT_EQ(cells.size(), std::size_t{1} << m) << "key " << key << " split " << split;
      }
    }
  }
}

/// By the recurrence of its direction numbers.
TEST(Sobol, TheSecondDimensionIsPascalsTriangle) {
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const std::uint32_t index = i * 2654435761u;
    std::uint32_t expected = 0, direction = 0x80000000u;
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
      if (index >> bit & 1) expected ^= direction;
    ASSERT_EQ(secondSobolReversed(index), reverseBits(expected)) << index;
  }
}

TEST(Sobol, SeveralAtATimeAreThoseOneByOne) {
  const ScrambledSobol sequence(5);
  std::array<UnitPair, 13> points;
  sequence.points(1000, points);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].x, sequence(1000 + i).x);
    EXPECT_EQ(points[i].y, sequence(1000 + i).y);
  }
}

TEST(Sobol, KeysAreIndependent) {
  double product = 0;
  constexpr int n = 4096;
  for (std::uint32_t i = 0; i < n; ++i) product += (scrambledSobol(i, 1).x - 0.5) * (scrambledSobol(i, 2).x - 0.5);
  EXPECT_NEAR(product / n, 0.0, 4.0 / 12 / 64);
}

}  // namespace
}  // namespace deltalux
