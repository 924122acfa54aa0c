#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/render_cache.hpp>
#include <deltalux/solution_reader.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "render/error_diffusion.hpp"
#include "render/mirror_room.hpp"
#include "render/view_projection.hpp"

namespace deltalux {
namespace {

constexpr int kWidth = 80, kHeight = 60;
constexpr std::size_t kPixels = std::size_t(kWidth) * kHeight;

View camera(const Vec3& position = {1.0, 0.1, 1.1}) {
  View view = test::towardsMirror();
  view.position = position, view.vertical = 60;
  return view;
}

SolutionView solvedRoom() {
  static const Engine engine = test::solved(test::mirrorRoom(), 0.2);
  return engine.solution();
}

struct Cached {
  Engine engine;
  SolutionReader reader;
  RenderCache cache;

  explicit Cached(SolutionView solution = solvedRoom(), RenderCacheSettings settings = {})
      : engine(std::move(solution)), reader(engine.solution()), cache(settings) {}

  /// What a drawing would say: the mirror's pixels.
  std::vector<std::uint32_t> surfaces(const View& view) const {
    std::vector<std::uint32_t> seen;
    for (const PixelSample& s : reader.trace(test::raysOf(view, kWidth, kHeight)))
      seen.push_back(s.primitive == PrimitiveId(test::kRoomMirror) ? s.primitive.value + 1 : 0);
    return seen;
  }
  const CacheFrame& frame(const View& view) { return cache.frame(view, kWidth, kHeight, surfaces(view)); }
  std::size_t goOn(const View& view, std::size_t rays) {
    const auto wanted = cache.wanted(rays, view);
    cache.insert(reader.trace(wanted));
    return wanted.size();
  }
  /// Until nothing is wanted.
  void settle(const View& view) {
    for (int i = 0; i < 200; ++i) {
      frame(view);
      if (goOn(view, kPixels) == 0) return;
    }
    FAIL() << "always wants more";
  }
};

TEST(RenderCache, BecomesWhatRaysThroughAllPixelsFind) {
  Cached c;
  const View view = camera();
  c.settle(view);
  const CacheFrame& frame = c.frame(view);
  EXPECT_EQ(frame.held, frame.wanted);
  EXPECT_GT(frame.wanted, kPixels / 4);
  const auto seen = c.surfaces(view);
  const auto traced = c.reader.trace(test::raysOf(view, kWidth, kHeight));
  for (std::size_t p = 0; p < kPixels; ++p)
    EXPECT_EQ(frame.pixels[p], seen[p] != 0 ? glm::vec4(traced[p].radiance, 1.0f) : glm::vec4(0.0f)) << p;
  EXPECT_TRUE(c.cache.wanted(1000, view).empty()) << "nothing is left to do";
}

TEST(RenderCache, AsksForEmptyPixelsFirst) {
  Cached c;
  const View view = camera();
  c.frame(view);
  const std::size_t some = c.goOn(view, 800);
  EXPECT_NEAR(double(some), 800, 8);
  EXPECT_LE(some, 800u);
  const CacheFrame& frame = c.frame(view);
  EXPECT_EQ(frame.held, some);
  std::size_t filled = 0;
  for (const glm::vec4& p : frame.pixels) filled += p.w > 0 && p.w < 1;
  EXPECT_GT(filled, 500u) << "neighbours fill";
  // From another place all samples are old ones: what they leave empty comes first.
  const View beside = camera({1.05, 0.1, 1.1});
  const CacheFrame& moved = c.frame(beside);
  const std::vector<glm::vec4> pixels = moved.pixels;
  double ofWanted = 0, ofAll = 0, wanted = 0;
  for (const PixelRay& ray : c.cache.wanted(300, beside)) ofWanted += double(pixels[ray.pixel].w), ++wanted;
  const auto seen = c.surfaces(beside);
  for (std::size_t p = 0; p < kPixels; ++p)
    if (seen[p] != 0) ofAll += double(pixels[p].w);
  EXPECT_NEAR(wanted, 300, 10);
  EXPECT_LT(ofWanted / wanted, 0.9 * ofAll / double(moved.wanted));
}

TEST(RenderCache, KeepsMostWhileTheCameraMoves) {
  Cached c;
  c.settle(camera());
  const View beside = camera({1.02, 0.12, 1.11});
  const CacheFrame& frame = c.frame(beside);
  EXPECT_GT(double(frame.held), 0.75 * double(frame.wanted));
  // What is shown is what is there: images move with their mirror.
  const auto traced = c.reader.trace(test::raysOf(beside, kWidth, kHeight));
  std::vector<double> off;
  for (std::size_t p = 0; p < kPixels; ++p)
    if (frame.pixels[p].w == 1)
      off.push_back(std::abs(gray(Rgb(frame.pixels[p])) - gray(traced[p].radiance)) / gray(traced[p].radiance));
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 0.02);
  EXPECT_LT(off[off.size() * 9 / 10], 0.1);
}

/// Everything that is seen is asked for, and becomes what rays find, after any edit; nothing stale stays.
TEST(RenderCache, FollowsAnEdit) {
  Cached c;
  const View view = camera();
  c.settle(view);
  c.engine.apply(TransformObject{"block", glm::translate(Mat4(1.0), Vec3(0.3, 0.2, 0.1))});
  c.engine.update();
  c.reader.refresh();
  EXPECT_GT(c.cache.retire(*c.reader.changes()), 50u);
  EXPECT_EQ(c.cache.retire(*c.reader.changes()), 0u) << "each change is looked at once";
  EXPECT_GT(double(c.frame(view).held), 0.9 * double(c.frame(view).wanted)) << "nothing turns black";
  c.settle(view);
  const CacheFrame& frame = c.frame(view);
  EXPECT_EQ(frame.held, frame.wanted);
  const auto traced = c.reader.trace(test::raysOf(view, kWidth, kHeight));
  for (std::size_t p = 0; p < kPixels; ++p)
    if (frame.pixels[p].w > 0) {
      EXPECT_NEAR(gray(Rgb(frame.pixels[p])), gray(traced[p].radiance), 0.01f * gray(traced[p].radiance)) << p;
    }
}

TEST(RenderCache, ShowsNoSampleOnAnotherSurface) {
  Cached c;
  const View view = camera();
  c.settle(view);
  std::vector<std::uint32_t> others = c.surfaces(view);
  for (std::uint32_t& s : others)
    if (s != 0) s = 1;
  const CacheFrame& frame = c.cache.frame(view, kWidth, kHeight, others);
  EXPECT_GT(frame.wanted, 0u);
  EXPECT_EQ(frame.held, 0u);
  for (const glm::vec4& p : frame.pixels) EXPECT_EQ(p, glm::vec4(0.0f));
}

/// A drawing and rays disagree at some edges. That must not be asked for over and over.
TEST(RenderCache, IsContentWhereRaysMeetSomethingElse) {
  Cached c;
  const View view = camera();
  std::vector<std::uint32_t> wide = c.surfaces(view);
  for (std::size_t p = 1; p < wide.size(); ++p)
    if (wide[p] != 0) wide[p - 1] = wide[p];
  std::size_t asked = 0;
  for (int i = 0; i < 10; ++i) {
    c.cache.frame(view, kWidth, kHeight, wide);
    asked = c.goOn(view, kPixels);
  }
  EXPECT_EQ(asked, 0u);
  const CacheFrame& frame = c.cache.frame(view, kWidth, kHeight, wide);
  EXPECT_LT(frame.held, frame.wanted);
}

TEST(RenderCache, AveragesWhatIsLeftToChance) {
  Scene scene = test::mirrorRoom();
  scene.materials[1].surface = Opaque{Rgb(0.0f), {}, {Rgb(0.9f), 0.2f, {}}};
  Cached c(test::solved(std::move(scene), 0.2).solution());
  const View view = camera();
  c.settle(view);
  const CacheFrame& frame = c.frame(view);
  auto rays = test::raysOf(view, kWidth, kHeight);
  std::vector<RgbSum> sums(kPixels, RgbSum(0.0));
  constexpr std::uint32_t kMany = 64;
  for (std::uint32_t i = 0; i < kMany; ++i) {
    for (PixelRay& r : rays) r.index = i;
    const auto traced = c.reader.trace(rays);
    for (std::size_t p = 0; p < kPixels; ++p) sums[p] += RgbSum(traced[p].radiance);
  }
  for (std::size_t p = 0; p < kPixels; ++p)
    if (frame.pixels[p].w > 0) {
      EXPECT_NEAR(gray(Rgb(frame.pixels[p])), gray(sums[p] / double(kMany)), 1e-3 * gray(sums[p])) << p;
    }
}

TEST(RenderCache, MakesRoomAndStaysSmall) {
  RenderCacheSettings settings;
  settings.samplesPerPixel = 0.5;
  Cached c(solvedRoom(), settings);
  for (int i = 0; i < 12; ++i) {
    const View view = camera({0.7 + 0.05 * i, 0.1, 1.1});
    c.frame(view);
    c.goOn(view, 600);
    EXPECT_LE(c.cache.samples().size(), kPixels / 2);
  }
  EXPECT_GT(c.cache.samples().size(), kPixels / 4);
  c.cache.clear();
  EXPECT_TRUE(c.cache.samples().empty());
}

TEST(RenderCache, LooksAheadOfTheCamera) {
  Cached c;
  View view = camera();
  view.horizontal = view.vertical = 30;
  c.settle(view);
  View turned = view;
  turned.direction = {0.25, 1, -0.15};
  c.frame(view);
  const auto rays = c.cache.wanted(1000, turned);
  EXPECT_GT(rays.size(), 5u) << "there is mirror beyond the border";
  EXPECT_LE(rays.size(), 250u);
  for (const PixelRay& r : rays) {
    const rendering::PixelPlace now = rendering::ViewProjection(view, kWidth, kHeight).ofDirection(r.direction);
    const rendering::PixelPlace then = rendering::ViewProjection(turned, kWidth, kHeight).ofDirection(r.direction);
    EXPECT_NEAR(then.x, static_cast<float>(r.pixel % kWidth) + 0.5f, 0.01f);
    EXPECT_NEAR(then.y, static_cast<float>(r.pixel / kWidth) + 0.5f, 0.01f);
    EXPECT_GT(now.x, 0.7f * kWidth);
  }
}

TEST(ViewProjection, IsTheInverseOfTheViewsRays) {
  View view = camera();
  for (const View::Kind kind : {View::Kind::Perspective, View::Kind::Parallel}) {
    view.kind = kind, view.up = {0.1, 0.2, 1};
    const rendering::ViewProjection projection(view, kWidth, kHeight);
    for (int i = 0; i < 20; ++i) {
      const double x = (i % 5 + 0.3) / 5, y = (i / 5 + 0.6) / 4;
      const ViewRay ray = viewRay(view, x, y);
      const rendering::PixelPlace at = projection(Vec3f(ray.origin + 3.0 * ray.direction));
      EXPECT_NEAR(at.x, x * kWidth, 1e-3);
      EXPECT_NEAR(at.y, y * kHeight, 1e-3);
      EXPECT_GT(at.depth, 0);
    }
  }
}

TEST(ErrorDiffusion, GivesRaysInProportion) {
  std::vector<float> priorities(100 * 100, 0.0f);
  for (std::size_t p = 0; p < priorities.size(); ++p) priorities[p] = p % 100 < 20 ? 0.0f : p % 100 < 60 ? 0.25f : 1.0f;
  const auto chosen = rendering::chooseByPriority(priorities, 100, 1000);
  EXPECT_EQ(std::set<std::uint32_t>(chosen.begin(), chosen.end()).size(), chosen.size());
  EXPECT_NEAR(double(chosen.size()), 1000, 20);
  double low = 0, high = 0;
  for (const std::uint32_t p : chosen) {
    ASSERT_GT(priorities[p], 0.0f);
    (p % 100 < 60 ? low : high) += 1;
  }
  EXPECT_NEAR(high / low, 4, 0.6);
  EXPECT_EQ(rendering::chooseByPriority(priorities, 100, 8000).size(), 8000u);
  EXPECT_TRUE(rendering::chooseByPriority(priorities, 100, 0).empty());
}

}  // namespace
}  // namespace deltalux
