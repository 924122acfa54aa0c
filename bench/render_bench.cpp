// render_bench NAME SOLUTION|SCENE VIEW.vf WIDTH REFERENCE SAMPLES...
//
// Noise of rendered pictures and what they cost, as CSV rows: scene, view, samples, measure, value, unit. Each picture
// is held against one of REFERENCE samples a pixel with other random numbers, or against a picture REFERENCE.exr of its
// size. Differences are of what a screen shows (tone-mapped, sRGB), both with one exposure, as per cent of white:
//   noise       root mean square over the pixels
//   seen noise  the same, once both are smoothed over three by three pixels, as an eye that stands back does
//   specks      share of pixels that are off by more than 10 %
//   time        processor time, preparations included
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <deltalux/engine.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_file.hpp>
#include <stdexcept>

#include "processor_time.hpp"

namespace deltalux::bench {
namespace {

constexpr std::uint64_t kOtherSeed = 0x5eed;
constexpr double kSpeck = 0.1;

SolutionView solved(const std::string& file) {
  if (isSolutionFile(file)) return loadSolution(file);
  Engine engine(loadScene({file}).scene);
  engine.solve();
  return engine.solution();
}

/// Gray in [0, 1] as shown.
struct Shown {
  int width, height;
  std::vector<double> value;

  Shown(const Image& image, double ev) : width(image.width), height(image.height) {
    for (const auto& p : toneMap(image, {ToneOperator::Reinhard, ev}).pixels)
      value.push_back((0.265 * p[0] + 0.670 * p[1] + 0.065 * p[2]) / 255);
  }
  Shown smoothed() const {
    Shown out = *this;
    constexpr int kWeight[] = {1, 2, 1};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0, weights = 0;
        for (int i = std::max(0, y - 1); i <= std::min(height - 1, y + 1); ++i)
          for (int j = std::max(0, x - 1); j <= std::min(width - 1, x + 1); ++j) {
            const double w = kWeight[i - y + 1] * kWeight[j - x + 1];
            sum += w * value[static_cast<std::size_t>(i) * width + j], weights += w;
          }
        out.value[static_cast<std::size_t>(y) * width + x] = sum / weights;
      }
    return out;
  }
  double rms(const Shown& other) const {
    double sum = 0;
    for (std::size_t i = 0; i < value.size(); ++i) sum += (value[i] - other.value[i]) * (value[i] - other.value[i]);
    return std::sqrt(sum / static_cast<double>(value.size()));
  }
  double specks(const Shown& other) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < value.size(); ++i) count += std::abs(value[i] - other.value[i]) > kSpeck;
    return static_cast<double>(count) / static_cast<double>(value.size());
  }
};

void measure(const std::string& name, const std::string& file, const std::string& viewFile, int width,
             const std::string& reference, const std::vector<int>& samples) {
  const SolutionView solution = solved(file);
  const View view = loadView(viewFile);
  const std::string viewName = std::filesystem::path(viewFile).stem().string();
  RenderSettings settings;
  const glm::ivec2 size = fitResolution(view, width, width);
  settings.width = size.x, settings.height = size.y;
  Image truth;
  if (reference.ends_with(".exr")) {
    truth = loadImage(reference);
    if (truth.width != size.x || truth.height != size.y) throw std::runtime_error(reference + ": is of another size");
  } else {
    settings.seed = kOtherSeed, settings.samplesPerPixel = std::stoi(reference);
    truth = render(solution, view, settings);
  }
  const double ev = automaticEv(truth);
  const Shown right(truth, ev), rightFromAfar = right.smoothed();
  settings.seed = RenderSettings{}.seed;
  for (const int n : samples) {
    settings.samplesPerPixel = n;
    const double before = processorSeconds();
    const Image image = render(solution, view, settings);
    const double took = processorSeconds() - before;
    const Shown found(image, ev);
    const auto row = [&](const char* what, double value, const char* unit) {
      fmt::print("{},{},{},{},{:.4g},{}\n", name, viewName, n, what, value, unit);
    };
    row("noise", 100 * found.rms(right), "% of white");
    row("seen noise", 100 * found.smoothed().rms(rightFromAfar), "% of white");
    row("specks", 100 * found.specks(right), "%");
    row("time", took, "s");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  if (argc < 7) {
    std::fputs("usage: render_bench NAME SOLUTION|SCENE VIEW.vf WIDTH REFERENCE SAMPLES...\n", stderr);
    return 2;
  }
  try {
    std::vector<int> samples;
    for (int i = 6; i < argc; ++i) samples.push_back(std::stoi(argv[i]));
    deltalux::bench::measure(argv[1], argv[2], argv[3], std::stoi(argv[4]), argv[5], samples);
  } catch (const std::exception& error) {
    fmt::print(stderr, "render_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
