#include "base/large_array.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace deltalux {
namespace {

constexpr std::size_t kMany = 3 << 20;  // of four bytes: several large pages

TEST(LargeArray, KeepsItsValuesWhenItGrowsAndIsCopied) {
  LargeArray<std::uint32_t> array;
  for (std::uint32_t i = 0; i < kMany; ++i) array.push_back(i);
  const LargeArray<std::uint32_t> copy = array;
  array.resize(100);
  array.shrink_to_fit();
  EXPECT_EQ(copy.size(), kMany);
  for (std::uint32_t i = 0; i < kMany; ++i) ASSERT_EQ(copy[i], i);
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(array[i], i);
}

struct WithDefault {
  std::uint32_t value = 7;
};

TEST(LargeArray, SetsWhatATypeSetsByItselfAndWhatIsAskedFor) {
  const LargeArray<WithDefault> own(kMany);
  const LargeArray<std::uint32_t> asked(kMany, 5u);
  EXPECT_TRUE(std::all_of(own.begin(), own.end(), [](const WithDefault& w) { return w.value == 7; }));
  EXPECT_EQ(std::accumulate(asked.begin(), asked.end(), std::uint64_t{0}), std::uint64_t{5} * kMany);
}

TEST(LargeArray, IsAlignedForLargePagesWhenItIsLarge) {
  const LargeArray<std::uint32_t> large(kMany);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % (std::uintptr_t(1) << 21), 0u);
}

}  // namespace
}  // namespace deltalux
