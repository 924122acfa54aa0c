#include "paper/object_set.hpp"

#include <gtest/gtest.h>

namespace deltalux {
using namespace paper;

namespace {

ObjectSet of(std::uint32_t object) {
  ObjectSet one;
  one.add(ObjectId(object));
  return one;
}

/// As many as the rays of a row meet in a large scene.
TEST(ObjectSet, HoldsWhatItWasGivenAndLittleElse) {
  std::size_t others = 0, wrong = 0;
  for (std::uint32_t set = 0; set < 50; ++set) {
    ObjectSet members;
    for (std::uint32_t k = 0; k < 100; ++k) members.add(ObjectId(set + 97 * k));
    for (std::uint32_t object = 0; object < 9700; ++object) {
      const bool member = object % 97 == set % 97 && object >= set;
      if (member)
        EXPECT_TRUE(members.holds(of(object)));
      else
        ++others, wrong += members.holds(of(object));
    }
  }
  EXPECT_LT(static_cast<double>(wrong), 0.02 * static_cast<double>(others));
}

}  // namespace
}  // namespace deltalux
