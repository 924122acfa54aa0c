#include <deltalux/render.hpp>

#include "render/painter.hpp"
#include "solution/solution.hpp"

namespace deltalux {

Image render(const SolutionView& solution, const View& view, const RenderSettings& settings, Progress* progress) {
  Image image = rendering::blankImage(solution.get(), settings);
  const rendering::Reconstruction reconstruction(solution.get());
  const rendering::Painter painter(solution.get(), reconstruction, view, settings);
  rendering::paint(painter, image, progress, "render");
  return image;
}

}  // namespace deltalux
