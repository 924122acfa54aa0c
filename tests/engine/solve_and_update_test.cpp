// The whole way of a solution in one small scene: solved, edited, shown in motion, written, read, measured and looked
// at. What it computes is tested elsewhere; the sanitizers' run wants every layer walked through.
#include <gtest/gtest.h>
#include <deltalux/engine.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_file.hpp>

#include "support/furnished_room.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

Mat4 translation(const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return matrix;
}

double meanIrradiance(const SolutionView& solution) {
  const std::vector<ProbePoint> points = {
      {{1.5, 1.7, 0.76}, {0, 0, 1}}, {{0.4, 3.2, 0.001}, {0, 0, 1}}, {{1.5, 2.0, 1.5}, {0, 0, -1}}};
  ProbeSettings settings;
  settings.error = 0.05;
  double sum = 0;
  for (const ProbeResult& result : probe(solution, points, settings))
    sum += result.irradiance.g / static_cast<double>(points.size());
  return sum;
}

TEST(SolveAndUpdate, ASmallRoomAllTheWay) {
  SolveSettings settings;
  settings.error = 0.3;
  Engine engine(test::furnishedRoom(), settings);
  EXPECT_TRUE(engine.solve().converged);
  const double before = meanIrradiance(engine.solution());
  EXPECT_GT(before, 0.0);

  const Restore back = engine.apply(TransformObject{"pot", translation({0.2, 0.1, 0})});
  EXPECT_GT(engine.update().leavesChanged, 0u);
  engine.select("box");
  for (int i = 0; i < 3; ++i) {
    engine.apply(TransformObject{"box", translation({-0.05, 0.05, 0})});
    engine.frame(5);
  }
  engine.apply(SetMaterial{"wood", Rgb(0.2f), {}});
  engine.apply(RemoveObject{"table"});
  engine.update();
  EXPECT_NO_THROW(engine.apply(back));
  engine.update();

  const test::TempFolder folder;
  const std::filesystem::path file = folder.path() / "room.dlx";
  saveSolution(file, engine.solution());
  const SolutionView read = loadSolution(file);
  EXPECT_EQ(meanIrradiance(read), meanIrradiance(engine.solution()));

  RenderSettings picture;
  picture.width = 24, picture.height = 18, picture.samplesPerPixel = 2, picture.shadowRays = 2;
  View view;
  view.position = {0.3, 0.3, 1.6}, view.direction = glm::normalize(Vec3(1.2, 1.6, -0.8));
  double light = 0;
  for (const Rgb& pixel : render(read, view, picture).pixels) light += pixel.g;
  EXPECT_GT(light, 0.0);
}

}  // namespace
}  // namespace deltalux
