#include <deltalux/scene.hpp>

namespace deltalux {

Box bounds(const Scene& scene) {
  Box box;
  for (const Primitive& primitive : scene.primitives) box.extend(bounds(primitive.shape));
  return box;
}

}  // namespace deltalux
