#include "io/gltf/material.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "io/gltf/extension.hpp"
#include "io/gltf/texture.hpp"

namespace deltalux::io {

namespace {

using Ignored = std::map<std::string, std::size_t>;

// The inputs of the surface models, textures averaged.
struct Inputs {
  Rgb factor{1.0f};  // base colour without its texture
  Rgb base{1.0f};    // with its average
  float metallic = 1, roughness = 1;
  float ior = 1.5f;
  Rgb f0{0.04f};
  float transmission = 0;
};

float single(double value) { return static_cast<float>(value); }

Inputs inputsOf(const tinygltf::Material& material, GltfTextures& textures) {
  const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  Inputs in;
  in.factor = in.base = rgbOf(pbr.baseColorFactor);
  if (pbr.baseColorTexture.index >= 0) in.base *= textures.average(pbr.baseColorTexture.index, TexelEncoding::Srgb);
  in.metallic = single(pbr.metallicFactor), in.roughness = single(pbr.roughnessFactor);
  if (pbr.metallicRoughnessTexture.index >= 0) {
    const Rgb texel = textures.average(pbr.metallicRoughnessTexture.index, TexelEncoding::Linear);
    in.roughness *= texel.g, in.metallic *= texel.b;
  }
  // An ior of 0 stands for a surface that reflects everything. [KHR_materials_ior]
  in.ior = single(numberOf(extensionOf(material.extensions, "KHR_materials_ior"), "ior", 1.5));
  const float root = in.ior == 0 ? 1.0f : (in.ior - 1) / (in.ior + 1);
  const tinygltf::Value* specular = extensionOf(material.extensions, "KHR_materials_specular");
  const Rgb colour = rgbOf(numbersOf(specular, "specularColorFactor", {1, 1, 1}));
  in.f0 = glm::min(root * root * colour, Rgb(1.0f)) * single(numberOf(specular, "specularFactor", 1));
  const tinygltf::Value* transmission = extensionOf(material.extensions, "KHR_materials_transmission");
  in.transmission = single(numberOf(transmission, "transmissionFactor", 0)) * (1 - in.metallic);
  return in;
}

float lobeRoughness(float roughness) {
  const float alpha = roughness * roughness;
  return alpha < tuning::kNegligible ? 0.0f : alpha;  // narrower than the sun
}

// [glTF 2.0, appendix B.2] with constant lobes.
Opaque opaqueOf(const Inputs& in, const tinygltf::Material& material, GltfTextures& textures, Scene& scene) {
  Opaque surface;
  const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
  surface.diffuse = in.factor * (1 - in.metallic) * (1 - maxChannel(in.f0));
  if (texture >= 0 && in.metallic < 1) surface.diffuseTexture = textures.put(texture, scene);
  surface.specular = {glm::mix(in.f0, in.base, in.metallic), lobeRoughness(in.roughness),
                      SpecularLobe::Distribution::Ggx};
  return surface;
}

// [KHR_materials_volume] Transmission per metre.
Dielectric dielectricOf(const Inputs& in, const tinygltf::Value& volume) {
  const double distance = numberOf(&volume, "attenuationDistance", kInfinity);
  const Rgb colour = rgbOf(numbersOf(&volume, "attenuationColor", {1, 1, 1}));
  Dielectric surface;
  surface.ior = in.ior == 0 ? 1.5f : in.ior;
  for (int c = 0; c < 3; ++c) surface.transmission[c] = single(std::pow(static_cast<double>(colour[c]), 1 / distance));
  return surface;
}

Surface surfaceOf(const tinygltf::Material& material, GltfTextures& textures, Scene& scene, Ignored& ignored) {
  const Inputs in = inputsOf(material, textures);
  const float paneIor = in.ior == 0 ? 1.5f : in.ior;
  if (in.transmission >= 0.5f) {
    const tinygltf::Value* volume = extensionOf(material.extensions, "KHR_materials_volume");
    if (in.roughness > 0.05f) ++ignored["roughness of glass"];
    if (numberOf(volume, "thicknessFactor", 0) > 0) return dielectricOf(in, *volume);
    return ThinGlass{in.base * in.transmission, paneIor};
  }
  if (in.transmission > 0) ++ignored["transmission below one half"];
  return opaqueOf(in, material, textures, scene);
}

/// Share of a surface that is there: blended, the mean of its alpha; masked, the texels that are as opaque as the
/// cutoff. [glTF 2.0, 3.9.4]
float coverageOf(const tinygltf::Material& material, GltfTextures& textures, Ignored& ignored) {
  const bool masked = material.alphaMode == "MASK";
  if (!masked && material.alphaMode != "BLEND") return 1;
  const auto share = [&](double alpha) {
    const double a = std::clamp(material.pbrMetallicRoughness.baseColorFactor[3] * alpha, 0.0, 1.0);
    return masked ? (a >= material.alphaCutoff ? 1.0 : 0.0) : a;
  };
  const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
  if (texture < 0) return single(share(1));
  const std::array<double, 256>& alphas = textures.alphas(texture);
  double sum = 0;
  for (std::size_t i = 0; i < alphas.size(); ++i) sum += alphas[i] * share(static_cast<double>(i) / 255);
  if (*std::max_element(alphas.begin(), alphas.end()) < 1) ++ignored["alpha textures (average used)"];
  return single(std::min(sum, 1.0));
}

std::optional<Emission> emissionOf(const tinygltf::Material& material, double luminousEfficacy,
                                   GltfTextures& textures) {
  if (material.emissiveFactor.size() != 3) return std::nullopt;
  const double strength =
      numberOf(extensionOf(material.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
  Rgb emissive = rgbOf(material.emissiveFactor);
  if (isBlack(emissive)) return std::nullopt;
  if (material.emissiveTexture.index >= 0)
    emissive *= textures.average(material.emissiveTexture.index, TexelEncoding::Srgb);
  Emission emission;
  emission.radiance = emissive * single(strength / luminousEfficacy);
  emission.bothSides = material.doubleSided;
  if (isBlack(emission.radiance)) return std::nullopt;
  return emission;
}

// [KHR_texture_transform] translation * rotation * scale
std::optional<TextureUse> textureUseOf(const tinygltf::TextureInfo& info, const tinygltf::Model& model) {
  TextureUse use;
  const tinygltf::Value* transform = extensionOf(info.extensions, "KHR_texture_transform");
  use.texcoordSet = static_cast<int>(numberOf(transform, "texCoord", info.texCoord));
  const std::vector<double> offset = numbersOf(transform, "offset", {0, 0}),
                            scale = numbersOf(transform, "scale", {1, 1});
  const double angle = numberOf(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  use.transform = glm::dmat3x2(c * scale[0], -s * scale[0], s * scale[1], c * scale[1], offset[0], offset[1]);
  const int sampler = model.textures[static_cast<std::size_t>(info.index)].sampler;
  if (sampler >= 0) {
    const tinygltf::Sampler& wrap = model.samplers[static_cast<std::size_t>(sampler)];
    use.repeats = wrap.wrapS == TINYGLTF_TEXTURE_WRAP_REPEAT && wrap.wrapT == TINYGLTF_TEXTURE_WRAP_REPEAT;
  }
  return use;
}

void countIgnored(const tinygltf::Material& material, Ignored& ignored) {
  if (material.normalTexture.index >= 0) ++ignored["normal textures"];
  if (material.occlusionTexture.index >= 0) ++ignored["occlusion textures"];
  if (material.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0)
    ++ignored["metallic-roughness textures (average used)"];
  if (material.emissiveTexture.index >= 0) ++ignored["emissive textures (average used)"];
  for (const auto& [name, value] : material.extensions) {
    const bool read = name == "KHR_materials_emissive_strength" || name == "KHR_materials_ior" ||
                      name == "KHR_materials_transmission" || name == "KHR_materials_volume" ||
                      name == "KHR_materials_specular";
    if (!read) ++ignored[name];
    if (value.Has("transmissionTexture")) ++ignored["transmission textures"];
  }
}

}  // namespace

Material tinted(const Material& material, float metallic, const Rgb& factor, TextureId texture) {
  Material result = material;
  if (auto* opaque = std::get_if<Opaque>(&result.surface)) {
    if (texture.valid())
      opaque->diffuseTexture = texture;
    else
      opaque->diffuse = glm::min(opaque->diffuse * factor, Rgb(1.0f));
    Rgb& lobe = opaque->specular.reflectance;
    lobe = glm::min(lobe * glm::mix(Rgb(1.0f), factor, metallic), Rgb(1.0f));
  } else if (auto* pane = std::get_if<ThinGlass>(&result.surface)) {
    pane->transmissivity = glm::min(pane->transmissivity * factor, Rgb(1.0f));
  }
  return result;
}

GltfMaterials addMaterials(const GltfDocument& document, double luminousEfficacy, Scene& scene,
                           std::map<std::string, std::size_t>& ignored) {
  GltfTextures textures(document);
  GltfMaterials result;
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    const tinygltf::Material& source = document.model.materials[i];
    Material material;
    material.name = source.name.empty() ? "material" + std::to_string(i) : source.name;
    material.surface = surfaceOf(source, textures, scene, ignored);
    material.coverage = coverageOf(source, textures, ignored);
    if (material.coverage < 1 && std::holds_alternative<Dielectric>(material.surface))
      material.coverage = 1, ++ignored["alpha of refracting bodies"];
    material.emission = emissionOf(source, luminousEfficacy, textures);
    if (material.emission) material.emission->radiance *= material.coverage;
    if (!(material.coverage > 0)) material.emission.reset();
    countIgnored(source, ignored);
    const auto* opaque = std::get_if<Opaque>(&material.surface);
    const bool textured = opaque && opaque->diffuseTexture.valid();
    result.texture.push_back(textured ? textureUseOf(source.pbrMetallicRoughness.baseColorTexture, document.model)
                                      : std::nullopt);
    const auto& pbr = source.pbrMetallicRoughness;
    result.metallic.push_back(single(pbr.metallicFactor) *
                              (pbr.metallicRoughnessTexture.index < 0
                                   ? 1.0f
                                   : textures.average(pbr.metallicRoughnessTexture.index, TexelEncoding::Linear).b));
    scene.materials.push_back(std::move(material));
  }
  const bool needsFallback =
      std::any_of(document.model.meshes.begin(), document.model.meshes.end(), [](const auto& mesh) {
        return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                           [](const auto& p) { return p.material < 0; });
      });
  if (needsFallback) {
    result.fallback = MaterialId(scene.materials.size());
    Material material;
    material.name = "default";
    material.surface = Opaque{Rgb(0.5f), {}, {}};
    scene.materials.push_back(std::move(material));
  }
  return result;
}

}  // namespace deltalux::io
