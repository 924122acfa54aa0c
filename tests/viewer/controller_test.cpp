#include "controller.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <chrono>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/solution_file.hpp>
#include <deltalux/solution_reader.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <thread>

#include "support/temp_folder.hpp"

namespace deltalux::viewer {
namespace {

namespace fs = std::filesystem;

const fs::path kCornell = fs::path(DELTALUX_SOURCE_DIR) / "scenes/cornell";
const ProbePoint kLit{{0.45, 0, 0.1}, {0, 1, 0}};     // in plain view of the lamp
const ProbePoint kFloor{{0.05, 0, 0.17}, {0, 1, 0}};  // half in the shadow of the short block

SolveSettings coarse() {
  SolveSettings settings;
  settings.error = 0.3;
  return settings;
}

std::unique_ptr<Engine> unsolved() {
  return std::make_unique<Engine>(loadScene({kCornell / "cornell.rad"}).scene, coarse());
}

double processSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The Cornell box, solved coarsely once, and a window's loop without a window.
class ViewerController : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    solvedFolder = std::make_unique<test::TempFolder>();
    const std::unique_ptr<Engine> engine = unsolved();
    engine->solve();
    saveSolution(solution(), engine->solution());
  }
  static void TearDownTestSuite() { solvedFolder.reset(); }
  static fs::path solution() { return *solvedFolder / "cornell.dlx"; }

  static Controller::Source source(Solver::Open open) {
    Controller::Source s;
    s.open = std::move(open);
    s.recording = [] {
      Recording r;
      r.scene = {kCornell / "cornell.rad"};
      r.settings = coarse();
      return r;
    };
    s.view = loadView(kCornell / "cornell.vf");
    return s;
  }
  static Solver::Settings settings() {
    Solver::Settings s;
    s.picture.samplesPerPixel = 2;
    return s;
  }
  static Solver::Open solved() {
    return [](Progress&) { return std::make_unique<Engine>(loadSolution(solution())); };
  }

  /// Turns of the loop until it is so.
  ::testing::AssertionResult reached(Controller& c, const std::function<bool()>& so) {
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::seconds(60)) {
      if (c.takeChanges()) c.drawn({});
      if (so()) return ::testing::AssertionSuccess();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return ::testing::AssertionFailure() << "not within a minute; phase " << int(c.status().phase) << " "
                                         << c.status().message;
  }
  ::testing::AssertionResult settledExactly(Controller& c) {
    return reached(c, [&] {
      return c.settled() && std::all_of(c.probes().begin(), c.probes().end(), [](const Probe& p) { return p.exact; });
    });
  }

  static std::unique_ptr<test::TempFolder> solvedFolder;
  test::TempFolder folder;
  Controller controller{source(solved()), settings()};
};
std::unique_ptr<test::TempFolder> ViewerController::solvedFolder;

double luxOf(const SolutionReader& reader, const ProbePoint& point) {
  return photometric(reader.probe(std::vector{point})[0].irradiance, kLuminousEfficacy);
}

Mat4 shifted(double x, double y, double z) { return glm::translate(Mat4(1.0), Vec3(x, y, z)); }

TEST_F(ViewerController, AfterADragMetersReadWhatProbeReadsOfTheSolution) {
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  controller.pinProbe("floor", kFloor);
  ASSERT_TRUE(settledExactly(controller));
  const double before = controller.probes()[0].lux;
  EXPECT_GT(before, 0);

  controller.select("short_block");
  controller.beginDrag();
  for (int i = 1; i <= 5; ++i) {
    controller.dragTo(shifted(0.02 * i, 0, 0));
    EXPECT_FALSE(controller.settled());
    if (controller.takeChanges()) controller.drawn({});
  }
  ASSERT_TRUE(
      reached(controller, [&] { return controller.status().phase == Phase::Moving && !controller.frame().ahead; }));
  EXPECT_FALSE(controller.settled());
  controller.endDrag();
  EXPECT_FALSE(controller.settled());
  ASSERT_TRUE(settledExactly(controller));
  EXPECT_FALSE(controller.frame().ahead);
  const double moved = controller.probes()[0].lux;
  EXPECT_GT(std::abs(moved - before), 0.02 * before);
  EXPECT_GT(controller.probes()[0].history.size(), 2u);

  const fs::path saved = folder / "moved.dlx";
  std::atomic<bool> written = false;
  controller.solver().save(saved.string(), [&](const std::string& problem) {
    EXPECT_EQ(problem, "");
    written = true;
  });
  ASSERT_TRUE(reached(controller, [&] { return written.load(); }));
  const double fresh = luxOf(SolutionReader(loadSolution(saved)), kFloor);
  EXPECT_NEAR(moved, fresh, 1e-6 * fresh);
  const double measured =
      photometric(controller.solver().measure({kFloor})[0].irradiance, controller.scene().luminousEfficacy);
  EXPECT_NEAR(measured, moved, 1e-9 * moved);

  EXPECT_EQ(controller.session().recording().steps.size(), 1u);
  controller.undo();
  EXPECT_FALSE(controller.settled());
  ASSERT_TRUE(settledExactly(controller));
  // As an engine that was never seen: the same but for frames on the way, and what a coarse solution leaves to chance.
  Engine unseen(loadSolution(solution()));
  const Restore back = unseen.apply(TransformObject{"short_block", shifted(0.1, 0, 0)});
  unseen.update();
  EXPECT_NEAR(moved, luxOf(SolutionReader(unseen.solution()), kFloor), 1e-3 * moved);
  unseen.apply(back);
  unseen.update();
  EXPECT_NEAR(controller.probes()[0].lux, luxOf(SolutionReader(unseen.solution()), kFloor), 1e-3 * before);
  EXPECT_NEAR(controller.probes()[0].lux, before, 0.05 * before);
}

TEST_F(ViewerController, RaysFillTheCacheAndEditsTakeOutWhatTheyMakeWrong) {
  constexpr int kSize = 24;
  controller.setSize(kSize, kSize);
  controller.draw().picture = false;
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  std::vector<std::uint32_t> surfaces(kSize * kSize, 0);
  const auto look = [&] {
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const auto hit = controller.hitAt(x + 0.5, y + 0.5);
        surfaces[static_cast<std::size_t>(y * kSize + x)] = hit ? hit->primitive.value + 1 : 0;
      }
  };
  look();
  const auto held = [&] {
    const CacheFrame& frame = controller.cache().frame(controller.camera(), kSize, kSize, surfaces);
    return static_cast<double>(frame.held) / static_cast<double>(frame.wanted);
  };
  const auto draw = [&] {
    held();
    controller.drawn(std::vector<char>(surfaces.size(), 1));
  };
  EXPECT_EQ(held(), 0);
  draw();
  ASSERT_TRUE(reached(controller, [&] {
    draw();
    return held() > 0.7;
  }));
  EXPECT_TRUE(controller.finished());
  int quiet = 0;  // turns without changes: no end of asking would be no end of drawing
  ASSERT_TRUE(reached(controller, [&] {
    const bool changed = controller.takeChanges();
    if (changed) draw();
    quiet = changed ? 0 : quiet + 1;
    return quiet > 50;
  }));

  controller.edit(TransformObject{"short_block", shifted(0.02, 0, 0)});
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  const auto stale = [&] {
    const auto samples = controller.cache().samples();
    return std::count_if(samples.begin(), samples.end(),
                         [&](const PixelSample& s) { return controller.solver().changes()->stale(s); });
  };
  const auto wrong = stale();
  EXPECT_GT(wrong, 0);
  look();
  EXPECT_GT(held(), 0.7) << "what was there stays until something better comes";
  ASSERT_TRUE(reached(controller, [&] {
    draw();
    return 2 * stale() < wrong && held() > 0.99;  // some lie behind newer ones until there is no room
  }));
}

TEST_F(ViewerController, TheHandIsAheadOfTheLightByWhatTheMeshHasNotSeen) {
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  controller.select("tall_block");
  controller.beginDrag();
  controller.dragTo(shifted(0, 0.1, -0.2));
  const std::optional<Ahead> ahead = controller.frame().ahead;  // nothing was taken over since
  ASSERT_TRUE(ahead);
  EXPECT_EQ(ahead->primitives, primitivesOf(controller.scene(), findObjects(controller.scene(), "tall_block")[0]));
  EXPECT_NEAR(glm::length(Vec3f(ahead->matrix[3]) - Vec3f(0, 0.1f, -0.2f)), 0, 1e-6);
  ASSERT_TRUE(reached(controller, [&] { return !controller.frame().ahead; }));
  controller.endDrag();
  controller.undo();
  ASSERT_TRUE(controller.frame().ahead);
  EXPECT_NEAR(controller.frame().ahead->matrix[3].z, 0.2, 1e-6);
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  EXPECT_FALSE(controller.frame().ahead);
}

TEST_F(ViewerController, DimmingByHalfHalvesTheLampsShare) {
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  controller.explain(kLit);
  ASSERT_TRUE(reached(controller, [&] { return controller.explanation().has_value(); }));
  const Contributions before = *controller.explanation();
  ASSERT_EQ(before.lamps.size(), 1u);
  EXPECT_EQ(controller.scene()[before.lamps[0].light].name, "lamp");
  controller.pinProbe("floor", kLit);
  ASSERT_TRUE(settledExactly(controller));
  const double lux = controller.probes()[0].lux;
  controller.dim("lamp", 0.5);
  EXPECT_FALSE(controller.settled());
  ASSERT_TRUE(settledExactly(controller));
  controller.explain(kLit);
  ASSERT_TRUE(reached(controller, [&] { return controller.explanation().has_value(); }));
  EXPECT_NEAR(gray(controller.explanation()->lamps[0].E), 0.5 * gray(before.lamps[0].E),
              1e-3 * gray(before.lamps[0].E));
  EXPECT_NEAR(controller.probes()[0].lux, 0.5 * lux, 0.01 * lux);
}

TEST_F(ViewerController, NothingRunsOnceItIsFinished) {
  controller.setSize(48, 48);
  ASSERT_TRUE(reached(controller, [&] { return controller.ready(); }));
  controller.drawn({});
  ASSERT_TRUE(reached(controller, [&] { return controller.finished(); }));
  EXPECT_TRUE(controller.settled());
  const std::shared_ptr<const Picture> picture = controller.frame().picture;
  ASSERT_TRUE(picture);
  EXPECT_TRUE(picture->done);
  EXPECT_FALSE(controller.takeChanges());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const double start = processSeconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(processSeconds() - start, 0.005);
  EXPECT_FALSE(controller.takeChanges());

  RenderSettings same = settings().picture;
  same.width = same.height = 48;
  const Image offline = render(loadSolution(solution()), controller.camera(), same);
  ASSERT_EQ(offline.pixels.size(), picture->image.pixels.size());
  EXPECT_EQ(offline.pixels, picture->image.pixels);

  View other = controller.camera();
  turn(other, 0.2, 0);
  controller.setCamera(other);
  EXPECT_FALSE(controller.finished());
  EXPECT_FALSE(controller.frame().picture);
  controller.drawn({});
  ASSERT_TRUE(reached(controller, [&] { return controller.finished(); }));
}

TEST_F(ViewerController, ThingsAreNamedAndFoundByWhatIsDrawn) {
  controller.setSize(200, 200);
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  const Scene& scene = controller.scene();
  const PrimitiveId front = primitivesOf(scene, findObjects(scene, "short_block.side.front")[0])[0];
  const Vec3 pixel = project(controller.camera(), 200, 200, bounds(scene[front].shape).center());
  EXPECT_EQ(controller.nameAt(pixel.x, pixel.y), "short_block");
  EXPECT_EQ(controller.nameAt(pixel.x, pixel.y, true), "short_block.side.front");
  const std::optional<SurfaceHit> hit = controller.hitAt(pixel.x, pixel.y);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->primitive, front);
  EXPECT_NEAR(glm::length(hit->position - bounds(scene[front].shape).center()), 0, 1e-6);

  controller.pointAt(pixel.x, pixel.y);
  EXPECT_TRUE(controller.underCursor().known);
  EXPECT_GT(controller.underCursor().lux, 0);
  ASSERT_TRUE(reached(controller, [&] { return controller.underCursor().contributions.has_value(); }));
  const double lux =
      photometric(controller.solver().measure({controller.underCursor().point})[0].irradiance, kLuminousEfficacy);
  EXPECT_NEAR(controller.underCursor().lux, lux, 1e-9 * lux);

  EXPECT_THROW(controller.select("short_blok"), InputError);
  EXPECT_EQ(controller.selection(), "");
  controller.select("lamp");
  EXPECT_EQ(controller.frame().selection.size(), 1u);
  EXPECT_THROW(controller.aim("lamp", Vec3(0.2, 0, 0.2)), InputError);  // a surface without a cone
  EXPECT_TRUE(controller.settled());
  controller.lookThrough("lamp");
  EXPECT_NEAR(glm::dot(glm::normalize(controller.camera().direction), Vec3(0, -1, 0)), 1, 1e-9);
  controller.bookmark(3);
  controller.focusOnSelection();
  EXPECT_TRUE(controller.goToBookmark(3));
  EXPECT_FALSE(controller.goToBookmark(9));
}

TEST_F(ViewerController, AStoredStateIsSeenBesideAndComesBack) {
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  EXPECT_THROW(controller.compare(0, 0.5), InputError);
  EXPECT_THROW(controller.restore(1), InputError);
  controller.pinProbe("floor", kFloor);
  ASSERT_TRUE(settledExactly(controller));
  const double lux = controller.probes()[0].lux;
  controller.store(0);
  controller.paint("white", Rgb(0.2f));
  controller.store(1);  // before its light is there
  ASSERT_TRUE(settledExactly(controller));
  EXPECT_LT(controller.probes()[0].lux, 0.98 * lux);
  controller.compare(0, 0.5);
  EXPECT_TRUE(controller.frame().other);
  EXPECT_NE(controller.frame().other, controller.frame().mesh);
  controller.compare(1, 0.5);
  EXPECT_EQ(controller.frame().other, controller.frame().mesh);
  controller.compare(1, 1);
  EXPECT_FALSE(controller.frame().other);
  controller.restore(0);
  EXPECT_FALSE(controller.settled());
  ASSERT_TRUE(settledExactly(controller));
  EXPECT_NEAR(controller.probes()[0].lux, lux, 0.01 * lux);
}

TEST_F(ViewerController, AFieldOfMetersTellsMeanLeastAndUniformity) {
  ASSERT_TRUE(reached(controller, [&] { return controller.settled(); }));
  MeterField field;
  field.corner = {0.05, 0.3, 0.05}, field.across = {0.4, 0, 0}, field.along = {0, 0, 0.4}, field.normal = {0, 1, 0};
  field.columns = 3, field.rows = 2;
  controller.setField(field);
  ASSERT_TRUE(reached(controller, [&] { return controller.field()->exact; }));
  std::vector<ProbePoint> points;
  for (const double z : {0.15, 0.35})
    for (const double x : {0.05 + 0.4 / 6, 0.25, 0.45 - 0.4 / 6}) points.push_back({{x, 0.3, z}, {0, 1, 0}});
  double mean = 0, least = kInfinity;
  for (const ProbeResult& r : controller.solver().measure(points)) {
    const double lux = photometric(r.irradiance, kLuminousEfficacy);
    mean += lux / 6, least = std::min(least, lux);
  }
  EXPECT_NEAR(controller.field()->mean, mean, 1e-6 * mean);
  EXPECT_NEAR(controller.field()->least, least, 1e-6 * mean);
  EXPECT_NEAR(controller.field()->uniformity, least / mean, 1e-6);
}

TEST_F(ViewerController, EditsThatComeWhileItIsSolvedWaitAndAreNotLost) {
  Controller fresh(source([](Progress&) { return unsolved(); }), settings());
  ASSERT_TRUE(reached(fresh, [&] { return fresh.ready(); }));
  EXPECT_EQ(fresh.status().phase, Phase::Solving);  // the first picture is there before the last round
  fresh.select("short_block");
  fresh.edit(TransformObject{"short_block", shifted(0.2, 0, 0)});
  EXPECT_FALSE(fresh.settled());
  ASSERT_TRUE(reached(fresh, [&] { return fresh.settled(); }));
  const PrimitiveId top = primitivesOf(fresh.scene(), findObjects(fresh.scene(), "short_block.top")[0])[0];
  const Box box = bounds((*fresh.frame().mesh->scene)[top].shape);
  EXPECT_NEAR(box.lower.x, bounds((*controller.solver().mesh()->scene)[top].shape).lower.x + 0.2, 1e-9);
}

TEST_F(ViewerController, WhatCannotBeOpenedIsTold) {
  Controller broken(source([](Progress&) -> std::unique_ptr<Engine> { throw InputError("x.rad", 3, "is odd", ""); }),
                    settings());
  ASSERT_TRUE(reached(broken, [&] { return broken.status().phase == Phase::Failed; }));
  EXPECT_NE(broken.status().message.find("x.rad:3"), std::string::npos);
  EXPECT_FALSE(broken.ready() || broken.settled() || broken.finished());
  EXPECT_THROW(broken.solver().measure({kFloor}), std::runtime_error);
  EXPECT_THROW(broken.edit(ScaleLight{"lamp", 0.5f}), InputError);
}

TEST_F(ViewerController, ClosingDoesNotWaitForASolve) {
  SolveSettings fine = coarse();
  fine.error = 0.01;
  const auto start = std::chrono::steady_clock::now();
  {
    Controller hasty(
        source([&](Progress&) { return std::make_unique<Engine>(loadScene({kCornell / "cornell.rad"}).scene, fine); }),
        settings());
    ASSERT_TRUE(reached(hasty, [&] { return hasty.status().phase == Phase::Solving; }));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

}  // namespace
}  // namespace deltalux::viewer
