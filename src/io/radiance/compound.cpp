#include "io/radiance/compound.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <span>

#include "io/obj.hpp"

namespace deltalux::io::radiance {

std::string sourceOfCompound(const RadObject& object) {
  if (object.strings.empty()) return {};
  std::filesystem::path file = object.strings[0];
  return file.replace_extension(object.type == Type::Instance ? ".rad" : ".obj").string();
}

Placement placementOfCompound(const RadObject& object) {
  Placement placement;
  const auto options = std::span<const std::string>(object.strings).subspan(1);
  std::size_t used = 0;
  placement.transform = parseTransform(options, used, object.where);
  if (used != options.size())
    throw inputError(object.where, object.typeName + " '" + object.name + "': '" + options[used].substr(0, 40) +
                                       "' is no transform option");
  if (object.modifier != "void") placement.modifier = object.modifier;
  placement.namePrefix = object.name;
  return placement;
}

std::vector<RadObject> surfacesOfObj(const std::string& text, const std::string& name, const SourceLine& where,
                                     const std::vector<RadObject>& definitions) {
  const Scene scene = readObj(text, name, {}, {}).scene;
  std::map<std::string, std::string> modifiers;  // by name of a material
  const auto modifierOf = [&](const std::string& material) {
    const auto [entry, isNew] = modifiers.try_emplace(material, "void");
    const auto defines = [&](const RadObject& object) { return !isSurface(object.type) && object.name == material; };
    if (isNew && std::ranges::any_of(definitions, defines)) entry->second = material;
    return entry->second;
  };
  std::vector<RadObject> objects;
  for (const Primitive& primitive : scene.primitives) {
    RadObject object;
    object.where = where;
    object.name = primitive.object.valid() ? scene[primitive.object].name : "mesh";
    std::ranges::replace(object.name, '/', '.');
    object.modifier = modifierOf(scene[primitive.material].name);
    if (const auto* polygon = std::get_if<Polygon>(&primitive.shape)) {
      object.type = Type::Polygon, object.typeName = "polygon";
      for (const Vec3& v : polygon->vertices)
        for (int axis = 0; axis < 3; ++axis) object.reals.push_back(v[axis] + scene.origin[axis]);
    } else {
      Mesh mesh = std::get<Mesh>(primitive.shape);
      mesh.texcoords.clear();
      for (Vec3& p : mesh.positions) p += scene.origin;
      object.type = Type::GeneratedMesh, object.typeName = "mesh";
      object.mesh = std::make_shared<const Mesh>(std::move(mesh));
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace deltalux::io::radiance
