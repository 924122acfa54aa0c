#include "render/painter.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/morton.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "direct/aim.hpp"
#include "direct/tuning.hpp"
#include "render/tuning.hpp"
#include "render/work_progress.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::uint64_t kSurveyKey = 1 << 16;  // [key]

/// Numbers pixels along a curve that keeps neighbours together: a pixel takes its stratified numbers from where its
/// neighbours' end, so that errors of neighbours cancel and what noise there is, is fine. [Ahmed20]
std::uint32_t pixelInOrder(int x, int y) {
  return static_cast<std::uint32_t>(morton(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
}

}  // namespace

Image blankImage(const Solution& s, const RenderSettings& settings) {
  DELTALUX_CHECK(settings.width > 0 && settings.height > 0, "a picture has pixels");
  DELTALUX_CHECK(settings.samplesPerPixel > 0 && settings.shadowRays > 1, "at least one camera ray, two shadow rays");
  Image image;
  image.width = settings.width, image.height = settings.height;
  image.luminousEfficacy = s.scene.luminousEfficacy;
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), Rgb(0.0f));
  return image;
}

Painter::Painter(const Solution& s, const Reconstruction& reconstruction, const View& view,
                 const RenderSettings& settings)
    : Painter(
          s, reconstruction, [view](double x, double y) { return viewRay(view, x, y); }, settings) {}

Painter::Painter(const Solution& s, const Reconstruction& reconstruction, PictureRay ray,
                 const RenderSettings& settings)
    : elements_(s.elements),
      reconstruction_(reconstruction),
      ray_(std::move(ray)),
      settings_(settings),
      across_((settings.width + tuning::kTile - 1) / tuning::kTile),
      down_((settings.height + tuning::kTile - 1) / tuning::kTile),
      paths_(s, reconstruction, {settings.meshDirect ? 0 : settings.shadowRays, settings.maxSpecularDepth}) {}

Painter::Tile Painter::tile(std::size_t index) const {
  const int x = static_cast<int>(index) % across_ * tuning::kTile,
            y = static_cast<int>(index) / across_ * tuning::kTile;
  return {x, y, std::min(x + tuning::kTile, settings_.width), std::min(y + tuning::kTile, settings_.height)};
}

Sights Painter::lookAround(const Tile& t) const {
  Sights sights(elements_, reconstruction_.sources);
  if (settings_.meshDirect) return sights;
  const std::uint64_t key = combineKeys(settings_.seed, kSurveyKey);
  for (int y = t.y0; y < t.y1; ++y)
    for (int x = t.x0; x < t.x1; ++x) paths_.survey(eyeRay(x, y, pixelInOrder(x, y), key), sights);
  const int rays = settings_.samplesPerPixel * settings_.shadowRays;
  sights.learn(std::clamp(rays / tuning::kLearningShare, 1, direct::kEstimateRays), settings_.shadowRays,
               combineKeys(key, pixelInOrder(t.x0, t.y0)));
  return sights;
}

Rgb Painter::radiance(int x, int y, std::uint32_t s, Sights& sights) const {
  const auto samples = static_cast<std::uint32_t>(settings_.samplesPerPixel);
  return paths_.radiance(eyeRay(x, y, pixelInOrder(x, y) * samples + s, settings_.seed), sights);
}

EyeRay Painter::eyeRay(int x, int y, std::uint32_t index, std::uint64_t key) const {
  const UnitPair u = scrambledSobol(index, key);
  const ViewRay from = ray_((x + u.x) / settings_.width, (y + u.y) / settings_.height);
  EyeRay eye;
  eye.ray.origin = Vec3f(from.origin);
  eye.ray.direction = Vec3f(from.direction);
  eye.key = key;
  eye.index = index;
  return eye;
}

void paint(const Painter& painter, Image& image, Progress* progress, std::string_view phase,
           const PixelChoice& chosen) {
  const auto samples = static_cast<std::uint32_t>(painter.settings().samplesPerPixel);
  WorkProgress work(progress, phase, painter.tiles());
  parallelFor(painter.tiles(), 1, [&](std::size_t index) {
    work.begin();
    const Painter::Tile tile = painter.tile(index);
    Sights sights = painter.lookAround(tile);
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        if (chosen && !chosen(x, y)) continue;
        RgbSum sum(0.0);
        for (std::uint32_t s = 0; s < samples; ++s) sum += RgbSum(painter.radiance(x, y, s, sights));
        image.at(x, y) = Rgb(sum / double(samples));
      }
    work.done();
  });
}

}  // namespace deltalux::rendering
