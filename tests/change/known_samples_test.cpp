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

/// Of these leaves.
void expectSame(const TracedLines& a, const TracedLines& b, const hierarchy::LeafTable& leaves) {
  for (const hierarchy::ElementId leaf : leaves.leaves) {
    ASSERT_TRUE(std::ranges::equal(a.lines.endsOf(leaf), b.lines.endsOf(leaf)));
    ASSERT_EQ(a.lines.at(leaf).covered, b.lines.at(leaf).covered);
    ASSERT_TRUE(std::ranges::equal(a.lines.codesOf(leaf), b.lines.codesOf(leaf), same));
    ASSERT_TRUE(std::ranges::equal(a.lines.exceptions.at(leaf), b.lines.exceptions.at(leaf),
                                   [](const lines::ExceptionalLine& x, const lines::ExceptionalLine& y) {
                                     return x.number == y.number && x.end == y.end && x.weight == y.weight &&
                                            x.turned == y.turned && x.rough == y.rough && x.beyond == y.beyond;
                                   }));
    ASSERT_TRUE(std::ranges::equal(
        a.escaped.at(leaf), b.escaped.at(leaf), [](const lines::EscapedLine& x, const lines::EscapedLine& y) {
          return x.direction == y.direction && x.cosine == y.cosine && x.weight == y.weight && x.chance == y.chance;
        }));
    ASSERT_TRUE(std::ranges::equal(a.bends.at(leaf), b.bends.at(leaf), [](const lines::Bend& x, const lines::Bend& y) {
      return x.number == y.number && x.from == y.from && same(x.code, y.code);
    }));
  }
}

/// Traces the room after a change with what is known, and without; returns the share of rays that were asked again.
double expectTheSameFromKnown(const RoomChange& x) {
  const TracedLines fresh = x.after.trace(x.countsAfter), taken = x.taken();
  EXPECT_GT(fresh.lines.exceptions.all.size(), 100u);
  EXPECT_GT(fresh.escaped.all.size(), 100u);
  EXPECT_GT(fresh.bends.all.size(), 100u);
  EXPECT_GT(std::ranges::count(fresh.lines.end, lines::kCovered), 100);
  EXPECT_NO_THROW(lines::validate(taken.lines));
  expectSame(taken, fresh, x.after.leaves);
  TracedLines tidied = taken;
  lines::tidy(tidied);
  EXPECT_LE(tidied.lines.end.size(), taken.lines.end.size());
  expectSame(tidied, fresh, x.after.leaves);
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
  const lines::Lines &all = x.tracedBefore.lines, &marks = x.marked.lines;
  std::size_t again = 0, start = 0, end = 0, pass = 0, bent = 0, cutElsewhere = 0;
  for (const hierarchy::ElementId leaf : x.before.leaves.leaves) {
    const std::uint32_t stands = x.elementNow[leaf.index()];
    const hierarchy::LeafSequence points(x.before.elements, x.before.scene, leaf);
    lines::LineDirections directions(points.key());
    const bool starts = x.space.moved(x.before.elements.domain[leaf.index()].primitive), gone = stands == kNone;
    EXPECT_TRUE(gone || !starts);
    cutElsewhere += gone && !starts;  // at the foot of what has moved
    bool whole = true;
    for (std::uint32_t k = 0; k < all.countOf(leaf); ++k) {
      const bool marked = gone || KnownLines::isAgain(marks.endsOf(x.known.before[stands])[k]);
      again += marked, whole = whole && !marked;
      start += starts;
      if (all.endsOf(leaf)[k] == lines::kCovered) continue;
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
    if (!gone) {
      EXPECT_EQ(whole, x.known.whole[stands] != 0);
    }
  }
  const bool ends = GetParam() != kPane && GetParam() != kBall;  // nothing starts or ends on glass
  EXPECT_EQ(start > 100, ends);
  EXPECT_EQ(end > 20, ends);
  EXPECT_GT(pass, 100u);
  EXPECT_LT(cutElsewhere, x.before.leaves.size() / 20);
  EXPECT_GT(bent, 2u);
  EXPECT_LT(again, 0.7 * static_cast<double>(all.size()));
}

INSTANTIATE_TEST_SUITE_P(Each, MarkedLinesOfAThing, testing::Range(0, RoomOfThings::kThings));

TEST(KnownLines, TellWhereLinesEndedThatAreTracedAgain) {
  const RoomChange x(kBox, kBy, {}, {2, 0, true}, false);
  const lines::Lines& all = x.tracedBefore.lines;
  std::size_t told = 0;
  for (const hierarchy::ElementId leaf : x.before.leaves.leaves) {
    const std::uint32_t stands = x.elementNow[leaf.index()];
    if (stands == kNone) continue;
    const std::span<const std::uint32_t> before = all.endsOf(leaf),
                                         marked = x.marked.lines.endsOf(x.known.before[stands]);
    ASSERT_EQ(before.size(), marked.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_EQ(KnownLines::leafOf(marked[k]), before[k] < lines::kFirstMark ? x.elementNow[before[k]] : kNone) << k;
      told += KnownLines::isAgain(marked[k]) && KnownLines::leafOf(marked[k]) != kNone;
    }
  }
  EXPECT_GT(told, 100u);
}

TEST(TraceLines, GoOnFromThoseThereAre) {
  // Some leaves get more, once and again, and fewer in the end.
  const TracedRoom room(RoomOfThings().scene, {});
  std::vector<std::uint32_t> counts = room.counts(24, 1);
  TracedLines further = room.trace(counts);
  const std::uint64_t rays = further.rays;
  for (const std::uint64_t seed : {2u, 3u}) {
    std::vector<std::uint32_t> more = counts;
    for (std::size_t i = 0; i < more.size(); i += seed) more[i] *= 4;
    lines::traceLines({room.elements, room.leaves, room.locator, room.tracer, room.cover, room.enclosed}, more,
                      further);
  }
  for (std::size_t i = 0; i < counts.size(); i += 5) counts[i] = i % 2 == 0 ? 0 : counts[i] / 2 + 3;
  for (std::size_t i = 0; i < counts.size(); i += 6) counts[i] *= 4;
  lines::trim(room.leaves, counts, further);
  EXPECT_NO_THROW(lines::validate(further.lines));
  EXPECT_GT(further.rays, 2 * rays);
  expectSame(further, room.trace(counts), room.leaves);
}

}  // namespace
}  // namespace deltalux
