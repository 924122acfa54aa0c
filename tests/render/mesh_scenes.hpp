#pragma once
// Small scenes with hand-made meshes: elements split irregularly and given any irradiance, without a solver.
#include <deltalux/scene.hpp>
#include <functional>
#include <memory>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "render/irradiance_field.hpp"

namespace deltalux::test {

inline Primitive polygon(std::vector<Vec3> vertices) {
  return {*makePolygon(std::move(vertices)), MaterialId(0), ObjectId()};
}
/// A unit square in the plane z = 0 from (x, y), facing up.
inline Primitive square(double x, double y, double size = 1) {
  return polygon({{x, y, 0}, {x + size, y, 0}, {x + size, y + size, 0}, {x, y + size, 0}});
}

struct MeshScene {
  Scene scene;
  hierarchy::Elements elements;
  std::unique_ptr<tracing::RayTracer> tracer;
  std::vector<rendering::LeafIrradiance> values;

  explicit MeshScene(std::vector<Primitive> primitives) {
    scene.materials.push_back({"grey", Opaque{Rgb(0.5f), {}, {}}, std::nullopt});
    scene.primitives = std::move(primitives);
    elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    tracer = tracing::makeBruteForceTracer(scene);
  }

  /// Splits every leaf patch down to `least`, and further to `most` by chance.
  void splitIrregularly(int least, int most, std::uint64_t seed) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const hierarchy::ElementId e(i);
      if (!elements.isPatch(e) || elements.at(e).depth >= most) continue;
      if (elements.at(e).depth < least || Rng(seed, elements.key[i]).uniform() < 0.5)
        hierarchy::subdivide(elements, scene, e);
    }
  }

  /// Gives every leaf the mean of `E` over it, taken at its centre; the same direct and indirect.
  void light(const std::function<Rgb(const Vec3f& center, hierarchy::ElementId leaf)>& E) {
    values.assign(elements.size(), {});
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (elements.isReceivingLeaf(hierarchy::ElementId(i))) {
        const Rgb value = E(elements.geometry[i].center, hierarchy::ElementId(i));
        values[i] = {value, value};
      }
  }

  rendering::IrradianceField field(float noise = 0) const {
    return rendering::IrradianceField(elements, scene, *tracer, values, noise);
  }
};

/// Reads a field at points of a primitive's side.
struct FieldReader {
  const MeshScene& mesh;
  rendering::IrradianceField field = mesh.field();
  hierarchy::SideLocator locator = hierarchy::SideLocator(mesh.elements, mesh.scene);

  Rgb at(PrimitiveId primitive, const Vec3& p, bool front = true) const {
    const hierarchy::LeafPoint leaf = locator.locate(locator.side(primitive, 0, front), p);
    return field.indirect(leaf, Vec3f(p));
  }
};

}  // namespace deltalux::test
