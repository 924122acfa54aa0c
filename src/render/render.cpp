#include <deltalux/render.hpp>

#include "base/parallel.hpp"
#include "render/painter.hpp"
#include "render/work_progress.hpp"
#include "solution/solution.hpp"

namespace deltalux {

Image render(const SolutionView& solution, const View& view, const RenderSettings& settings, Progress* progress) {
  Image image = rendering::blankImage(solution.get(), settings);
  const rendering::Reconstruction reconstruction(solution.get());
  const rendering::Painter painter(solution.get(), reconstruction, view, settings);
  const auto samples = static_cast<std::uint32_t>(settings.samplesPerPixel);
  rendering::WorkProgress work(progress, "render", painter.tiles());
  parallelFor(painter.tiles(), 1, [&](std::size_t index) {
    work.begin();
    const rendering::Painter::Tile tile = painter.tile(index);
    rendering::Sights sights = painter.lookAround(tile);
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        RgbSum sum(0.0);
        for (std::uint32_t s = 0; s < samples; ++s) sum += RgbSum(painter.radiance(x, y, s, sights));
        image.at(x, y) = Rgb(sum / double(samples));
      }
    work.done();
  });
  return image;
}

}  // namespace deltalux
