#include "io/gltf.hpp"

#include <deltalux/error.hpp>
#include <map>
#include <tuple>

#include "io/gltf/document.hpp"
#include "io/gltf/extension.hpp"
#include "io/gltf/instances.hpp"
#include "io/gltf/light.hpp"
#include "io/gltf/material.hpp"
#include "io/gltf/mesh.hpp"
#include "io/gltf/nodes.hpp"
#include "io/gltf/vertex_colours.hpp"
#include "io/import_file.hpp"
#include "io/import_report.hpp"
#include "io/planar_faces.hpp"

namespace deltalux::io {

namespace {

// Puts a document's nodes, one by one, into a scene.
class GltfSceneBuilder {
 public:
  GltfSceneBuilder(const GltfDocument& document, const ImportSettings& settings)
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
    if (node.mesh >= 0) {
      const std::vector<Mat4> instances = instancesOf(document_, placed.node);
      if (instances.empty()) addMesh(node.mesh, placed, placed.toWorld, object);
      if (!instances.empty()) repeated_.push_back({placed, node.mesh, object, instances});
    }
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
  }

  ImportedScene finish() {
    for (const Repeated& r : repeated_) addInstances(r);  // objects of nodes have their numbers
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

  /// A mesh that stands in several places, an object each.
  struct Repeated {
    PlacedNode placed;
    int mesh;
    ObjectId object;
    std::vector<Mat4> instances;
  };

  void addInstances(const Repeated& r) {
    for (std::size_t i = 0; i < r.instances.size(); ++i) {
      const ObjectId object(scene().objects.size());
      scene().objects.push_back({r.placed.path + "/" + std::to_string(i), r.object});
      addMesh(r.mesh, r.placed, r.placed.toWorld * r.instances[i], object);
    }
  }

  void addMesh(int index, const PlacedNode& placed, const Mat4& toWorld, ObjectId object) {
    std::optional<std::vector<Part>>& parts = meshes_[static_cast<std::size_t>(index)];
    if (!parts) parts = readParts(index);
    const std::string where = "/nodes/" + std::to_string(placed.node);
    for (const Part& part : *parts) {
      triangles_ += part.mesh.triangles.size();
      constexpr std::size_t kMostTriangles = 200'000'000;  // [limit]
      if (triangles_ > kMostTriangles)
        throw InputError(document_.name, 0, where + " brings the scene to more than 200 million triangles",
                         "leave some instances out");
      Mesh mesh = placedMesh(part.mesh, toWorld, document_.name, where, report().ignored);
      if (mesh.triangles.empty()) continue;
      ++report().surfaces["mesh primitive"];
      for (Shape& shape : planarFaces(std::move(mesh)))
        scene().primitives.push_back({std::move(shape), part.material, object});
    }
  }

  struct Part {
    Mesh mesh;  // in the coordinates of the glTF mesh
    MaterialId material;
  };

  std::vector<Part> readParts(int index) {
    const tinygltf::Mesh& source = document_.model.meshes[static_cast<std::size_t>(index)];
    std::vector<Part> parts;
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = source.primitives[i];
      const std::string where = "/meshes/" + std::to_string(index) + "/primitives/" + std::to_string(i);
      const std::optional<TextureUse> texture =
          primitive.material < 0 ? std::nullopt : materials_.texture[static_cast<std::size_t>(primitive.material)];
      std::optional<Mesh> mesh = readMesh(document_, primitive, where, texture, report().ignored);
      if (!mesh) continue;
      const MaterialId material = primitive.material < 0 ? materials_.fallback : MaterialId(primitive.material);
      const std::vector<Rgb> colours = readVertexColours(document_, primitive, mesh->positions.size(), where);
      if (colours.empty())
        parts.push_back({std::move(*mesh), material});
      else
        addColoured(std::move(*mesh), colours, primitive.material, material, parts);
    }
    return parts;
  }

  void addColoured(Mesh mesh, const std::vector<Rgb>& colours, int source, MaterialId material,
                   std::vector<Part>& parts) {
    const auto* opaque = std::get_if<Opaque>(&scene()[material].surface);
    const bool byMean = !opaque || opaque->diffuseTexture.valid() || isBlack(opaque->diffuse);
    const float metallic = source < 0 ? 0.0f : materials_.metallic[static_cast<std::size_t>(source)];
    if (opaque && opaque->diffuseTexture.valid()) ++report().ignored["vertex colours over textures (average used)"];
    for (ColouredMesh& part : colouredMeshes(std::move(mesh), colours, byMean)) {
      TextureId texture;
      if (part.texture) {
        texture = TextureId(scene().textures.size());
        scene().textures.push_back(std::move(*part.texture));
      }
      const auto key = std::tuple(material.index(), part.mean.r, part.mean.g, part.mean.b, texture.valid());
      const auto known = tinted_.find(key);
      MaterialId own = known != tinted_.end() && !part.texture ? known->second : MaterialId(scene().materials.size());
      if (own.index() == scene().materials.size())
        scene().materials.push_back(tinted(scene()[material], metallic, part.mean, texture));
      if (!part.texture) tinted_[key] = own;
      parts.push_back({std::move(part.mesh), own});
    }
  }

  const GltfDocument& document_;
  double efficacy_;
  ImportedScene imported_;
  GltfMaterials materials_;
  std::vector<std::shared_ptr<const Photometry>> profiles_;
  std::vector<std::optional<std::vector<Part>>> meshes_;  // as read, by mesh
  std::vector<Repeated> repeated_;
  std::map<std::tuple<std::size_t, float, float, float, bool>, MaterialId> tinted_;
  std::size_t triangles_ = 0;
};

}  // namespace

ImportedScene readGltf(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                       const ImportSettings& settings) {
  const GltfDocument document = openGltf(bytes, name, folder);
  GltfSceneBuilder builder(document, settings);
  for (const PlacedNode& node : placedNodes(document)) builder.add(node);
  return builder.finish();
}

ImportedScene loadGltf(const std::filesystem::path& file, const ImportSettings& settings) {
  return readGltf(readInputFile(file), file.string(), file.parent_path(), settings);
}

}  // namespace deltalux::io
