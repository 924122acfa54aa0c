// Every public header stands alone and together.
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/progress.hpp>
#include <gtest/gtest.h>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {
namespace {

TEST(InputError, SaysFileLineAndWhatToDo) {
  EXPECT_STREQ(InputError("a.rad", 3, "unknown type", "use polygon").what(), "a.rad:3: unknown type (use polygon)");
  EXPECT_STREQ(InputError("a.rad", 0, "not found").what(), "a.rad: not found");
}

TEST(Check, ThrowsWithItsExpression) {
  EXPECT_THROW(DELTALUX_CHECK(1 > 2, "never"), std::logic_error);
  EXPECT_NO_THROW(DELTALUX_CHECK(2 > 1, ""));
}

TEST(ParallelSum, DoesNotDependOnThreads) {
  const auto sum = [](std::size_t threads) {
    const ThreadLimit limit(threads);
    return parallelSum<float>(100000, 64, [](std::size_t i) { return 1.0f / static_cast<float>(i + 1); });
  };
  EXPECT_EQ(sum(1), sum(2));
  EXPECT_EQ(sum(1), sum(4));
}

}  // namespace
}  // namespace deltalux
