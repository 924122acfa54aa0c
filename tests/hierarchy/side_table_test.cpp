// Elements by the sides that they stand for.
#include "hierarchy/side_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "base/random.hpp"
#include "hierarchy/element.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

TEST(SideTable, FindsWhatWasAddedInAnyOrder) {
  std::vector<Side> sides;
  for (std::uint32_t p = 0; p < 40; ++p)
    for (std::uint32_t t = 0; t < p % 7 + 1; ++t)
      for (const bool front : {true, false}) sides.push_back({PrimitiveId(p), t, front});
  std::vector<Side> added = sides;
  Rng rng(5);
  for (std::size_t i = added.size(); i-- > 1;)
    std::swap(added[i], added[static_cast<std::size_t>(rng.uniform() * static_cast<double>(i + 1))]);
  added.resize(added.size() * 2 / 3);
  SideTable<ElementId> table;
  std::map<Side, ElementId> expected;
  for (std::size_t i = 0; i < added.size(); ++i) {
    table.add(added[i]) = ElementId(i);
    expected[added[i]] = ElementId(i);
  }
  for (const Side& s : sides)
    EXPECT_EQ(table.at(s), expected.contains(s) ? expected[s] : ElementId()) << s.primitive.value << ' ' << s.triangle;
  EXPECT_FALSE(table.at({PrimitiveId(1000), 0, true}).valid());
  EXPECT_FALSE(table.at({PrimitiveId(0), 1000, false}).valid());
  for (std::uint32_t p = 0; p < 40; ++p) {
    std::vector<ElementId> found, wanted;
    table.forEachOf(PrimitiveId(p), [&](ElementId e) { found.push_back(e); });
    for (const auto& [side, element] : expected)
      if (side.primitive == PrimitiveId(p)) wanted.push_back(element);
    EXPECT_EQ(found, wanted);  // both by triangle, fronts first
  }
}

}  // namespace
}  // namespace deltalux
