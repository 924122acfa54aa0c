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
    exchange.emplace(s.lines, s.elements, leaves, *tracer);
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

/// A room full of copper, whose few lines that end on it say less of the light there than those that it reflects.
Scene copperRoom() {
  Scene scene;
  Opaque copper = lambert(0.02f);
  copper.specular = SpecularLobe{Rgb(0.95f, 0.5f, 0.3f), 0.0f};
  const MaterialId metal = addMaterial(scene, "copper", copper);
  addBox(scene, metal, Vec3(0), {2, 2, 1}, true);
  addBox(scene, addMaterial(scene, "paint", lambert(0.8f)), {0.8, 0.7, 0}, {1.3, 1.2, 0.5}, false);
  addLight(scene, PointLight{{0.4, 0.5, 0.8}, Rgb(1.0f)});
  return scene;
}

TEST(Exchange, ReturnsNoMoreThanItGetsToWhatStandsAmongMirrors) {
  Exchanged x(copperRoom());
  const std::size_t n = x.leaves.size();
  const std::vector<Rgb> one(n, Rgb(1.0f)), returned(n, Rgb(0.8f));
  std::vector<Rgb> free(n), bounded(n);
  x.exchange->gather(one, free);
  x.exchange->bound(returned);
  x.exchange->gather(one, bounded);
  std::size_t exceeding = 0;
  for (std::size_t i = 0; i < n; ++i) {
    exceeding += 0.8f * maxChannel(free[i]) > 0.9f;
    EXPECT_LE(0.8f * maxChannel(bounded[i]), 0.9f + 1e-4f) << i;
    for (int c = 0; c < 3; ++c) EXPECT_LE(bounded[i][c], free[i][c]) << i;
    EXPECT_GE(bounded[i].b, std::min(free[i].b, 1.0f)) << "blue is hardly reflected: " << i;
  }
  EXPECT_GT(exceeding, n / 50);
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

/// Within what an update leaves to be the same, some times that.
void expectSame(lines::Exchange& a, lines::Exchange& b) {
  constexpr float kSame = 5 * lines::kFollowed;
  ASSERT_EQ(a.leaves(), b.leaves());
  const std::size_t n = a.leaves();
  const std::vector<Rgb> B = randomLight(n, 3);
  std::vector<Rgb> Ea(n), Eb(n);
  a.gather(B, Ea), b.gather(B, Eb);
  EXPECT_GT(std::ranges::count_if(Ea, [](const Rgb& E) { return !isBlack(E); }), static_cast<std::ptrdiff_t>(n / 8));
  std::vector<double> arrivingA(n), arrivingB(n);
  a.arriving(arrivingA), b.arriving(arrivingB);
  std::vector<float> sigmaA(n), sigmaB(n);
  a.deviation(B, sigmaA), b.deviation(B, sigmaB);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(a.area(i), b.area(i)) << i;
    ASSERT_NEAR(a.closed(i), b.closed(i), 1e-5) << i;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(Ea[i][c], Eb[i][c], kSame * Eb[i][c]) << i;
    ASSERT_NEAR(arrivingA[i], arrivingB[i], kSame * arrivingB[i]) << i;
    ASSERT_NEAR(sigmaA[i], sigmaB[i], kSame * (sigmaB[i] + Eb[i].g)) << i;  // a difference of such
  }
}

lines::Exchange exchangeOf(const TracedRoom& room, const lines::TracedLines& traced) {
  return {traced.lines, room.elements, room.leaves, room.tracer};
}

/// That of before a change, over the lines after it.
lines::Exchange followed(lines::Exchange exchange, std::span<const std::uint32_t> elementsNow,
                         const lines::KnownLines& known, const TracedRoom& room, const lines::TracedLines& now) {
  exchange.renumber(elementsNow, room.elements.size());
  exchange.follow(known, now.lines, room.elements, room.leaves, room.tracer);
  return exchange;
}

void expectToFollow(const RoomChange& x) {
  const lines::TracedLines now = x.taken();
  lines::Exchange following = followed(exchangeOf(x.before, x.tracedBefore), x.elementNow, x.known, x.after, now);
  lines::Exchange whole = exchangeOf(x.after, now);
  expectSame(following, whole);
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
  std::optional<lines::Exchange> following;
  std::unique_ptr<TracedRoom> before;
  RoomOfThings then;
  lines::TracedLines traced;
  for (int step = 0; step < 9; ++step) {
    const RoomOfThings room(0, double(step % 5) * Vec3(-0.2, 0.1, 0.05));
    const auto seed = static_cast<std::uint64_t>(step);
    auto after = std::make_unique<TracedRoom>(room.scene, MeshOfRoom{2, seed % 3, step % 2 == 1});
    const std::vector<std::uint32_t> counts = after->counts(24, seed / 2);
    if (!following) {
      traced = after->trace(counts);
      following.emplace(exchangeOf(*after, traced));
    } else {
      const change::MovedSpace space(room.scene, movedThing(then, room, 0));
      const std::vector<std::uint32_t> now = leavesAfter(*before, *after, space);
      const lines::KnownLines known = knownAfter(space, now, after->elements, traced);
      traced = after->trace(counts, &known, std::move(traced));
      following.emplace(followed(std::move(*following), now, known, *after, traced));
      lines::Exchange whole = exchangeOf(*after, traced);
      expectSame(*following, whole);
    }
    before = std::move(after), then = room;
  }
}

std::vector<std::uint32_t> allStay(const TracedRoom& room) {
  std::vector<std::uint32_t> now(room.elements.size(), hierarchy::LeafTable::kNone);
  for (const hierarchy::ElementId leaf : room.leaves.leaves) now[leaf.index()] = leaf.value;
  return now;
}

TEST(Exchange, FollowsPairsOfMoreLinesThanAnEntryHolds) {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  addPolygon(scene, white, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  addPolygon(scene, white, {{0, 0, 0.1}, {0, 1, 0.1}, {1, 1, 0.1}, {1, 0, 0.1}});
  const TracedRoom room(scene, {.levels = 0});
  const std::vector<std::uint32_t> stay = allStay(room);
  const lines::TracedLines before = room.trace(std::vector<std::uint32_t>(room.leaves.size(), 40000));
  const lines::Exchange rows = exchangeOf(room, before);
  for (const std::uint32_t count : {100u, 40000u, 90000u}) {
    lines::TracedLines marked = before;
    const lines::KnownLines known = knownAfter({}, stay, room.elements, marked);
    const lines::TracedLines now =
        room.trace(std::vector<std::uint32_t>(room.leaves.size(), count), &known, std::move(marked));
    lines::Exchange following = followed(rows, stay, known, room, now), whole = exchangeOf(room, now);
    expectSame(following, whole);
  }
}

/// Gives a leaf lines that end by chance, stored behind all others: a few of them exceptional, one of four leaves
/// nowhere seen. `held`: what most of them end on.
void setRandomLines(const TracedRoom& room, hierarchy::ElementId leaf, std::span<const std::uint32_t> held, Rng& random,
                    lines::TracedLines& t) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::uint32_t>(random.uniform() * static_cast<double>(n));
  };
  lines::LineRange& range = t.lines.of[leaf.index()];
  range = {t.lines.end.size(), below(40), 0};
  auto& listed = t.lines.exceptions.of[leaf.index()];
  listed = {static_cast<std::uint32_t>(t.lines.exceptions.all.size()), 0};
  for (std::uint32_t k = 0; k < range.count; ++k) {
    const double what = random.uniform();
    std::uint32_t end = room.leaves[below(room.leaves.size() / 4) * 4 + below(3)].value;
    if (what >= 0.8 && what < 0.9) {
      t.lines.exceptions.all.push_back({k, end, Rgb(0.5f), what < 0.87, what < 0.85, what < 0.83});
      end = lines::kException, ++listed.count;
    } else if (what >= 0.9) {
      end = what < 0.95 ? lines::kCovered : lines::kLost, range.covered += end == lines::kCovered;
    } else if (k < held.size() && held[k] < lines::kFirstMark && !lines::KnownLines::isAgain(held[k]) && what < 0.56) {
      end = held[k];
    }
    t.lines.end.push_back(end), t.lines.code.push_back({});
  }
}

TEST(Exchange, FollowsWhateverLinesThereAre) {
  // A change that leaves nothing as it was but some lines by chance; leaves come, go, and are stored elsewhere.
  const TracedRoom room(RoomOfThings().scene, {});
  const std::size_t n = room.leaves.size();
  Rng random(9);
  lines::TracedLines traced;
  traced.resize(room.elements.size());
  for (const hierarchy::ElementId leaf : room.leaves.leaves) setRandomLines(room, leaf, {}, random, traced);
  lines::Exchange following = exchangeOf(room, traced);
  for (int round = 0; round < 8; ++round) {
    // What leaves send or do not is their surface's, so pairs of leaves of a surface change places.
    std::vector<std::uint32_t> now = allStay(room);
    for (std::uint32_t i = 0; i + 1 < n; i += 2) {
      const hierarchy::ElementId a = room.leaves[i], b = room.leaves[i + 1];
      if (random.uniform() < 0.5 && room.elements.sideOf(a) == room.elements.sideOf(b))
        std::swap(now[a.index()], now[b.index()]);
    }
    for (std::uint32_t& e : now)
      if (random.uniform() < 0.1) e = hierarchy::LeafTable::kNone;
    lines::KnownLines known = knownAfter({}, now, room.elements, traced);
    std::size_t same = 0;
    for (const hierarchy::ElementId leaf : room.leaves.leaves) {
      char& whole = known.whole[leaf.index()];
      whole = whole && random.uniform() < 0.5, same += whole;
      if (whole) continue;
      const auto& before = known.before[leaf.index()];
      const std::vector<std::uint32_t> held(
          traced.lines.end.begin() + static_cast<std::ptrdiff_t>(before.first),
          traced.lines.end.begin() + static_cast<std::ptrdiff_t>(before.first + before.count));
      setRandomLines(room, leaf, held, random, traced);
    }
    EXPECT_NO_THROW(lines::validate(traced.lines));
    following = followed(std::move(following), now, known, room, traced);
    lines::Exchange whole = exchangeOf(room, traced);
    expectSame(following, whole);
  }
}

TEST(Exchange, GathersAboutLeavesAsAllAreGathered) {
  const TracedRoom room(RoomOfThings().scene, {3, 0, false});
  lines::Exchange all = exchangeOf(room, room.trace(room.counts(48, 1))), about = all;
  const std::size_t n = all.leaves();
  std::vector<Rgb> B = randomLight(n, 4), E(n), exact(n);
  about.gather(B, E);
  Rng random(5);
  for (int round = 0; round < 40; ++round) {
    std::vector<std::uint32_t> others;
    for (int i = 0; i < 5; ++i) {
      others.push_back(static_cast<std::uint32_t>(random.uniform() * static_cast<double>(n)));
      B[others.back()] = Rgb(static_cast<float>(random.uniform()));
    }
    about.gatherAbout(others, B, E);
    all.gather(B, exact);
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(E[i], exact[i]) << round << ' ' << i;
  }
}

}  // namespace
}  // namespace deltalux
