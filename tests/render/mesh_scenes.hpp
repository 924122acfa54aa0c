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
  Elements elements;
  std::unique_ptr<RayTracer> tracer;
  std::vector<LeafIrradiance> values;

  explicit MeshScene(std::vector<Primitive> primitives) {
    scene.materials.push_back({"grey", Opaque{Rgb(0.5f), {}, {}}, std::nullopt});
    scene.primitives = std::move(primitives);
    elements = buildElements(scene, surfaceSides(scene));
    tracer = makeBruteForceTracer(scene);
  }

  /// Splits every leaf patch down to `least`, and further to `most` by chance.
  void splitIrregularly(int least, int most, std::uint64_t seed) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const ElementId e(i);
      if (!elements.isPatch(e) || elements.at(e).depth >= most) continue;
      if (elements.at(e).depth < least || Rng(seed, elements.key[i]).uniform() < 0.5) subdivide(elements, scene, e);
    }
  }

  /// Gives every leaf the mean of `E` over it, taken at its centre; the same direct and indirect.
  void light(const std::function<Rgb(const Vec3f& center, ElementId leaf)>& E) {
    values.assign(elements.size(), {});
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (elements.isReceivingLeaf(ElementId(i))) {
        const Rgb value = E(elements.geometry[i].center, ElementId(i));
        values[i] = {value, value};
      }
  }

  IrradianceField field(float noise = 0) const { return IrradianceField(elements, scene, *tracer, values, noise); }
};

/// Reads a field at points of a primitive's side.
struct FieldReader {
  const MeshScene& mesh;
  IrradianceField field = mesh.field();
  SideLocator locator = SideLocator(mesh.elements, mesh.scene);

  Rgb at(PrimitiveId primitive, const Vec3& p, bool front = true) const {
    const LeafPoint leaf = locator.locate(locator.side(primitive, 0, front), p);
    return field.indirect(leaf, Vec3f(p));
  }
};

}  // namespace deltalux::test
