// The paper's story, by script: a container is dragged along its dresser into the sun that a mirror throws across the
// room, and an armchair across the room. Once settled, what the viewer shows is what `deltalux render` makes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <deltalux/image_io.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::runCli;

constexpr double kEv = -0.6;

bool isEdge(const DisplayImage& image, int x, int y) {
  constexpr int kEdge = 32;
  for (int channel = 0; channel < 3; ++channel) {
    int least = 255, most = 0;
    for (int v = std::max(0, y - 1); v <= std::min(image.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(image.width - 1, x + 1); ++u) {
        const int value = image.at(u, v)[static_cast<std::size_t>(channel)];
        least = std::min(least, value), most = std::max(most, value);
      }
    if (most - least > kEdge) return true;
  }
  return false;
}

/// Relative root mean square of the differences on a screen, outside edges.
double differenceOnScreen(const std::filesystem::path& seen, const std::filesystem::path& rendered) {
  const DisplayImage a = toneMap(loadImage(seen), {ToneOperator::Reinhard, kEv}),
                     b = toneMap(loadImage(rendered), {ToneOperator::Reinhard, kEv});
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  double squares = 0, sum = 0;
  for (int y = 0; y < b.height; ++y)
    for (int x = 0; x < b.width; ++x) {
      if (isEdge(b, x, y)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = double(a.at(x, y)[k]) - double(b.at(x, y)[k]);
        squares += d * d, sum += double(b.at(x, y)[k]) * double(b.at(x, y)[k]);
      }
    }
  return std::sqrt(squares / sum);
}

TEST(ViewLodge, WhatSettlesIsWhatRenderMakes) {
  if (!test::hasDisplayServer()) GTEST_SKIP() << "no Xvfb here: scripts/install-deps";
  const test::TempFolder folder;
  const auto file = [&](const std::string& name) { return (folder / name).string(); };
  const std::string view =
      folder.write("bed.vf", "rview -vtv -vp 3.1 .16 1.6 -vd -.30 .95 -.16 -vu 0 0 1 -vh 88 -vv 71.829117\n");
  ASSERT_EQ(
      runCli({"solve", bundledScene("lodge/morning.rad"), "--seconds", "45", "-o", file("0.dlx"), "--quiet"}).exitCode,
      0);
  std::string script = "size 320 240\nwait settled\n";
  for (int i = 1; i <= 4; ++i)
    script +=
        fmt::format("select container\ndrag 0 0.25 0 frames 10\nselect nothing\nwait finished\nradiance {}\nsave {}\n",
                    file(fmt::format("{}.exr", i)), file(fmt::format("{}.dlx", i)));
  script +=
      fmt::format("select armchair\ndrag -0.8 -2.2 0 frames 40\nselect nothing\nwait finished\nradiance {}\nsave {}\n",
                  file("5.exr"), file("5.dlx"));
  const test::CliResult played =
      test::runCliWithDisplay({"view", file("0.dlx"), "--view", view, "--ev", fmt::format("{}", kEv), "--script",
                               folder.write("s.script", script)});
  ASSERT_EQ(played.exitCode, 0) << played.err << played.out;
  for (int i = 1; i <= 5; ++i) {
    const std::string exr = file(fmt::format("r{}.exr", i));
    ASSERT_EQ(
        runCli({"render", file(fmt::format("{}.dlx", i)), "--view", view, "--size", "320x240", "-o", exr, "--quiet"})
            .exitCode,
        0);
    EXPECT_LT(differenceOnScreen(file(fmt::format("{}.exr", i)), exr), 0.05) << "position " << i;
  }
}

}  // namespace
}  // namespace deltalux
