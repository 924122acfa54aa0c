// Updates: after an edit, what a fresh solve of the edited scene gives, for the work of what changed.
#include <gtest/gtest.h>
#include <deltalux/error.hpp>

#include "base/random.hpp"
#include "hierarchy/side_locator.hpp"
#include "radiosity/row_terms.hpp"
#include "support/furnished_room.hpp"
#include "support/settled.hpp"

namespace deltalux {
namespace {

Scene roomWithBox() {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.6f));
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(20.0f), false, {}});
  test::addBox(scene, white, {0, 0, 0}, {3, 4, 2.5}, true);
  test::addBox(scene, white, {1.0, 1.2, 0.3}, {1.5, 1.8, 0.9}, false);
  test::addPolygon(scene, lamp, {{1.2, 1.7, 2.4}, {1.2, 2.3, 2.4}, {1.8, 2.3, 2.4}, {1.8, 1.7, 2.4}});
  const ObjectId walls = internObject(scene, "walls", '.'), box = internObject(scene, "box", '.');
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) scene.primitives[i].object = i >= 6 && i < 12 ? box : walls;
  addAreaLights(scene);
  return scene;
}

Edit moveBox(const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return TransformObject{"box", matrix};
}

/// Area-weighted relative difference of E between the leaves of two solutions of one scene, at the leaves of the first.
test::Spread difference(const Engine& a, const Engine& b) {
  const Solution &s = a.solution().get(), &t = b.solution().get();
  const hierarchy::SideLocator locator(t.elements, t.scene);
  std::vector<double> differences;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const hierarchy::ElementTopology& topology = s.elements.topology[i];
    if (topology.kind != hierarchy::ElementKind::Patch || topology.emitter || topology.childCount > 0) continue;
    const hierarchy::PatchDomain& d = s.elements.domain[i];
    const hierarchy::ElementId side = locator.side(d.primitive, d.triangle, topology.front);
    if (!side.valid()) continue;
    const Vec3f center = s.elements.geometry[i].center;
    const hierarchy::ElementLight &x = s.elements.radiometry[i],
                                  &y = t.elements.radiometry[locator.locate(side, Vec3(center)).leaf.index()];
    const double E = gray(y.direct + y.indirect);
    if (E > 0.01) differences.push_back(std::abs(gray(x.direct + x.indirect) - E) / E);
  }
  return test::spreadOf(std::move(differences));
}

TEST(Update, MovingABoxIsSolvingTheMovedScene) {
  Engine engine = test::solved(roomWithBox(), 0.05);
  engine.apply(moveBox({0.15, 0.1, 0}));
  const StepReport step = engine.update();
  EXPECT_EQ(step.op, "transform");
  EXPECT_GT(step.linksVisited, 0u);
  EXPECT_GT(step.rays, 0u);
  EXPECT_GT(step.leavesChanged, 0u);
  const Solution& s = engine.solution().get();
  EXPECT_NO_THROW(validate(s.elements));
  EXPECT_NO_THROW(validate(s.links, s.elements));
  EXPECT_NO_THROW(s.transfers.validate(s.elements, s.links));
  const Engine fresh = test::solved(s.scene, 0.05);
  const test::Spread between = difference(engine, fresh);
  EXPECT_LT(between.median, 0.02);
  EXPECT_LT(between.p95, 0.12);
  for (std::size_t wall = 0; wall < 6; ++wall)
    EXPECT_NEAR(test::meshMean(engine, PrimitiveId(wall)) / test::meshMean(fresh, PrimitiveId(wall)), 1.0, 0.01);
}

TEST(Update, ManySmallMovesCarryTheirLightOn) {
  // Each changes less light than is worth a pass over the rest of the room; all of them together do not.
  SolveSettings settings;
  settings.error = 0.05, settings.diffuseOnly = true;
  Engine engine(roomWithBox(), settings);
  engine.solve();
  for (int i = 0; i < 200; ++i) {
    engine.apply(moveBox({0.0005, 0, 0}));
    engine.update();
  }
  const EnergyLedger ledger = engine.balance();
  EXPECT_LE(*ledger.unsettledW, 1e-4 * *ledger.emittedW);
  EXPECT_LT(test::unsettled(engine.solution().get()).relative.p95, 0.005);
}

struct Staleness {
  std::size_t terms = 0;    // of indirect rows
  std::size_t bring = 0;    // those that would bring something else, were all rays traced anew
  std::size_t towards = 0;  // those whose ray would be remembered to lead elsewhere
};

Staleness staleness(const Solution& s) {
  hierarchy::Elements elements = s.elements;
  radiosity::LeafTransfers transfers = s.transfers;
  paper::LinkMarks all;
  all.changes = paper::LinkChanges(s.links.size(), paper::LinkChange::Touched);
  paper::SpaceChange everywhere;
  everywhere.add(elements.sceneBox);
  radiosity::ConcernedLeaves leaves;
  for (const radiosity::LeafRow& row : transfers.rows()) leaves.byLeaves.push_back(row.leaf);
  std::sort(leaves.byLeaves.begin(), leaves.byLeaves.end());
  transfers.update(elements, s.links, s.scene, *s.tracer, {}, all, {}, everywhere, leaves);
  Staleness stale;
  for (std::size_t i = 0; i < transfers.rows().size(); ++i) {
    const radiosity::TransferRow &was = s.transfers.rows()[i].indirect, &is = transfers.rows()[i].indirect;
    EXPECT_EQ(was.terms.size(), is.terms.size());
    std::vector<RgbSum> bring(is.terms.size(), RgbSum(0.0));
    const auto add = [&](const radiosity::TransferRow& row, double sign) {
      radiosity::forEachTerm(
          row, [&](std::uint32_t k, const radiosity::RowTerm&, std::span<const radiosity::LeafTransfer> transfer) {
            for (const radiosity::LeafTransfer& x : transfer) bring[k] += sign * RgbSum(x.T);
          });
    };
    add(was, 1), add(is, -1);
    for (std::size_t k = 0; k < bring.size(); ++k) {
      if (!elements.isLeaf(is.terms[k].sender)) continue;  // another ray, since its sender has been split
      ++stale.terms, stale.bring += glm::length(bring[k]) > 1e-6;
      stale.towards += !(radiosity::towards(was.rays[k]) == radiosity::towards(is.rays[k]));
    }
  }
  return stale;
}

TEST(Update, NoRayIsMissed) {
  Scene scene = roomWithBox();
  const ObjectId crate = internObject(scene, "crate", '.'), behind = internObject(scene, "behind", '.');
  const MaterialId gray = test::addMaterial(scene, "gray", test::lambert(0.4f));
  test::addBox(scene, gray, {2.0, 1.0, 0.1}, {2.6, 1.9, 1.2}, false);
  for (std::size_t i = scene.primitives.size() - 6; i < scene.primitives.size(); ++i)
    scene.primitives[i].object = crate;
  test::addShape(scene, gray, Sphere{{2.3, 2.6, 0.5}, 0.25, false});
  scene.primitives.back().object = behind;
  SolveSettings settings;
  settings.error = 0.1, settings.diffuseOnly = true;
  Engine engine(scene, settings);
  engine.solve();
  const auto moved = [](const char* what, const Vec3& by) {
    Mat4 matrix(1.0);
    matrix[3] = glm::dvec4(by, 1.0);
    return TransformObject{what, matrix};
  };
  const std::vector<TransformObject> moves{moved("box", {0.3, 0.9, 0}),   moved("crate", {-0.5, 0.2, 0.3}),
                                           moved("behind", {-0.6, 0, 0}), moved("crate", {0.4, 1.2, 0}),
                                           moved("box", {0, -1.0, 0.2}),  moved("behind", {0.4, -1.4, 0.8})};
  for (const TransformObject& move : moves) {
    engine.apply(move);
    engine.update();
    const Staleness stale = staleness(engine.solution().get());
    EXPECT_GT(stale.terms, 10000u);
    EXPECT_EQ(stale.bring, 0u) << "after " << move.object;
  }
}

/// Rays towards an object from leaves that see nothing of it.
std::size_t raysInVain(const Solution& s, const char* object) {
  std::vector<hierarchy::ElementId> inputs;
  paper::SpaceChange space;
  for (const hierarchy::ElementId e : s.elements.inputs) {
    if (!s.elements.isPatch(e)) continue;
    const Primitive& p = s.scene[s.elements.domain[e.index()].primitive];
    if (s.scene.objects[p.object.index()].name != object) continue;
    inputs.push_back(e);
    space.add(bounds(p.shape));
  }
  space.addMoved(inputs, s.elements, s.scene);
  space.findHidden(s.elements, s.scene);
  std::size_t rays = 0;
  for (const radiosity::LeafRow& row : s.transfers.rows())
    for (const radiosity::RowTerm& t : row.indirect.terms) rays += space.hiddenFrom(row.leaf) && space.moved(t.sender);
  return rays;
}

TEST(Update, WhatMovedOutOfSightIsFoundWhereItIsWhenItsScreenGoes) {
  Scene scene = roomWithBox();
  const ObjectId screen = internObject(scene, "screen", '.');
  const MaterialId gray = test::addMaterial(scene, "gray", test::lambert(0.4f));
  test::addBox(scene, gray, {0.2, 1.0, 0}, {2.8, 1.05, 2.2}, false);
  for (std::size_t i = scene.primitives.size() - 6; i < scene.primitives.size(); ++i)
    scene.primitives[i].object = screen;
  SolveSettings settings;
  settings.error = 0.1, settings.diffuseOnly = true;
  Engine engine(scene, settings);
  engine.solve();
  for (const Vec3& by : {Vec3(0.3, 0.9, 0), Vec3(-0.4, 0.1, 0.2), Vec3(0, -0.5, -0.1)}) {
    engine.apply(moveBox(by));
    engine.update();
    const Solution& s = engine.solution().get();
    EXPECT_EQ(staleness(s).bring, 0u);
    EXPECT_NO_THROW(s.transfers.validate(s.elements, s.links));
  }
  EXPECT_GT(raysInVain(engine.solution().get(), "box"), 100u) << "nothing was out of sight: this shows nothing";
  engine.apply(RemoveObject{"screen"});
  engine.update();
  const Staleness stale = staleness(engine.solution().get());
  EXPECT_GT(stale.terms, 10000u);
  EXPECT_EQ(stale.bring, 0u);
  EXPECT_EQ(stale.towards, 0u);
}

TEST(Update, DiffuseOnlyFollowsLights) {
  SolveSettings settings;
  settings.error = 0.05, settings.diffuseOnly = true;
  Engine engine(roomWithBox(), settings);
  engine.solve();
  std::vector<double> before;
  for (std::size_t wall = 0; wall < 6; ++wall) before.push_back(test::meshMean(engine, PrimitiveId(wall)));
  engine.apply(ScaleLight{engine.solution().scene().lights.back().name, 0.5f});
  engine.update();
  for (std::size_t wall = 0; wall < 6; ++wall)
    EXPECT_NEAR(test::meshMean(engine, PrimitiveId(wall)) / before[wall], 0.5, 0.002);
}

TEST(Update, WhatWasSolvedAfreshSettlesAnew) {
  SolveSettings settings;
  settings.error = 0.1, settings.diffuseOnly = true;
  Engine engine(roomWithBox(), settings);
  engine.solve();
  engine.apply(moveBox({0.1, 0, 0}));
  engine.update();
  Scene part;
  const MaterialId glow = test::addMaterial(part, "glow", test::lambert(0.0f), Emission{Rgb(30.0f), false, {}});
  test::addShape(part, glow, Sphere{{0.6, 3.2, 0.8}, 0.1, false});
  addAreaLights(part);
  part.lights.back().name = "globe";
  engine.apply(AddObject{"globe", "", std::make_shared<const Scene>(part)});
  engine.update();
  engine.apply(moveBox({0.2, 0.3, 0}));
  engine.update();
  EXPECT_LT(test::unsettled(engine.solution().get()).relative.p95, 0.005);
}

TEST(Update, DiffuseOnlyFollowsMovesThatSplitLeaves) {
  SolveSettings settings;
  settings.error = 0.05, settings.diffuseOnly = true;
  Engine engine(roomWithBox(), settings);
  engine.solve();
  for (const double dx : {0.3, -0.5, 0.4, -0.3}) {
    engine.apply(moveBox({dx, 0.2 * dx, 0}));
    engine.update();
  }
  const Solution& s = engine.solution().get();
  EXPECT_NO_THROW(s.transfers.validate(s.elements, s.links));
  Engine fresh(s.scene, settings);
  fresh.solve();
  for (std::size_t wall = 0; wall < 6; ++wall)
    EXPECT_NEAR(test::meshMean(engine, PrimitiveId(wall)) / test::meshMean(fresh, PrimitiveId(wall)), 1.0, 0.02);
}

TEST(Update, OutAndBackIsWhereItWas) {
  Engine engine = test::solved(roomWithBox(), 0.05);
  const Engine before = test::solved(roomWithBox(), 0.05);
  engine.apply(moveBox({0.3, 0.4, 0.2}));
  engine.update();
  engine.apply(moveBox({-0.3, -0.4, -0.2}));
  engine.update();
  const test::Spread between = difference(engine, before);
  EXPECT_LT(between.median, 0.02);
  EXPECT_LT(between.p95, 0.12);
}

TEST(Update, WhatIsHiddenForAWhileStaysRefined) {
  Engine engine = test::solved(test::furnishedRoom(), 0.05);
  int kept = 0;
  for (int i = 0; i < 4; ++i) {
    const std::vector<hierarchy::Link> before = engine.solution().get().links.all;
    engine.apply(moveBox({-0.3, 0.1, 0}));
    engine.update();
    const hierarchy::Links& links = engine.solution().get().links;
    for (std::size_t id = 0; id < before.size(); ++id) {
      const hierarchy::Link &was = before[id], &is = links.all[id];
      const bool same =
          was.state == hierarchy::LinkState::Interior && was.receiver == is.receiver && was.sender == is.sender;
      if (!same || was.unseen() || !is.unseen()) continue;
      EXPECT_EQ(is.state, hierarchy::LinkState::Interior) << id;
      ++kept;
    }
  }
  EXPECT_GT(kept, 0);
}

TEST(Update, DimmingTracesNoRayAndScalesTheLight) {
  Engine engine = test::solved(roomWithBox(), 0.05);
  const double before = test::meshMean(engine, PrimitiveId(std::size_t{0}));
  const std::string lamp = engine.solution().scene().lights[0].name;
  engine.apply(ScaleLight{lamp, 0.25f});
  const StepReport step = engine.update();
  EXPECT_EQ(step.linksVisited, 0u);
  EXPECT_EQ(step.rays, 0u);
  EXPECT_EQ(step.leavesChanged, 0u);
  EXPECT_NEAR(test::meshMean(engine, PrimitiveId(std::size_t{0})) / before, 0.25, 1e-3);
  engine.apply(SwitchLight{lamp, false});
  engine.update();
  EXPECT_LT(test::meshMean(engine, PrimitiveId(std::size_t{0})), 1e-3 * before);
}

TEST(Update, RepaintingTracesNoRayAndIsSolvingTheRepaintedScene) {
  Engine engine = test::solved(roomWithBox(), 0.05);
  engine.apply(SetMaterial{"white", Rgb(0.3f), {}});
  EXPECT_EQ(engine.update().rays, 0u);
  const Engine fresh = test::solved(engine.solution().scene(), 0.05);
  for (std::size_t wall = 0; wall < 6; ++wall)
    EXPECT_NEAR(test::meshMean(engine, PrimitiveId(wall)) / test::meshMean(fresh, PrimitiveId(wall)), 1.0, 0.01);
}

TEST(Update, RemovingAndComingBack) {
  Engine engine = test::solved(roomWithBox(), 0.05);
  engine.apply(RemoveObject{"box"});
  engine.update();
  EXPECT_NO_THROW(validate(engine.solution().get().elements));
  const Engine fresh = test::solved(engine.solution().scene(), 0.05);
  for (std::size_t wall = 0; wall < 6; ++wall)
    EXPECT_NEAR(test::meshMean(engine, PrimitiveId(wall)) / test::meshMean(fresh, PrimitiveId(wall)), 1.0, 0.01);
}

TEST(Update, RemovingWhatIsRoundAndCloseLeavesNothingOfIt) {
  Scene scene = roomWithBox();
  test::addShape(scene, test::addMaterial(scene, "gray", test::lambert(0.4f)), Sphere{{2.3, 2.6, 0.26}, 0.25, false});
  scene.primitives.back().object = internObject(scene, "ball", '.');
  Engine engine = test::solved(scene, 0.1);
  const Restore back = engine.apply(RemoveObject{"ball"});
  engine.update();
  const Staleness gone = staleness(engine.solution().get());
  EXPECT_EQ(gone.bring, 0u) << "of " << gone.terms;
  EXPECT_EQ(gone.towards, 0u) << "of " << gone.terms;
  engine.apply(back);
  engine.update();
  const Staleness there = staleness(engine.solution().get());
  EXPECT_EQ(there.bring, 0u);
  EXPECT_EQ(there.towards, 0u);
}

TEST(Update, ManyRandomMovesHoldTogetherAndEndWhereAFreshSolveDoes) {
  Engine engine = test::solved(roomWithBox(), 0.05);
  Rng rng(17);
  Vec3 at(0.0);
  for (int i = 0; i < 12; ++i) {
    const Vec3 to(rng.uniform() * 1.2 - 0.8, rng.uniform() * 1.8 - 0.9, rng.uniform() * 0.8 - 0.2);
    engine.apply(moveBox(to - at));
    at = to;
    engine.update();
    const Solution& s = engine.solution().get();
    ASSERT_NO_THROW(validate(s.elements));
    ASSERT_NO_THROW(validate(s.links, s.elements));
    ASSERT_NO_THROW(s.transfers.validate(s.elements, s.links));
  }
  const Engine fresh = test::solved(engine.solution().scene(), 0.05);
  for (std::size_t wall = 0; wall < 6; ++wall)
    EXPECT_NEAR(test::meshMean(engine, PrimitiveId(wall)) / test::meshMean(fresh, PrimitiveId(wall)), 1.0, 0.025);
}

TEST(Update, AnUnknownNameLeavesEverythingAsItWas) {
  Engine engine = test::solved(roomWithBox(), 0.1);
  EXPECT_THROW(engine.apply(RemoveObject{"boks"}), InputError);
  EXPECT_EQ(engine.update().linksVisited, 0u);
}

}  // namespace
}  // namespace deltalux
