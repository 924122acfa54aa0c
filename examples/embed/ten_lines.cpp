#include <cstdio>
#include <deltalux/engine.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <deltalux/render.hpp>

int main() {
  using namespace deltalux;
  Engine engine(loadScene({"scenes/cornell/cornell.rad"}).scene, {.error = 0.1});
  engine.solve();
  engine.apply(ScaleLight{"lamp", 0.5f});
  const StepReport step = engine.update();
  std::printf("dimmed in %.3f s by %d rays\n", step.times.total, int(step.rays));
  const RenderSettings settings{.width = 200, .height = 200, .samplesPerPixel = 4};
  saveImage("cornell.png", render(engine.solution(), loadView("scenes/cornell/cornell.vf"), settings));
}
