#include "io/gltf.hpp"

#include <deltalux/error.hpp>

#include "io/gltf/document.hpp"
#include "io/gltf/extension.hpp"
#include "io/gltf/light.hpp"
#include "io/gltf/material.hpp"
#include "io/gltf/mesh.hpp"
#include "io/gltf/nodes.hpp"
#include "io/import_file.hpp"
#include "io/import_report.hpp"
#include "io/planar_faces.hpp"

namespace deltalux::io {

namespace {

// Puts a document's nodes, one by one, into a scene.
class SceneBuilder {
 public:
  SceneBuilder(const GltfDocument& document, const ImportSettings& settings)
      : document_(document), efficacy_(settings.luminousEfficacy), meshes_(document.model.meshes.size()) {
    scene().up = {0, 1, 0};
    scene().luminousEfficacy = efficacy_;
    materials_ = addMaterials(document, efficacy_, scene(), report().ignored);
    profiles_ = readProfiles(document, report().warnings);
  }

  void add(const PlacedNode& placed) {
    const ObjectId object(scene().objects.size());
    scene().objects.push_back({placed.path, placed.parent < 0 ? ObjectId() : ObjectId(placed.parent)});
    const tinygltf::Node& node = document_.model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.mesh >= 0) addMesh(node.mesh, placed, object);
    if (node.camera >= 0) {
      const tinygltf::Camera& camera = document_.model.cameras[static_cast<std::size_t>(node.camera)];
      scene().views.push_back(viewOf(camera, placed.toWorld, placed.path));
    }
    if (const tinygltf::Value* punctual = extensionOf(node.extensions, "KHR_lights_punctual")) {
      addPunctual(static_cast<std::size_t>(numberOf(punctual, "light", 0)), placed);
    }
    if (const tinygltf::Value* measured = extensionOf(node.extensions, "EXT_lights_ies")) {
      scene().lights.push_back(measuredLight(*measured, profiles_, placed.toWorld, efficacy_, placed.path));
    }
    if (node.extensions.contains("EXT_mesh_gpu_instancing")) ++report().ignored["EXT_mesh_gpu_instancing"];
  }

  ImportedScene finish() {
    const auto count = [&](const char* kind, std::size_t number) {
      if (number > 0) report().ignored[kind] += number;
    };
    count("skins", document_.skins);
    count("animations", document_.animations);
    if (document_.model.scenes.size() > 1) count("other scenes", document_.model.scenes.size() - 1);
    warnOfIgnored(report());
    addAreaLights(scene());
    return std::move(imported_);
  }

 private:
  Scene& scene() { return imported_.scene; }
  ImportReport& report() { return imported_.report; }

  void addPunctual(std::size_t index, const PlacedNode& placed) {
    if (index >= document_.model.lights.size()) return;
    const tinygltf::Light& light = document_.model.lights[index];
    scene().lights.push_back(punctualLight(light, placed.toWorld, efficacy_, placed.path));
    if (light.range > 0) ++report().ignored["ranges of lights"];
  }

  void addMesh(int index, const PlacedNode& placed, ObjectId object) {
    const tinygltf::Mesh& source = document_.model.meshes[static_cast<std::size_t>(index)];
    std::vector<std::optional<Mesh>>& meshes = meshes_[static_cast<std::size_t>(index)];
    if (meshes.empty()) meshes = readPrimitives(source, index);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      if (!meshes[i]) continue;
      const std::string where = "/nodes/" + std::to_string(placed.node);
      Mesh mesh = placedMesh(*meshes[i], placed.toWorld, document_.name, where, report().ignored);
      if (mesh.triangles.empty()) continue;
      ++report().surfaces["mesh primitive"];
      const int material = source.primitives[i].material;
      for (Shape& shape : planarFaces(std::move(mesh))) {
        scene().primitives.push_back(
            {std::move(shape), material < 0 ? materials_.fallback : MaterialId(material), object});
      }
    }
  }

  std::vector<std::optional<Mesh>> readPrimitives(const tinygltf::Mesh& source, int index) {
    std::vector<std::optional<Mesh>> meshes;
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = source.primitives[i];
      const std::string where = "/meshes/" + std::to_string(index) + "/primitives/" + std::to_string(i);
      const std::optional<TextureUse> texture =
          primitive.material < 0 ? std::nullopt : materials_.texture[static_cast<std::size_t>(primitive.material)];
      meshes.push_back(readMesh(document_, primitive, where, texture, report().ignored));
    }
    return meshes;
  }

  const GltfDocument& document_;
  double efficacy_;
  ImportedScene imported_;
  GltfMaterials materials_;
  std::vector<std::shared_ptr<const Photometry>> profiles_;
  std::vector<std::vector<std::optional<Mesh>>> meshes_;  // as read, by mesh and primitive
};

}  // namespace

ImportedScene readGltf(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                       const ImportSettings& settings) {
  const GltfDocument document = openGltf(bytes, name, folder);
  SceneBuilder builder(document, settings);
  for (const PlacedNode& node : placedNodes(document)) builder.add(node);
  return builder.finish();
}

ImportedScene loadGltf(const std::filesystem::path& file, const ImportSettings& settings) {
  return readGltf(readInputFile(file), file.string(), file.parent_path(), settings);
}

}  // namespace deltalux::io
