#include <algorithm>
#include <deltalux/render.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "render/eye_path.hpp"
#include "render/work_progress.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr int kTile = 16;  // pixels a side: neighbours see the same elements

class Painter {
 public:
  Painter(const Solution& s, const View& view, const RenderSettings& settings)
      : view_(view),
        settings_(settings),
        reconstruction_(s),
        paths_(s, reconstruction_, {settings.meshDirect ? 0 : settings.shadowRays, settings.maxSpecularDepth}) {}

  void paint(Image& image, int x0, int y0) const {
    for (int y = y0; y < std::min(y0 + kTile, image.height); ++y)
      for (int x = x0; x < std::min(x0 + kTile, image.width); ++x) image.at(x, y) = pixel(image, x, y);
  }

 private:
  Rgb pixel(const Image& image, int x, int y) const {
    const std::uint64_t key =
        combineKeys(settings_.seed, static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(image.width) + x);
    RgbSum sum(0.0);
    for (int s = 0; s < settings_.samplesPerPixel; ++s) {
      const UnitPair u = scrambledSobol(static_cast<std::uint32_t>(s), key);
      const ViewRay from = viewRay(view_, (x + u.x) / image.width, (y + u.y) / image.height);
      EyeRay eye;
      eye.ray.origin = Vec3f(from.origin);
      eye.ray.direction = Vec3f(from.direction);
      eye.key = key;
      eye.index = static_cast<std::uint32_t>(s);
      sum += RgbSum(paths_.radiance(eye));
    }
    return Rgb(sum / double(settings_.samplesPerPixel));
  }

  const View& view_;
  const RenderSettings& settings_;
  Reconstruction reconstruction_;
  EyePaths paths_;
};

}  // namespace

Image render(const SolutionView& solution, const View& view, const RenderSettings& settings, Progress* progress) {
  DELTALUX_CHECK(settings.width > 0 && settings.height > 0, "a picture has pixels");
  DELTALUX_CHECK(settings.samplesPerPixel > 0 && settings.shadowRays > 1, "at least one camera ray, two shadow rays");
  Image image;
  image.width = settings.width, image.height = settings.height;
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const Painter painter(solution.get(), view, settings);
  const int across = (image.width + kTile - 1) / kTile, down = (image.height + kTile - 1) / kTile;
  const auto tiles = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  WorkProgress work(progress, "render", tiles);
  parallelFor(tiles, 1, [&](std::size_t t) {
    work.begin();
    painter.paint(image, static_cast<int>(t % across) * kTile, static_cast<int>(t / across) * kTile);
    work.done();
  });
  return image;
}

}  // namespace deltalux
