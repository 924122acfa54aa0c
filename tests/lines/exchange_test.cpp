// Rows of exchange: closed rooms sum to one, reciprocity, what both ends of a line say of each other; and rows that
// follow a change are those of the new lines, to the last bit.
#include "lines/exchange.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <numeric>

#include "lines/iterate.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"
#include "support/traced_room.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A solution over lines, and the exchange of its leaves.
struct Exchanged {
  explicit Exchanged(Scene scene) : view(solve(std::move(scene))), leaves(view.get().elements) {
    const Solution& s = view.get();
    responses.emplace(s.scene, true);
    tracer.emplace(s.scene, *s.tracer, *responses);
    std::vector<std::uint32_t> covered(leaves.size(), 0);
    for (std::size_t i = 0; i < leaves.size(); ++i)
      for (std::uint64_t k = s.lines.first[i]; k < s.lines.first[i + 1]; ++k)
        covered[i] += s.lines.end[k] == lines::kCovered;
    exchange.emplace(s.lines, s.elements, leaves, *tracer, covered);
  }
  static SolutionView solve(Scene scene) {
    SolveSettings settings;
    Engine engine(std::move(scene), settings);
    engine.solve();
    return engine.solution();
  }

  SolutionView view;
  hierarchy::LeafTable leaves;
  std::optional<lines::SurfaceResponses> responses;
  std::optional<lines::LineTracer> tracer;
  std::optional<lines::Exchange> exchange;
};

Scene closedRoom() {
  Scene scene;
  addBox(scene, addMaterial(scene, "wall", lambert(0.5f)), Vec3(0), {3, 2, 1.5}, true);
  addBox(scene, addMaterial(scene, "block", lambert(0.7f)), {1, 0.5, 0}, {1.5, 1, 0.7}, false);
  addLight(scene, PointLight{{0.5, 1, 1.2}, Rgb(1.0f)});
  return scene;
}

TEST(Exchange, RowsOfAClosedRoomSumToOne) {
  Exchanged x(closedRoom());
  const std::vector<Rgb> one(x.leaves.size(), Rgb(1.0f));
  std::vector<Rgb> E(x.leaves.size());
  x.exchange->gather(one, E);
  for (std::size_t i = 0; i < E.size(); ++i) {
    if (!(x.exchange->closed(i) > 0)) continue;  // the outside
    EXPECT_NEAR(x.exchange->closed(i), 1, 1e-5) << i;
    EXPECT_LT(E[i].g, 1 + 1e-5) << i;
    EXPECT_GT(E[i].g, 0.98) << i;
  }
}

TEST(Exchange, IsReciprocal) {
  Exchanged x(closedRoom());
  // <f, X g> = <g, X f>, weighted by area.
  std::vector<Rgb> f(x.leaves.size()), g(x.leaves.size()), Xf(x.leaves.size()), Xg(x.leaves.size());
  for (std::size_t i = 0; i < f.size(); ++i)
    f[i] = Rgb(toUnitFloat(mix64(i))), g[i] = Rgb(toUnitFloat(mix64(i + 1000000)));
  x.exchange->gather(f, Xf), x.exchange->gather(g, Xg);
  double forth = 0, back = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    forth += double(x.exchange->area(i)) * g[i].g * Xf[i].g;
    back += double(x.exchange->area(i)) * f[i].g * Xg[i].g;
  }
  EXPECT_NEAR(forth / back, 1, 1e-4);
}

TEST(Exchange, WhatIsSentArrives) {
  Exchanged x(closedRoom());
  std::vector<double> share(x.leaves.size());
  x.exchange->arriving(share);
  for (std::size_t i = 0; i < share.size(); ++i) {
    const bool inside = x.exchange->closed(i) > 0;
    EXPECT_NEAR(share[i], inside ? 1 : 0, 0.02) << i;
  }
}

TEST(Iterate, ReachesTheSumOfTheGeometricSeries) {
  Exchanged x(closedRoom());
  lines::LeafLight light = lines::leafLight(x.view.get().elements, x.leaves);
  for (std::size_t i = 0; i < x.leaves.size(); ++i) {
    light.source[i] = Rgb(x.exchange->closed(i) > 0 ? 1.0f : 0.0f);
    light.rho[i] = Rgb(0.5f);
  }
  const lines::IterationReport report = lines::iterate(*x.exchange, light, 1e-6, 1000);
  EXPECT_LT(report.passes, 60);
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < x.leaves.size(); ++i) {
    if (!(x.exchange->closed(i) > 0)) continue;
    sum += double(x.exchange->area(i)) * light.indirect[i].g, area += x.exchange->area(i);
  }
  EXPECT_NEAR(sum / area, 1, 2e-3);  // rho / (1 - rho)
}

/// Of leaves, by chance [W/m2].
std::vector<Rgb> randomLight(std::size_t leaves, std::uint64_t seed) {
  std::vector<Rgb> B;
  Rng random(seed);
  for (std::size_t i = 0; i < leaves; ++i) {
    const auto r = static_cast<float>(random.uniform()), g = static_cast<float>(random.uniform());
    B.emplace_back(r, g, static_cast<float>(random.uniform()));
  }
  return B;
}

void expectSame(lines::Exchange& a, lines::Exchange& b) {
  ASSERT_EQ(a.leaves(), b.leaves());
  const std::size_t n = a.leaves();
  const std::vector<Rgb> B = randomLight(n, 3);
  std::vector<Rgb> Ea(n), Eb(n);
  a.gather(B, Ea), b.gather(B, Eb);
  EXPECT_EQ(Ea, Eb);
  EXPECT_GT(std::ranges::count_if(Ea, [](const Rgb& E) { return !isBlack(E); }), static_cast<std::ptrdiff_t>(n / 8));
  std::vector<double> arrivingA(n), arrivingB(n);
  a.arriving(arrivingA), b.arriving(arrivingB);
  EXPECT_EQ(arrivingA, arrivingB);
  std::vector<float> sigmaA(n), sigmaB(n);
  a.deviation(B, sigmaA), b.deviation(B, sigmaB);
  EXPECT_EQ(sigmaA, sigmaB);
  for (std::size_t i = 0; i < n; ++i) ASSERT_TRUE(a.area(i) == b.area(i) && a.closed(i) == b.closed(i)) << i;
}

lines::Exchange exchangeOf(const TracedRoom& room, const lines::TracedLines& traced) {
  return {traced.lines, room.elements, room.leaves, room.tracer, traced.covered};
}

void expectToFollow(const RoomChange& x) {
  const lines::TracedLines now = x.after.trace(x.countsAfter, &x.known);
  const lines::Exchange before = exchangeOf(x.before, x.tracedBefore);
  lines::Exchange followed(before, x.known, now.lines, x.after.elements, x.after.leaves, x.after.tracer, now.covered);
  lines::Exchange anew = exchangeOf(x.after, now);
  expectSame(followed, anew);
}

const Vec3 kBy(-0.4, 0.35, 0);

class ExchangeOfAThing : public testing::TestWithParam<int> {};

TEST_P(ExchangeOfAThing, FollowsItsMove) {
  expectToFollow({GetParam(), kBy, {}, {}, false});
  expectToFollow({GetParam(), kBy, {}, {2, 0, true}, false});  // leaves get other numbers
}

TEST_P(ExchangeOfAThing, FollowsItsMoveToAnotherMesh) {
  expectToFollow({GetParam(), kBy, {2, 5, false}, {2, 6, true}, false});
}

TEST_P(ExchangeOfAThing, FollowsNumbersOfLines) {
  expectToFollow({GetParam(), kBy, {}, {}, true});
  expectToFollow({GetParam(), kBy, {2, 5, true}, {2, 6, false}, true});
}

INSTANTIATE_TEST_SUITE_P(Each, ExchangeOfAThing, testing::Range(0, RoomOfThings::kThings + 1));

TEST(Exchange, FollowsOneChangeAfterTheOther) {
  // The box goes to and fro, and the mesh is another each time.
  std::optional<lines::Exchange> followed;
  std::unique_ptr<TracedRoom> before;
  RoomOfThings then;
  lines::TracedLines tracedBefore;
  for (int step = 0; step < 5; ++step) {
    const RoomOfThings now(0, double(step) * Vec3(-0.2, 0.1, 0.05));
    const auto seed = static_cast<std::uint64_t>(step);
    auto after = std::make_unique<TracedRoom>(now.scene, MeshOfRoom{2, seed % 3, step % 2 == 1});
    const std::vector<std::uint32_t> counts = after->counts(24, seed / 2);
    if (!followed) {
      tracedBefore = after->trace(counts);
      followed.emplace(exchangeOf(*after, tracedBefore));
    } else {
      const change::MovedSpace space(now.scene, movedThing(then, now, 0));
      const lines::KnownLines known =
          change::knownLines(space, tracedBefore, leavesBefore(*before, *after, space), after->elements, after->leaves);
      tracedBefore = after->trace(counts, &known);
      followed.emplace(lines::Exchange(*followed, known, tracedBefore.lines, after->elements, after->leaves,
                                       after->tracer, tracedBefore.covered));
      lines::Exchange anew = exchangeOf(*after, tracedBefore);
      expectSame(*followed, anew);
    }
    before = std::move(after), then = now;
  }
}

TEST(Exchange, FollowsPairsOfMoreLinesThanAnEntryHolds) {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  addPolygon(scene, white, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  addPolygon(scene, white, {{0, 0, 0.1}, {0, 1, 0.1}, {1, 1, 0.1}, {1, 0, 0.1}});
  const TracedRoom room(scene, {.levels = 0});
  std::vector<std::uint32_t> of(room.leaves.size());
  std::iota(of.begin(), of.end(), 0u);
  lines::TracedLines before = room.trace(std::vector<std::uint32_t>(room.leaves.size(), 40000));
  const lines::Exchange rows = exchangeOf(room, before);
  for (const std::uint32_t count : {100u, 40000u, 90000u}) {
    const lines::KnownLines known = change::knownLines({}, before, of, room.elements, room.leaves);
    const lines::TracedLines now = room.trace(std::vector<std::uint32_t>(room.leaves.size(), count), &known);
    lines::Exchange followed(rows, known, now.lines, room.elements, room.leaves, room.tracer, now.covered);
    lines::Exchange anew = exchangeOf(room, now);
    expectSame(followed, anew);
  }
}

/// Lines that end by chance: a few of them exceptional, one of four leaves nowhere seen.
lines::TracedLines randomLines(const TracedRoom& room, Rng& random) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::uint32_t>(random.uniform() * static_cast<double>(n));
  };
  const std::size_t n = room.leaves.size();
  lines::TracedLines t;
  t.lines.first.resize(n + 1);
  t.lines.first[0] = 0;
  for (std::size_t i = 0; i < n; ++i) t.lines.first[i + 1] = t.lines.first[i] + below(40);
  t.lines.end.resize(t.lines.size()), t.lines.code.resize(t.lines.size());
  t.covered.assign(n, 0);
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint64_t k = t.lines.first[i]; k < t.lines.first[i + 1]; ++k) {
      const double what = random.uniform();
      const std::uint32_t end = below(n / 4) * 4 + below(3);
      t.lines.end[k] = what < 0.8 ? end : what < 0.9 ? lines::kException : what < 0.95 ? lines::kCovered : lines::kLost;
      t.covered[i] += t.lines.end[k] == lines::kCovered;
      if (t.lines.end[k] == lines::kException)
        t.lines.exceptions.push_back({k, i, end, Rgb(0.5f), what < 0.87, what < 0.85, what < 0.83});
    }
  return t;
}

TEST(Exchange, FollowsWhateverLinesThereAre) {
  // A change that leaves nothing as it was but some lines by chance; leaves come, go, and get other numbers.
  const TracedRoom room(RoomOfThings().scene, {});
  constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
  const auto n = static_cast<std::uint32_t>(room.leaves.size());
  Rng random(9);
  for (int round = 0; round < 4; ++round) {
    const lines::TracedLines before = randomLines(room, random);
    const lines::Exchange rows = exchangeOf(room, before);
    // The numbers of sides that send or do not are theirs, so pairs of leaves of a surface change places.
    std::vector<std::uint32_t> of(n);
    std::iota(of.begin(), of.end(), 0u);
    for (std::uint32_t i = 0; i + 1 < n; i += 2)
      if (random.uniform() < 0.5 && room.elements.sideOf(room.leaves[i]) == room.elements.sideOf(room.leaves[i + 1]))
        std::swap(of[i], of[i + 1]);
    for (std::uint32_t& o : of)
      if (random.uniform() < 0.1) o = kNone;
    const lines::KnownLines known = change::knownLines({}, before, of, room.elements, room.leaves);
    lines::TracedLines now = randomLines(room, random);
    for (std::uint32_t i = 0; i < n; ++i) {
      if (of[i] == kNone) continue;
      for (std::uint32_t k = 0; k < std::min(now.lines.countOf(i), known.lines.countOf(of[i])); ++k) {
        std::uint32_t& end = now.lines.end[now.lines.first[i] + k];
        const std::uint32_t held = known.lines.end[known.lines.first[of[i]] + k];
        if (end != lines::kException && end != lines::kCovered && !lines::KnownLines::isAgain(held) &&
            held < lines::kFirstMark && random.uniform() < 0.7)
          end = held;
      }
    }
    lines::Exchange followed(rows, known, now.lines, room.elements, room.leaves, room.tracer, now.covered);
    lines::Exchange anew = exchangeOf(room, now);
    expectSame(followed, anew);
  }
}

}  // namespace
}  // namespace deltalux
