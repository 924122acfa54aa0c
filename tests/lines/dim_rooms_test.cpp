// More lines where hardly any light comes: as many as make enough of them lead out, and no end of them nowhere.
#include "lines/dim_rooms.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "lines/own_light.hpp"

namespace deltalux {
namespace {

using lines::TracedLines;

/// Leaves of so many lines each, which end where `end(leaf, line)` says; leaf by leaf an element.
template <class End>
TracedLines traced(std::uint32_t leaves, std::uint32_t each, const End& end) {
  TracedLines t;
  t.resize(leaves);
  for (std::uint32_t i = 0; i < leaves; ++i) {
    t.lines.of[i] = {std::uint64_t(i) * each, each, 0};
    for (std::uint32_t k = 0; k < each; ++k) t.lines.end.push_back(end(i, k)), t.lines.code.push_back({});
  }
  return t;
}

hierarchy::LeafTable tableOf(const TracedLines& t) {
  hierarchy::LeafTable leaves;
  for (std::uint32_t i = 0; i < t.lines.of.size(); ++i) leaves.leaves.emplace_back(i), leaves.indexOf.push_back(i);
  return leaves;
}

std::vector<std::uint32_t> allOf(const TracedLines& t) {
  std::vector<std::uint32_t> counts;
  for (const lines::LineRange& r : t.lines.of) counts.push_back(r.count);
  return counts;
}

constexpr std::uint32_t kEach = 128;
constexpr double kFloor = 1;

/// Ten leaves of a lit room, ten of a dark one; of the first dark leaf so many lines lead out.
TracedLines twoRooms(std::uint32_t ways) {
  return traced(20, kEach, [&](std::uint32_t i, std::uint32_t k) {
    if (i == 10 && k < ways) return k % 10;
    return i < 10 ? k % 10 : 10 + (k + i) % 10;
  });
}

lines::DimCounts countsOf(const TracedLines& t) {
  std::vector<float> area(20, 1.0f), light(20, 50.0f);
  std::fill(light.begin() + 10, light.end(), 0.01f);
  const std::vector<lines::Place> places = lines::placesOf(light, kFloor, std::vector<char>(20, 1));
  const hierarchy::LeafTable leaves = tableOf(t);
  const std::vector<std::uint32_t> counts = allOf(t);
  return lines::dimCounts(t, leaves, counts, std::accumulate(counts.begin(), counts.end(), 0.0), area, places,
                          lines::waysInto(t.lines, leaves, counts, places), false);
}

double sum(const std::vector<std::uint32_t>& counts) { return std::accumulate(counts.begin(), counts.end(), 0.0); }

TEST(DimRooms, GetLinesUntilEnoughLeadOut) {
  const lines::DimCounts few = countsOf(twoRooms(4)), more = countsOf(twoRooms(40));
  EXPECT_EQ(sum({few.lines.begin(), few.lines.begin() + 10}), 0);
  EXPECT_TRUE(few.told);
  // 4 of 1280 lead out: a hundred times as many lines, in octaves.
  EXPECT_GT(sum(few.lines), 0.5 * 1280 * 100);
  EXPECT_LE(sum(few.lines), 1280 * 100);
  EXPECT_NEAR(sum(few.lines) / sum(more.lines), 10, 7);
  EXPECT_EQ(sum(countsOf(twoRooms(120)).lines), sum(countsOf(twoRooms(128)).lines));
}

TEST(DimRooms, CountAsClosedWhereNothingLeadsOut) {
  const lines::DimCounts none = countsOf(twoRooms(0));
  EXPECT_FALSE(none.told);  // those lines may find some
  EXPECT_GT(sum(none.lines), 1280);
  // So many have found nothing: no more.
  const TracedLines many =
      traced(20, 1 << 15, [](std::uint32_t i, std::uint32_t k) { return i < 10 ? k % 10 : 10 + (k + i) % 10; });
  EXPECT_EQ(sum(countsOf(many).lines), 0);
}

TEST(OwnLight, IsWhatOthersSendButForTheBrightestLine) {
  // One leaf of eight lines sees a lamp-lit one twice, the other a dark one.
  const TracedLines t = traced(3, 8, [](std::uint32_t i, std::uint32_t k) { return i == 2 && k < 2 ? 0u : 1u; });
  const std::vector<float> rho(3, 0.5f), source{80, 0, 0};
  const std::vector<float> light = lines::ownIndirect(t.lines, tableOf(t), allOf(t), rho, source);
  EXPECT_NEAR(light[2], 80 * 0.5 / 8, 1e-4);  // of two such lines one counts
  EXPECT_NEAR(light[1], 0, 1e-6);
}

TEST(OwnLight, IsOfTheFirstLinesThatAreAskedFor) {
  const TracedLines t = traced(3, 8, [](std::uint32_t i, std::uint32_t k) { return i == 2 && k < 2 ? 0u : 1u; });
  const std::vector<float> rho(3, 0.5f), source{80, 0, 0};
  const std::vector<float> light =
      lines::ownIndirect(t.lines, tableOf(t), std::vector<std::uint32_t>(3, 4), rho, source);
  EXPECT_NEAR(light[2], 80 * 0.5 / 4, 1e-4);
}

}  // namespace
}  // namespace deltalux
