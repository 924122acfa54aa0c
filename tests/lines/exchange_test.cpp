// Rows of exchange: closed rooms sum to one, reciprocity, and what both ends of a line say of each other.
#include "lines/exchange.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "lines/iterate.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

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
    settings.method = SolveMethod::Lines;
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

}  // namespace
}  // namespace deltalux
