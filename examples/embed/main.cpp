// Solves a scene, moves an object, and takes over the triangles and the light that this has changed.
//   embed SCENE OBJECT DX DY DZ
#include <cstdio>
#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/solution_reader.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace deltalux;

int main(int argc, char** argv) try {
  if (argc != 6) return std::fprintf(stderr, "usage: embed SCENE OBJECT DX DY DZ\n"), 2;
  SolveSettings settings;
  settings.error = 0.2;
  Engine engine(loadScene({argv[1]}).scene, settings);
  engine.solve();

  SolutionReader reader(engine.solution());
  const SolutionMesh before = reader.mesh();
  std::size_t triangles = 0;
  for (const auto& side : before.surfaces)
    if (side) triangles += side->triangles.size() / 3;
  std::printf("%zu triangles\n", triangles);

  const Vec3 offset(std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5]));
  engine.apply(TransformObject{argv[2], glm::translate(Mat4(1.0), offset)});
  const StepReport step = engine.update();
  reader.refresh();
  const MeshChange changed = changedSince(reader.mesh(), before.version);
  std::printf("moved in %.3f s: %zu sides have another shape, %zu other light\n", step.times.total,
              changed.shapes.size(), changed.lights.size());
} catch (const std::exception& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return 1;
}
