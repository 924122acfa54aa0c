#include "base/paged_array.hpp"

#include <gtest/gtest.h>

#include <map>

#include "base/random.hpp"

namespace deltalux {
namespace {

TEST(PagedArray, IsAnArray) {
  constexpr std::size_t kSize = 300000;
  PagedArray<int> array(kSize, 7);
  std::map<std::size_t, int> set;
  Rng rng(1);
  for (int k = 0; k < 500; ++k) {
    const auto i = static_cast<std::size_t>(rng.uniform() * kSize);
    array.at(i) = k % 9, set[i] = k % 9;  // some are as the rest
  }
  array.grow(kSize + 5000);
  array.at(kSize + 4999) = 1, set[kSize + 4999] = 1;
  for (std::size_t i = 0; i < kSize + 6000; ++i)
    ASSERT_EQ(array[i], set.contains(i) ? set[i] : 7) << i;  // beyond the end, too
  std::erase_if(set, [](const auto& entry) { return entry.second == 7; });
  auto next = set.begin();
  array.forEach([&](std::size_t i, int value) {
    ASSERT_NE(next, set.end());
    EXPECT_EQ(i, next->first);
    EXPECT_EQ(value, next->second);
    ++next;
  });
  EXPECT_EQ(next, set.end());
}

TEST(PagedArray, GrowsFromNothing) {
  PagedArray<char> array;
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array[12], 0);
  array.grow(13);
  array.at(12) = 1;
  EXPECT_EQ(array[12], 1);
  EXPECT_EQ(array.size(), 13u);
}

}  // namespace
}  // namespace deltalux
