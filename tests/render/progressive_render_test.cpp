#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/io.hpp>
#include <deltalux/progressive_render.hpp>

#include "support/shared.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

struct Bundled {
  Engine engine;
  View view;

  explicit Bundled(const std::string& name)
      : engine(test::solved(loadScene({test::sourceFolder() / "scenes" / name / (name + ".rad")}).scene, 0.2)),
        view(loadView(test::sourceFolder() / "scenes" / name / (name + ".vf"))) {}
};

RenderSettings small() {
  RenderSettings settings;
  settings.width = 45, settings.height = 37, settings.samplesPerPixel = 3, settings.shadowRays = 2;
  return settings;
}

/// Every third pixel.
std::vector<char> someFirst(const RenderSettings& settings) {
  std::vector<char> first(static_cast<std::size_t>(settings.width * settings.height), 0);
  for (std::size_t p = 0; p < first.size(); p += 3) first[p] = 1;
  return first;
}

class ProgressiveRenders : public testing::TestWithParam<const char*> {};

TEST_P(ProgressiveRenders, EndAsThePictureThatIsDrawnAtOnce) {
  const Bundled scene(GetParam());
  const SolutionReader reader(scene.engine.solution());
  for (const bool meshDirect : {false, true}) {
    RenderSettings settings = small();
    settings.meshDirect = meshDirect;
    const Image whole = render(scene.engine.solution(), scene.view, settings);
    for (const double milliseconds : {0.0, 3.0, 1e6})
      for (const bool masked : {false, true}) {
        ProgressiveRender picture(reader, scene.view, settings, masked ? someFirst(settings) : std::vector<char>());
        while (!picture.step(milliseconds)) {
        }
        EXPECT_EQ(picture.image().pixels, whole.pixels) << milliseconds << masked << meshDirect;
        EXPECT_EQ(picture.image().luminousEfficacy, whole.luminousEfficacy);
        EXPECT_TRUE(picture.done());
        EXPECT_TRUE(std::all_of(picture.rays().begin(), picture.rays().end(), [](auto n) { return n == 3; }));
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ProgressiveRenders, testing::Values("cornell", "cornell-caustic"),
                         [](const auto& of) { return std::string(of.param) == "cornell" ? "Cornell" : "Caustic"; });

TEST(ProgressiveRender, GivesRaysToThoseFirstThatComeFirst) {
  const Bundled scene("cornell");
  const SolutionReader reader(scene.engine.solution());
  const RenderSettings settings = small();
  const std::vector<char> first = someFirst(settings);
  ProgressiveRender picture(reader, scene.view, settings, first);
  std::uint64_t before = 0;
  bool onlyFirst = false;
  while (!picture.step(0)) {
    std::uint64_t sum = 0;
    std::uint32_t fewestOfFirst = ~0u, mostOfOthers = 0, fewest = ~0u, most = 0;
    for (std::size_t p = 0; p < first.size(); ++p) {
      const std::uint32_t n = picture.rays()[p];
      sum += n, fewest = std::min(fewest, n), most = std::max(most, n);
      if (first[p]) fewestOfFirst = std::min(fewestOfFirst, n);
      if (!first[p]) mostOfOthers = std::max(mostOfOthers, n);
      if (n == 0) {
        EXPECT_EQ(picture.image().pixels[p], Rgb(0.0f));
      }
    }
    EXPECT_GT(sum, before) << "a step takes at least one tile on";
    EXPECT_TRUE(mostOfOthers == 0 || fewestOfFirst > 0);
    EXPECT_LE(most, fewest + 1) << "all pixels go along";
    onlyFirst = onlyFirst || (fewestOfFirst == 1 && mostOfOthers == 0);
    before = sum;
  }
  EXPECT_TRUE(onlyFirst);
}

/// A picture that is asked to stop goes no further than the tiles that were begun.
TEST(ProgressiveRender, StopsWhenItIsAsked) {
  struct Stop : Progress {
    void report(std::string_view, double) override {}
    bool stopRequested() const override { return true; }
  };
  const Bundled scene("cornell");
  const SolutionReader reader(scene.engine.solution());
  ProgressiveRender picture(reader, scene.view, small());
  const Stop stop;
  EXPECT_FALSE(picture.step(1e6, &stop));
  EXPECT_EQ(*std::min_element(picture.rays().begin(), picture.rays().end()), 0u);
}

}  // namespace
}  // namespace deltalux
