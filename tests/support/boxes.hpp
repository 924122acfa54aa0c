#pragma once
// Small scenes built in code.
#include <deltalux/scene.hpp>
#include <string>

namespace deltalux::test {

inline MaterialId addMaterial(Scene& scene, const std::string& name, const Rgb& diffuse,
                              const Rgb& radiance = Rgb(0.0f)) {
  Material m;
  m.name = name;
  m.surface = Opaque{diffuse, {}, {}};
  if (!isBlack(radiance)) m.emission = Emission{radiance, false, {}};
  scene.materials.push_back(m);
  return MaterialId(scene.materials.size() - 1);
}

inline void addPolygon(Scene& scene, const std::string& name, MaterialId material, std::vector<Vec3> vertices) {
  scene.primitives.push_back({*makePolygon(std::move(vertices)), material, internObject(scene, name, '.')});
}

/// Six walls of the box [lower, upper]; normals face inwards, or outwards for a solid block.
inline void addBox(Scene& scene, const std::string& name, MaterialId material, const Vec3& a, const Vec3& b,
                   bool inwards) {
  const auto wall = [&](const char* side, std::vector<Vec3> v) {
    if (!inwards) std::reverse(v.begin(), v.end());
    addPolygon(scene, name + "." + side, material, std::move(v));
  };
  wall("floor", {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}});
  wall("ceiling", {{a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}});
  wall("south", {{a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}});
  wall("north", {{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});
  wall("west", {{a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z}});
  wall("east", {{b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}});
}

}  // namespace deltalux::test
