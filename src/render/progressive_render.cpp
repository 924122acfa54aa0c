// Passes over the tiles: the pixels that come first get a ray, then the others, then all of them one by one. What a
// tile has learnt of the lights is kept from its first pass to its last.
#include <deltalux/progressive_render.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "render/painter.hpp"
#include "render/reader_state.hpp"

namespace deltalux {

struct ProgressiveRender::State {
  rendering::Painter painter;
  Image image;
  std::vector<char> first;  // by pixel
  std::vector<RgbSum> sums;
  std::vector<std::uint32_t> rays;
  std::vector<std::optional<rendering::Sights>> sights;  // by tile
  std::vector<std::uint32_t> waiting;                    // tiles of this pass
  std::uint32_t passes = 0;                              // done

  State(const rendering::ReaderState& s, const View& view, const RenderSettings& settings, std::vector<char> mask)
      : painter(s.solution(), *s.reconstruction, view, settings),
        image(rendering::blankImage(s.solution(), settings)),
        first(std::move(mask)),
        sums(image.pixels.size(), RgbSum(0.0)),
        rays(image.pixels.size(), 0),
        sights(painter.tiles()) {
    DELTALUX_CHECK(first.empty() || first.size() == image.pixels.size(), "a mask is as large as its picture");
    first.resize(image.pixels.size(), 0);
    beginPass();
  }

  bool done() const { return passes == 1 + samples(); }
  std::uint32_t samples() const { return static_cast<std::uint32_t>(painter.settings().samplesPerPixel); }
  std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * image.width + x; }

  /// Whether the pixel gets a ray in this pass: the first two passes share the pixels out among them.
  bool takesPart(std::size_t p) const { return passes >= 2 || (first[p] != 0) == (passes == 0); }

  template <class Visit>
  void forEachPixel(std::size_t tile, const Visit& visit) const {
    const rendering::Painter::Tile t = painter.tile(tile);
    for (int y = t.y0; y < t.y1; ++y)
      for (int x = t.x0; x < t.x1; ++x)
        if (const std::size_t p = pixel(x, y); takesPart(p)) visit(x, y, p);
  }

  void beginPass() {
    waiting.clear();
    for (std::uint32_t t = 0; t < painter.tiles(); ++t) {
      bool any = false;
      forEachPixel(t, [&](int, int, std::size_t) { any = true; });
      if (any) waiting.push_back(t);
    }
  }

  void paint(std::size_t tile) {
    std::optional<rendering::Sights>& own = sights[tile];
    if (!own) own.emplace(painter.lookAround(painter.tile(tile)));
    forEachPixel(tile, [&](int x, int y, std::size_t p) {
      sums[p] += RgbSum(painter.radiance(x, y, rays[p], *own));
      image.pixels[p] = Rgb(sums[p] / double(++rays[p]));
    });
    if (passes == samples()) own.reset();  // that was the last
  }

  /// As many tiles of the pass as go before `up` says so, and one where none is `begun` yet; true when none is left.
  template <class Up>
  bool goOn(std::atomic<bool>& begun, const Up& up) {
    std::vector<char> painted(waiting.size(), 0);
    parallelFor(waiting.size(), 1, [&](std::size_t i) {
      if (begun.exchange(true) && up()) return;
      paint(waiting[i]);
      painted[i] = 1;
    });
    std::size_t left = 0;
    for (std::size_t i = 0; i < waiting.size(); ++i)
      if (!painted[i]) waiting[left++] = waiting[i];
    waiting.resize(left);
    return left == 0;
  }
};

ProgressiveRender::ProgressiveRender(const SolutionReader& reader, const View& view, const RenderSettings& settings,
                                     std::vector<char> first)
    : state_(std::make_unique<State>(reader.state(), view, settings, std::move(first))) {}
ProgressiveRender::~ProgressiveRender() = default;
ProgressiveRender::ProgressiveRender(ProgressiveRender&&) noexcept = default;
ProgressiveRender& ProgressiveRender::operator=(ProgressiveRender&&) noexcept = default;

bool ProgressiveRender::step(double milliseconds, const Progress* progress) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double, std::milli>(milliseconds);
  const auto up = [&] { return Clock::now() >= end || (progress && progress->stopRequested()); };
  State& s = *state_;
  std::atomic<bool> begun = false;
  while (!s.done() && s.goOn(begun, up)) {
    ++s.passes;
    if (!s.done()) s.beginPass();
  }
  return s.done();
}

bool ProgressiveRender::done() const { return state_->done(); }
const Image& ProgressiveRender::image() const { return state_->image; }
std::span<const std::uint32_t> ProgressiveRender::rays() const { return state_->rays; }

}  // namespace deltalux
