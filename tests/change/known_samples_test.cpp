// Lines that are taken from before a change are those that are traced after it; and what a change may touch is marked.
#include "change/known_samples.hpp"

#include <gtest/gtest.h>

#include "support/traced_room.hpp"

namespace deltalux {
namespace {

using namespace test;
using lines::KnownLines;
using lines::TracedLines;

constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
constexpr int kBox = 0, kPane = 2, kBall = 5, kNothing = RoomOfThings::kThings;
const Vec3 kBy(-0.4, 0.35, 0);

bool same(lines::LineCode a, lines::LineCode b) { return a.x == b.x && a.y == b.y && a.reach == b.reach; }

void expectSame(const TracedLines& a, const TracedLines& b) {
  EXPECT_EQ(a.lines.first, b.lines.first);
  EXPECT_EQ(a.lines.end, b.lines.end);
  EXPECT_EQ(a.covered, b.covered);
  for (std::size_t k = 0; k < a.lines.size(); ++k) ASSERT_TRUE(same(a.lines.code[k], b.lines.code[k])) << k;
  ASSERT_EQ(a.lines.exceptions.size(), b.lines.exceptions.size());
  for (std::size_t k = 0; k < a.lines.exceptions.size(); ++k) {
    const lines::ExceptionalLine &x = a.lines.exceptions[k], &y = b.lines.exceptions[k];
    ASSERT_TRUE(x.line == y.line && x.leaf == y.leaf && x.end == y.end && x.weight == y.weight) << k;
    ASSERT_TRUE(x.turned == y.turned && x.rough == y.rough && x.beyond == y.beyond) << k;
  }
  ASSERT_EQ(a.escaped.size(), b.escaped.size());
  for (std::size_t k = 0; k < a.escaped.size(); ++k) {
    const lines::EscapedLine &x = a.escaped[k], &y = b.escaped[k];
    ASSERT_TRUE(x.leaf == y.leaf && x.direction == y.direction && x.cosine == y.cosine && x.weight == y.weight &&
                x.chance == y.chance)
        << k;
  }
  ASSERT_EQ(a.bends.size(), b.bends.size());
  for (std::size_t k = 0; k < a.bends.size(); ++k) {
    const lines::Bend &x = a.bends[k], &y = b.bends[k];
    ASSERT_TRUE(x.leaf == y.leaf && x.number == y.number && x.from == y.from && same(x.code, y.code)) << k;
  }
}

/// Traces the room after a change with what is known, and without; returns the share of rays that were asked again.
double expectTheSameFromKnown(const RoomChange& x) {
  const TracedLines fresh = x.after.trace(x.countsAfter), taken = x.after.trace(x.countsAfter, &x.known);
  EXPECT_GT(fresh.lines.exceptions.size(), 100u);
  EXPECT_GT(fresh.escaped.size(), 100u);
  EXPECT_GT(fresh.bends.size(), 100u);
  EXPECT_GT(std::ranges::count(fresh.lines.end, lines::kCovered), 100);
  expectSame(taken, fresh);
  return static_cast<double>(taken.rays) / static_cast<double>(fresh.rays);
}

class KnownLinesOfAThing : public testing::TestWithParam<int> {};

TEST_P(KnownLinesOfAThing, AreTheLinesThatAreTracedAfterItsMove) {
  const double asked = expectTheSameFromKnown({GetParam(), kBy, {}, {}, false});
  EXPECT_GT(asked, 0.02);
  EXPECT_LT(asked, 0.7);
}

TEST_P(KnownLinesOfAThing, AreThoseOfAnotherMeshAndOtherNumbersToo) {
  EXPECT_LT(expectTheSameFromKnown({GetParam(), kBy, {2, 5, false}, {2, 6, true}, true}), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Each, KnownLinesOfAThing, testing::Range(0, RoomOfThings::kThings));

TEST(KnownLines, AreAllThereWhereNothingMoves) {
  EXPECT_EQ(expectTheSameFromKnown({kNothing, kBy, {}, {}, false}), 0);
  EXPECT_EQ(expectTheSameFromKnown({kNothing, kBy, {}, {2, 0, true}, false}), 0);  // other numbers of leaves
  const RoomChange finer(kNothing, kBy, {}, {2, 5, false}, false);
  const double asked = expectTheSameFromKnown(finer);
  EXPECT_GT(asked, 0.2);  // of parts, and of lines that ended on what they are parts of
  EXPECT_LT(asked, 0.7);
}

/// Whether a segment meets a box.
bool meets(const Vec3& from, const Vec3& to, const Box& box) {
  double begin = 0, end = 1;
  for (int axis = 0; axis < 3; ++axis) {
    double near = (box.lower[axis] - from[axis]) / (to[axis] - from[axis]);
    double far = (box.upper[axis] - from[axis]) / (to[axis] - from[axis]);
    if (near > far) std::swap(near, far);
    begin = std::max(begin, near), end = std::min(end, far);
  }
  return begin <= end;
}

class MarkedLinesOfAThing : public testing::TestWithParam<int> {};

TEST_P(MarkedLinesOfAThing, AreAllThatStartThereEndThereOrPassByIt) {
  const RoomOfThings then, now(GetParam(), kBy);
  const RoomChange x(GetParam(), kBy, {}, {}, false);
  const std::vector<SceneChange::Moved> moved = movedThing(then, now, GetParam());
  const auto touched = [&](const Vec3& from, const Vec3& to) {
    return std::ranges::any_of(
        moved, [&](const SceneChange::Moved& m) { return meets(from, to, m.before) || meets(from, to, m.after); });
  };
  const lines::Lines& all = x.tracedBefore.lines;
  std::size_t again = 0, start = 0, end = 0, pass = 0, bent = 0, cutElsewhere = 0;
  for (std::uint32_t i = 0; i < all.leaves(); ++i) {
    const hierarchy::ElementId leaf = x.before.leaves[i];
    const hierarchy::LeafSequence points(x.before.elements, x.before.scene, leaf);
    lines::LineDirections directions(points.key());
    const bool starts = x.space.moved(x.before.elements.domain[leaf.index()].primitive), gone = x.known.now[i] == kNone;
    EXPECT_TRUE(gone || !starts);
    cutElsewhere += gone && !starts;  // at the foot of what has moved
    bool whole = true;
    for (std::uint32_t k = 0; k < all.countOf(i); ++k) {
      const std::uint64_t line = all.first[i] + k;
      const bool marked = KnownLines::isAgain(x.known.lines.end[line]);
      again += marked, whole = whole && !marked;
      start += starts;
      EXPECT_TRUE(marked || !gone);
      if (all.end[line] == lines::kCovered) continue;
      const hierarchy::PatchPoint p = points.point(k);
      std::vector<lines::LineSegment> way;
      const lines::LineEnd to = x.before.tracer.follow(p.position, p.normal, directions(k, p.normal),
                                                       lines::LineDirections::random(points.key(), k), &way);
      if (to.termination == lines::LineTermination::Ended && x.space.moved(to.side.primitive)) {
        ++end;
        EXPECT_TRUE(marked);
      }
      for (std::size_t s = 0; s < way.size(); ++s) {
        const Vec3 from(way[s].from), there = from + double(std::min(way[s].length, 20.0f)) * Vec3(way[s].direction);
        if (!touched(from, there)) continue;
        ++pass, bent += way[s].direction != way[0].direction;
        EXPECT_TRUE(marked);
      }
    }
    EXPECT_EQ(whole, x.known.whole[i] != 0) << i;
  }
  const bool ends = GetParam() != kPane && GetParam() != kBall;  // nothing starts or ends on glass
  EXPECT_EQ(start > 100, ends);
  EXPECT_EQ(end > 20, ends);
  EXPECT_GT(pass, 100u);
  EXPECT_LT(cutElsewhere, all.leaves() / 20);
  EXPECT_GT(bent, 2u);
  EXPECT_LT(again, 0.7 * static_cast<double>(all.size()));
}

INSTANTIATE_TEST_SUITE_P(Each, MarkedLinesOfAThing, testing::Range(0, RoomOfThings::kThings));

TEST(KnownLines, TellWhereLinesEndedThatAreTracedAgain) {
  const RoomChange x(kBox, kBy, {}, {2, 0, true}, false);
  const lines::Lines& all = x.tracedBefore.lines;
  for (std::uint64_t k = 0; k < all.size(); ++k) {
    const bool straight = all.end[k] < lines::kFirstMark;
    EXPECT_EQ(KnownLines::leafOf(x.known.lines.end[k]), straight ? x.known.now[all.end[k]] : kNone) << k;
  }
  for (std::uint32_t i = 0; i < x.known.of.size(); ++i)
    if (x.known.of[i] != kNone) {
      EXPECT_EQ(x.known.now[x.known.of[i]], i);
    }
}

}  // namespace
}  // namespace deltalux
