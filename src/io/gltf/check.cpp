#include "io/gltf/check.hpp"

#include <array>
#include <cmath>
#include <deltalux/math.hpp>
#include <string_view>

#include "io/json_view.hpp"

namespace deltalux::io {

namespace {

constexpr double kHuge = 1e15;                                   // of coordinates and factors [limit]
constexpr std::int64_t kMaxBytes = std::int64_t{1} << 40;        // of buffers and offsets [limit]
constexpr std::int64_t kMaxCount = (std::int64_t{1} << 31) - 1;  // [limit]

// How a required extension is met.
enum class Support { Understood, Ignored, Compressed, Unknown };

Support supportOf(std::string_view extension) {
  constexpr std::array<std::string_view, 12> understood{"KHR_lights_punctual",     "KHR_materials_emissive_strength",
                                                        "KHR_materials_ior",       "KHR_materials_transmission",
                                                        "KHR_materials_volume",    "KHR_materials_specular",
                                                        "KHR_materials_unlit",     "KHR_texture_transform",
                                                        "KHR_mesh_quantization",   "EXT_lights_ies",
                                                        "EXT_mesh_gpu_instancing", "EXT_meshopt_compression"};
  constexpr std::array<std::string_view, 5> compressed{"KHR_draco_mesh_compression", "KHR_meshopt_compression",
                                                       "KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif"};
  for (const std::string_view known : understood) {
    if (extension == known) return Support::Understood;
  }
  for (const std::string_view known : compressed) {
    if (extension == known) return Support::Compressed;
  }
  // Refinements of materials and metadata change nothing that is read.
  const bool harmless =
      (extension.starts_with("KHR_materials_") && extension != "KHR_materials_pbrSpecularGlossiness") ||
      extension.starts_with("KHR_xmp") || extension == "KHR_animation_pointer";
  return harmless ? Support::Ignored : Support::Unknown;
}

InputError needsUnread(const std::string& file, const std::string& what, const std::string& extension) {
  return InputError(file, 0, what + " needs " + extension + ", which is not read",
                    "export the scene without compression, textures as PNG or JPEG");
}

void checkAsset(const JsonView& document, const std::string& file) {
  const JsonView version = document.member("asset").member("version");
  version.expectPresent("this is not a glTF document");
  version.expectString();
  const auto text = version.value().get<std::string>();
  if (!text.starts_with("2.")) {
    throw InputError(file, 0, "is glTF of version '" + text.substr(0, 20) + "', not 2", "convert it to glTF 2.0");
  }
}

void checkRequiredExtensions(const JsonView& document, const std::string& file) {
  for (const JsonView& required : document.member("extensionsRequired").elements()) {
    required.expectString();
    const auto name = required.value().get<std::string>();
    const Support support = supportOf(name);
    if (support == Support::Compressed) throw needsUnread(file, "the scene", name);
    if (support == Support::Unknown) {
      throw InputError(file, 0, "needs the extension '" + name.substr(0, 60) + "', which is not read",
                       "export the scene without it");
    }
  }
}

// A view whose buffer is there can be read as it is: the compressed bytes are an alternative then.
// [EXT_meshopt_compression, "Fallback buffers"]
void checkCompression(const JsonView& view, const JsonView& buffer, std::size_t buffers, const std::string& file,
                      const std::string& where) {
  if (view.member("extensions").member("KHR_meshopt_compression").present()) {
    const JsonView fallback = buffer.member("extensions").member("KHR_meshopt_compression").member("fallback");
    fallback.expectBool();
    const bool empty = fallback.present() && fallback.value().get<bool>() && !buffer.member("uri").present();
    if (empty) throw needsUnread(file, where, "KHR_meshopt_compression");
  }
  const JsonView packed = view.member("extensions").member("EXT_meshopt_compression");
  if (!packed.present()) return;
  packed.expectObject();
  packed.member("buffer").expectPresent("the index of the buffer with the compressed bytes");
  packed.member("buffer").expectIndex(buffers);
  packed.member("byteOffset").expectInteger(0, kMaxBytes);
  packed.member("byteLength").expectInteger(1, kMaxBytes);
  packed.member("byteStride").expectInteger(1, 256);
  packed.member("count").expectInteger(1, kMaxCount);
  for (const char* key : {"mode", "filter"}) packed.member(key).expectString();
}

void checkBuffers(const JsonView& document, const std::string& file) {
  for (const JsonView& buffer : document.member("buffers").objects()) {
    buffer.member("byteLength").expectPresent("its size in bytes");
    buffer.member("byteLength").expectInteger(1, kMaxBytes);
    buffer.member("uri").expectString();
    const JsonView extensions = buffer.member("extensions");
    extensions.expectObject();
    extensions.member("EXT_meshopt_compression").expectObject();
    extensions.member("EXT_meshopt_compression").member("fallback").expectBool();
  }
  const std::vector<JsonView> buffers = document.member("buffers").objects();
  std::size_t index = 0;
  for (const JsonView& view : document.member("bufferViews").objects()) {
    view.member("buffer").expectPresent("the index of its buffer");
    view.member("buffer").expectIndex(buffers.size());
    checkCompression(view, buffers[view.member("buffer").value().get<std::size_t>()], buffers.size(), file,
                     "/bufferViews/" + std::to_string(index++));
    view.member("byteLength").expectPresent("its size in bytes");
    view.member("byteLength").expectInteger(1, kMaxBytes);
    view.member("byteOffset").expectInteger(0, kMaxBytes);
    view.member("byteStride").expectInteger(4, 252);
  }
}

void checkComponentType(const JsonView& type) {
  type.expectPresent("the type of its components");
  type.expectInteger(5120, 5126);
  if (type.value() == 5124) type.fail("is 5124, which glTF does not know");
}

void checkAccessors(const JsonView& document) {
  const std::size_t views = document.member("bufferViews").size();
  for (const JsonView& accessor : document.member("accessors").objects()) {
    accessor.member("bufferView").expectIndex(views);
    accessor.member("byteOffset").expectInteger(0, kMaxBytes);
    accessor.member("count").expectPresent("the number of its elements");
    accessor.member("count").expectInteger(1, kMaxCount);
    accessor.member("normalized").expectBool();
    accessor.member("type").expectPresent("the type of its elements");
    accessor.member("type").expectString();
    checkComponentType(accessor.member("componentType"));
    const JsonView sparse = accessor.member("sparse");
    if (!sparse.present()) continue;
    sparse.member("count").expectPresent("the number of changed elements");
    sparse.member("count").expectInteger(1, kMaxCount);
    checkComponentType(sparse.member("indices").member("componentType"));
    for (const char* part : {"indices", "values"}) {
      sparse.member(part).member("bufferView").expectPresent("the index of a buffer view");
      sparse.member(part).member("bufferView").expectIndex(views);
      sparse.member(part).member("byteOffset").expectInteger(0, kMaxCount);
    }
  }
}

// Where the accessors of a primitive have no data, an extension has it: the file has no uncompressed alternative.
void checkData(const JsonView& primitive, const std::vector<JsonView>& accessors, const std::string& file,
               const std::string& where) {
  std::vector<JsonView> used = primitive.member("attributes").members();
  if (primitive.member("indices").present()) used.push_back(primitive.member("indices"));
  for (const JsonView& index : used) {
    const JsonView& accessor = accessors[index.value().get<std::size_t>()];
    if (accessor.member("bufferView").present() || accessor.member("sparse").present()) continue;
    const JsonView extensions = primitive.member("extensions");
    std::string needed;
    if (!extensions.members().empty()) {
      for (const auto& [name, value] : extensions.value().items())
        if (needed.empty() || supportOf(name) == Support::Compressed) needed = name;
    }
    if (!needed.empty()) throw needsUnread(file, where, needed.substr(0, 60));
  }
}

void checkMeshes(const JsonView& document, const std::string& file) {
  const std::vector<JsonView> accessors = document.member("accessors").objects();
  std::size_t meshIndex = 0;
  for (const JsonView& mesh : document.member("meshes").objects()) {
    std::size_t index = 0;
    const std::string where = "/meshes/" + std::to_string(meshIndex++) + "/primitives/";
    for (const JsonView& primitive : mesh.member("primitives").objects()) {
      primitive.member("attributes").expectPresent("the vertices");
      for (const JsonView& attribute : primitive.member("attributes").members())
        attribute.expectIndex(accessors.size());
      primitive.member("indices").expectIndex(accessors.size());
      checkData(primitive, accessors, file, where + std::to_string(index++));
      primitive.member("material").expectIndex(document.member("materials").size());
      primitive.member("mode").expectInteger(0, 6);
      primitive.member("targets").elements();
    }
  }
}

void checkImages(const JsonView& document) {
  for (const JsonView& image : document.member("images").objects()) {
    image.member("uri").expectString();
    image.member("bufferView").expectIndex(document.member("bufferViews").size());
    if (image.member("uri").present() == image.member("bufferView").present()) {
      image.fail("must have either a uri or a bufferView");
    }
  }
  for (const JsonView& texture : document.member("textures").objects()) {
    texture.member("source").expectIndex(document.member("images").size());
    texture.member("sampler").expectIndex(document.member("samplers").size());
  }
  document.member("samplers").objects();
}

void checkTextureInfo(const JsonView& info, const JsonView& document) {
  if (!info.present()) return;
  info.member("index").expectPresent("the index of a texture");
  info.member("index").expectIndex(document.member("textures").size());
  info.member("texCoord").expectInteger(0, 100);
  const JsonView transform = info.member("extensions").member("KHR_texture_transform");
  transform.member("offset").expectNumbers(2, -kHuge, kHuge);
  transform.member("scale").expectNumbers(2, -kHuge, kHuge);
  transform.member("rotation").expectNumber(-kHuge, kHuge);
  transform.member("texCoord").expectInteger(0, 100);
}

void checkMaterialExtensions(const JsonView& extensions, const JsonView& document) {
  extensions.member("KHR_materials_emissive_strength").member("emissiveStrength").expectNumber(0, kHuge);
  const JsonView ior = extensions.member("KHR_materials_ior").member("ior");
  ior.expectNumber(0, 100);
  if (ior.present() && ior.value().get<double>() != 0) ior.expectNumber(1, 100);
  const JsonView transmission = extensions.member("KHR_materials_transmission");
  transmission.member("transmissionFactor").expectNumber(0, 1);
  checkTextureInfo(transmission.member("transmissionTexture"), document);
  const JsonView volume = extensions.member("KHR_materials_volume");
  volume.member("thicknessFactor").expectNumber(0, kHuge);
  volume.member("attenuationDistance").expectNumber(1e-9, kInfinity);
  volume.member("attenuationColor").expectNumbers(3, 0, 1);
  const JsonView specular = extensions.member("KHR_materials_specular");
  specular.member("specularFactor").expectNumber(0, 1);
  specular.member("specularColorFactor").expectNumbers(3, 0, kHuge);
}

void checkMaterials(const JsonView& document) {
  for (const JsonView& material : document.member("materials").objects()) {
    const JsonView pbr = material.member("pbrMetallicRoughness");
    pbr.member("baseColorFactor").expectNumbers(4, 0, 1);
    pbr.member("metallicFactor").expectNumber(0, 1);
    pbr.member("roughnessFactor").expectNumber(0, 1);
    checkTextureInfo(pbr.member("baseColorTexture"), document);
    checkTextureInfo(pbr.member("metallicRoughnessTexture"), document);
    checkTextureInfo(material.member("normalTexture"), document);
    checkTextureInfo(material.member("occlusionTexture"), document);
    checkTextureInfo(material.member("emissiveTexture"), document);
    material.member("emissiveFactor").expectNumbers(3, 0, kHuge);  // the limit of 1 is overstepped by many exporters
    material.member("alphaMode").expectString();
    material.member("doubleSided").expectBool();
    checkMaterialExtensions(material.member("extensions"), document);
  }
}

void checkCameras(const JsonView& document) {
  for (const JsonView& camera : document.member("cameras").objects()) {
    const JsonView perspective = camera.member("perspective"), orthographic = camera.member("orthographic");
    if (perspective.present() == orthographic.present()) camera.fail("must be either perspective or orthographic");
    perspective.member("aspectRatio").expectNumber(1e-6, 1e6);
    orthographic.member("xmag").expectNumber(-kHuge, kHuge);
    orthographic.member("ymag").expectNumber(-kHuge, kHuge);
    if (!perspective.present()) continue;
    perspective.member("yfov").expectPresent("the vertical angle of view");
    perspective.member("yfov").expectNumber(1e-6, 3.1);
  }
}

void checkLights(const JsonView& document) {
  for (const JsonView& light : document.member("extensions").member("KHR_lights_punctual").member("lights").objects()) {
    light.member("color").expectNumbers(3, 0, kHuge);
    light.member("intensity").expectNumber(0, kHuge);
    light.member("type").expectPresent("directional, point or spot");
    light.member("type").expectString();
    const auto type = light.member("type").value().get<std::string>();
    if (type != "directional" && type != "point" && type != "spot") light.fail("is of unknown type");
    light.member("spot").member("innerConeAngle").expectNumber(0, kPi / 2);
    light.member("spot").member("outerConeAngle").expectNumber(0, kPi / 2 + 1e-6);
  }
  for (const JsonView& profile : document.member("extensions").member("EXT_lights_ies").member("lights").objects()) {
    profile.member("uri").expectString();
    profile.member("bufferView").expectIndex(document.member("bufferViews").size());
    if (profile.member("uri").present() == profile.member("bufferView").present()) {
      profile.fail("must have either a uri or a bufferView");
    }
  }
}

void checkNodes(const JsonView& document) {
  const JsonView extensions = document.member("extensions");
  const std::size_t nodes = document.member("nodes").size();
  for (const JsonView& node : document.member("nodes").objects()) {
    node.member("name").expectString();
    node.member("mesh").expectIndex(document.member("meshes").size());
    node.member("camera").expectIndex(document.member("cameras").size());
    for (const JsonView& child : node.member("children").elements()) child.expectIndex(nodes);
    node.member("matrix").expectNumbers(16, -kHuge, kHuge);
    node.member("translation").expectNumbers(3, -kHuge, kHuge);
    node.member("rotation").expectNumbers(4, -kHuge, kHuge);
    node.member("scale").expectNumbers(3, -kHuge, kHuge);
    const JsonView instances = node.member("extensions").member("EXT_mesh_gpu_instancing").member("attributes");
    for (const char* key : {"TRANSLATION", "ROTATION", "SCALE"})
      instances.member(key).expectIndex(document.member("accessors").size());
    const JsonView punctual = node.member("extensions").member("KHR_lights_punctual").member("light");
    punctual.expectIndex(extensions.member("KHR_lights_punctual").member("lights").size());
    const JsonView measured = node.member("extensions").member("EXT_lights_ies");
    if (!measured.present()) continue;
    measured.member("light").expectPresent("the index of a light profile");
    measured.member("light").expectIndex(extensions.member("EXT_lights_ies").member("lights").size());
    measured.member("multiplier").expectNumber(0, kHuge);
    measured.member("color").expectNumbers(3, 0, kHuge);
  }
  for (const JsonView& scene : document.member("scenes").objects()) {
    for (const JsonView& root : scene.member("nodes").elements()) root.expectIndex(nodes);
  }
  document.member("scene").expectIndex(document.member("scenes").size());
}

}  // namespace

void checkGltf(const nlohmann::json& tree, const std::string& name) {
  const JsonView document(tree, name, "export the scene again, or correct it by the glTF 2.0 specification");
  document.expectObject();
  checkAsset(document, name);
  checkRequiredExtensions(document, name);
  checkBuffers(document, name);
  checkAccessors(document);
  checkMeshes(document, name);
  checkImages(document);
  checkMaterials(document);
  checkCameras(document);
  checkLights(document);
  checkNodes(document);
  document.member("skins").elements();
  document.member("animations").elements();
}

}  // namespace deltalux::io
