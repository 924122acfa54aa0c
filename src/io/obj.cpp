#include "io/obj.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <istream>
#include <map>

#include "io/import_file.hpp"
#include "io/import_report.hpp"
#include "io/obj/check.hpp"
#include "io/obj/faces.hpp"
#include "io/obj/lines.hpp"
#include "io/obj/material.hpp"
#include "io/obj/tinyobj.hpp"
#include "io/planar_faces.hpp"

namespace deltalux::io {

namespace {

std::string objectName(std::string name) {
  const std::size_t end = name.find_last_not_of(" \t");
  name.erase(end == std::string::npos ? 0 : end + 1);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

// Takes what tinyobjloader finds, in the order of the file.
class ObjCollector {
 public:
  ObjCollector(const std::string& name, const LineStreambuf& lines, std::map<std::string, MaterialId> materials,
               ImportedScene& imported)
      : name_(name), lines_(lines), materials_(std::move(materials)), imported_(imported) {}

  void vertex(const Vec3& position) { vertices_.positions.push_back(position); }
  void normal(const Vec3& direction) { vertices_.normals.push_back(direction); }
  void texcoord(const Vec2& at) { vertices_.texcoords.push_back(at); }

  void face(const tinyobj::index_t* corners, int count) {
    if (count < 3) {
      ++imported_.report.ignored["faces of fewer than 3 corners"];
      return;
    }
    std::vector<ObjCorner> face;
    for (int i = 0; i < count; ++i) {
      face.push_back({resolve(corners[i].vertex_index, vertices_.positions.size(), "vertex", true),
                      resolve(corners[i].texcoord_index, vertices_.texcoords.size(), "texture vertex", false),
                      resolve(corners[i].normal_index, vertices_.normals.size(), "normal", false)});
    }
    groups_[{objectPath(), materialName_}].push_back(std::move(face));
  }

  void useMaterial(std::string name) {
    const std::size_t end = name.find_last_not_of(" \t");
    name.erase(end == std::string::npos ? 0 : end + 1);
    materialName_ = std::move(name);
  }
  void beginObject(const std::string& name) { object_ = objectName(name), group_.clear(); }
  void beginGroup(const std::string& name) { group_ = objectName(name); }

  void finish() {
    for (const auto& [key, faces] : groups_) {
      const auto& [path, materialName] = key;
      const MaterialId material = materialOf(materialName);
      const ObjectId object = path.empty() ? ObjectId() : internObject(imported_.scene, path, '/');
      Mesh mesh = meshOf(vertices_, faces, isTextured(material), imported_.report.ignored);
      if (mesh.triangles.empty()) continue;
      for (Shape& shape : planarFaces(std::move(mesh))) {
        imported_.scene.primitives.push_back({std::move(shape), material, object});
      }
    }
  }

 private:
  // Counted from 1, or backwards from -1; -1 for an index that is not there and need not be.
  int resolve(int index, std::size_t count, const char* what, bool required) const {
    if (index == 0 && !required) return -1;
    const std::int64_t resolved = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
    if (index != 0 && resolved >= 0 && resolved < static_cast<std::int64_t>(count)) return static_cast<int>(resolved);
    throw InputError(
        name_, lines_.line(),
        "the face refers to " + std::string(what) + " " + std::to_string(index) + " of " + std::to_string(count),
        "export the file again");
  }

  std::string objectPath() const {
    return object_.empty() || group_.empty() ? object_ + group_ : object_ + "/" + group_;
  }

  MaterialId materialOf(const std::string& name) {
    const auto [entry, isNew] = materials_.try_emplace(name, MaterialId(imported_.scene.materials.size()));
    if (isNew) {
      if (!name.empty()) ++imported_.report.ignored["materials not defined (grey instead)"];
      imported_.scene.materials.push_back({name.empty() ? "default" : name, Opaque{Rgb(0.5f), {}, {}}, std::nullopt});
    }
    return entry->second;
  }

  bool isTextured(MaterialId material) const {
    const auto* opaque = std::get_if<Opaque>(&imported_.scene[material].surface);
    return opaque && opaque->diffuseTexture.valid();
  }

  const std::string& name_;
  const LineStreambuf& lines_;
  std::map<std::string, MaterialId> materials_;
  ImportedScene& imported_;
  ObjVertices vertices_;
  std::string object_, group_, materialName_;
  std::map<std::pair<std::string, std::string>, std::vector<std::vector<ObjCorner>>> groups_;
};

tinyobj::callback_t callbacks() {
  static constexpr auto collector = [](void* user) -> ObjCollector& { return *static_cast<ObjCollector*>(user); };
  tinyobj::callback_t callback;
  callback.vertex_cb = [](void* user, double x, double y, double z, double) { collector(user).vertex({x, y, z}); };
  callback.normal_cb = [](void* user, double x, double y, double z) { collector(user).normal({x, y, z}); };
  callback.texcoord_cb = [](void* user, double u, double v, double) { collector(user).texcoord({u, v}); };
  callback.index_cb = [](void* user, tinyobj::index_t* corners, int count) { collector(user).face(corners, count); };
  callback.usemtl_cb = [](void* user, const char* name, int) { collector(user).useMaterial(name); };
  callback.object_cb = [](void* user, const char* name) { collector(user).beginObject(name); };
  callback.group_cb = [](void* user, const char** names, int count) {
    std::string joined;
    for (int i = 0; i < count; ++i) joined += (i > 0 ? "_" : "") + std::string(names[i]);
    collector(user).beginGroup(joined);
  };
  return callback;
}

}  // namespace

ImportedScene readObj(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                      const ImportSettings& settings) {
  const ObjSurvey survey = surveyObj(text, name);
  if (survey.faces == 0) throw InputError(name, 0, "has no faces", "give a Wavefront OBJ file with polygons");
  ImportedScene imported;
  imported.scene.up = {0, 1, 0};
  imported.scene.metresPerUnit = settings.metresPerUnit;
  imported.report.ignored = survey.ignored;
  imported.report.surfaces["face"] = survey.faces;
  auto materials = addObjMaterials(survey, name, folder, imported.scene, imported.report.ignored);

  LineStreambuf lines(text);
  ObjCollector collector(name, lines, std::move(materials), imported);
  std::istream stream(&lines);
  tinyobj::LoadObjWithCallback(stream, callbacks(), &collector, nullptr, nullptr, nullptr);
  collector.finish();
  warnOfIgnored(imported.report);
  addAreaLights(imported.scene);
  return imported;
}

ImportedScene loadObj(const std::filesystem::path& file, const ImportSettings& settings) {
  return readObj(readInputFile(file), file.string(), file.parent_path(), settings);
}

}  // namespace deltalux::io
