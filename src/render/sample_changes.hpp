#pragma once
// What samples of a solution were read from, as it was when each thing last counted as changed: changes add up until
// they show.
#include <deltalux/pixel_sample.hpp>
#include <deltalux/scene.hpp>
#include <vector>

#include "render/irradiance_field.hpp"

namespace deltalux::rendering {

struct NotedSolution {
  /// A leaf of the irradiance field. No leaf: a key of 0.
  struct Leaf {
    std::uint64_t key = 0, neighbours = 0;
    IrradianceField::Trend trend;
  };
  struct Placed {
    PrimitiveId primitive;
    Mat4 matrix{1.0};
    bool present = true;
  };
  std::vector<Leaf> leaves;             // by element
  std::vector<std::uint64_t> textures;  // by side of a primitive: hash of its caustic textures, or 0
  std::vector<Placed> placed;           // ascending
  std::vector<Box> boxes;               // by primitive
  std::vector<MaterialId> materialOf;   // by primitive
  std::vector<Material> materials;
  std::vector<Light> lights;
  std::vector<DomeLight> backdrops;
};

}  // namespace deltalux::rendering
