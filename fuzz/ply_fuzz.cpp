// Any bytes as a mesh of PLY: one whose triangles have their vertices, or an InputError.
#include <cstdint>
#include <deltalux/error.hpp>
#include <deltalux/scene.hpp>

#include "io/planar_faces.hpp"
#include "io/ply.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    std::map<std::string, std::size_t> ignored;
    deltalux::Mesh mesh = deltalux::io::readPly({reinterpret_cast<const char*>(data), size}, "fuzz.ply", ignored);
    deltalux::Scene scene;
    scene.materials.emplace_back();
    if (!mesh.triangles.empty())
      for (deltalux::Shape& shape : deltalux::io::planarFaces(std::move(mesh)))
        scene.primitives.push_back({std::move(shape), deltalux::MaterialId(0), {}});
    validate(scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
