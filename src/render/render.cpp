#include <algorithm>
#include <deltalux/render.hpp>

#include "base/check.hpp"
#include "base/morton.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "render/eye_path.hpp"
#include "render/work_progress.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr int kTile = 32;  // pixels a side: neighbours see the same elements
constexpr std::uint64_t kSurveyKey = 1 << 16;
constexpr int kLearningShare = 2, kFewestLearning = 4, kMostLearning = 64;  // rays of a pixel over those to learn from

/// Numbers pixels along a curve that keeps neighbours together: a pixel takes its stratified numbers from where its
/// neighbours' end, so that errors of neighbours cancel and what noise there is, is fine. [Ahmed20]
std::uint32_t pixelInOrder(int x, int y) {
  return static_cast<std::uint32_t>(morton(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
}

class Painter {
 public:
  Painter(const Solution& s, const View& view, const RenderSettings& settings)
      : elements_(s.elements),
        view_(view),
        settings_(settings),
        reconstruction_(s),
        paths_(s, reconstruction_, {settings.meshDirect ? 0 : settings.shadowRays, settings.maxSpecularDepth}) {}

  /// Looks around first, then at every pixel.
  void paint(Image& image, int x0, int y0) const {
    const int x1 = std::min(x0 + kTile, image.width), y1 = std::min(y0 + kTile, image.height);
    rendering::Sights sights(elements_, reconstruction_);
    if (!settings_.meshDirect) {
      const std::uint64_t key = combineKeys(settings_.seed, kSurveyKey);
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) paths_.survey(eyeRay(image, x, y, pixelInOrder(x, y), key), sights);
      const int rays = settings_.samplesPerPixel * settings_.shadowRays;
      sights.learn(std::clamp(rays / kLearningShare, kFewestLearning, kMostLearning),
                   combineKeys(key, pixelInOrder(x0, y0)));
    }
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) image.at(x, y) = pixel(image, x, y, sights);
  }

 private:
  Rgb pixel(const Image& image, int x, int y, rendering::Sights& sights) const {
    const auto samples = static_cast<std::uint32_t>(settings_.samplesPerPixel);
    RgbSum sum(0.0);
    for (std::uint32_t s = 0; s < samples; ++s)
      sum += RgbSum(paths_.radiance(eyeRay(image, x, y, pixelInOrder(x, y) * samples + s, settings_.seed), sights));
    return Rgb(sum / double(samples));
  }

  rendering::EyeRay eyeRay(const Image& image, int x, int y, std::uint32_t index, std::uint64_t key) const {
    const UnitPair u = scrambledSobol(index, key);
    const ViewRay from = viewRay(view_, (x + u.x) / image.width, (y + u.y) / image.height);
    rendering::EyeRay eye;
    eye.ray.origin = Vec3f(from.origin);
    eye.ray.direction = Vec3f(from.direction);
    eye.key = key;
    eye.index = index;
    return eye;
  }

  const hierarchy::Elements& elements_;
  const View& view_;
  const RenderSettings& settings_;
  rendering::Reconstruction reconstruction_;
  rendering::EyePaths paths_;
};

}  // namespace

Image render(const SolutionView& solution, const View& view, const RenderSettings& settings, Progress* progress) {
  DELTALUX_CHECK(settings.width > 0 && settings.height > 0, "a picture has pixels");
  DELTALUX_CHECK(settings.samplesPerPixel > 0 && settings.shadowRays > 1, "at least one camera ray, two shadow rays");
  Image image;
  image.width = settings.width, image.height = settings.height;
  image.luminousEfficacy = solution.scene().luminousEfficacy;
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const Painter painter(solution.get(), view, settings);
  const int across = (image.width + kTile - 1) / kTile, down = (image.height + kTile - 1) / kTile;
  const auto tiles = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  rendering::WorkProgress work(progress, "render", tiles);
  parallelFor(tiles, 1, [&](std::size_t t) {
    work.begin();
    painter.paint(image, static_cast<int>(t % across) * kTile, static_cast<int>(t / across) * kTile);
    work.done();
  });
  return image;
}

}  // namespace deltalux
