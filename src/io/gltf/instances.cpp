#include "io/gltf/instances.hpp"

#include <deltalux/error.hpp>
#include <glm/gtc/quaternion.hpp>

#include "io/gltf/accessor.hpp"
#include "io/gltf/extension.hpp"

namespace deltalux::io {

std::vector<Mat4> instancesOf(const GltfDocument& document, int node) {
  const tinygltf::ExtensionMap& extensions = document.model.nodes[static_cast<std::size_t>(node)].extensions;
  const tinygltf::Value* extension = extensionOf(extensions, "EXT_mesh_gpu_instancing");
  if (!extension || !extension->Has("attributes")) return {};
  const tinygltf::Value& attributes = extension->Get("attributes");
  std::size_t count = 0;
  const auto read = [&](const char* name, int components) {
    if (!attributes.Has(name)) return std::vector<double>();
    std::vector<double> values = readVectors(document, attributes.Get(name).GetNumberAsInt(), components);
    const std::size_t own = values.size() / static_cast<std::size_t>(components);
    if (count != 0 && own != count)
      throw InputError(document.name, 0,
                       "/nodes/" + std::to_string(node) + " has " + std::to_string(count) + " instances, but " +
                           std::to_string(own) + " of " + name,
                       "export the scene again");
    count = own;
    return values;
  };
  const std::vector<double> places = read("TRANSLATION", 3), turns = read("ROTATION", 4), sizes = read("SCALE", 3);
  std::vector<Mat4> instances(count, Mat4(1.0));
  for (std::size_t i = 0; i < count; ++i) {
    Mat4& m = instances[i];
    if (!turns.empty()) {
      const glm::dquat q(turns[4 * i + 3], turns[4 * i], turns[4 * i + 1], turns[4 * i + 2]);
      const double length = glm::length(q);
      if (length > 0 && std::isfinite(length)) m = glm::mat4_cast(q / length);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t at = 3 * i + static_cast<std::size_t>(axis);
      if (!sizes.empty()) m[axis] *= sizes[at];
      if (!places.empty()) m[3][axis] = places[at];
    }
  }
  return instances;
}

}  // namespace deltalux::io
