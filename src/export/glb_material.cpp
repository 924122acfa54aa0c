#include "export/glb_material.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::exporting {

namespace {

constexpr float kDielectricF0 = 0.04f;  // of an index of 1.5, which specularColorFactor multiplies [defined]

GlbJson array(const Rgb& c) { return GlbJson::array({c.r, c.g, c.b}); }
GlbJson array(const Rgb& c, float alpha) { return GlbJson::array({c.r, c.g, c.b, alpha}); }

class MaterialWriter {
 public:
  MaterialWriter(GlbContainer& glb, const Scene& scene, const SurfaceMesh& side)
      : glb_(glb), scene_(scene), side_(side), material_(scene.materialOf(side.primitive)) {}

  GlbJson write() {
    json_["name"] = material_.name;
    std::visit([&](const auto& surface) { add(surface); }, material_.surface);
    addEmission();
    if (material_.coverage < 1) json_["alphaMode"] = "BLEND";
    return std::move(json_);
  }

 private:
  void add(const Opaque& s) { addReflection(side_.albedo, s.specular); }
  void add(const Trans& s) { addReflection(side_.albedo, s.reflection); }
  void add(const Mirror& s) { addBase(side_.front ? s.reflectance : Rgb(0.0f), 1, 0); }
  void add(const ThinGlass& s) {
    addBase(glm::min(s.transmissivity, Rgb(1.0f)), 0, 0);
    addTransmission(s.ior);
  }
  void add(const Dielectric& s) {
    addBase(Rgb(1.0f), 0, 0);
    addTransmission(s.ior);
    Rgb perMetre;
    for (int c = 0; c < 3; ++c)
      perMetre[c] = std::clamp(static_cast<float>(std::pow(s.transmission[c], 1 / scene_.metresPerUnit)), 0.0f, 1.0f);
    const double thickness = bounds(scene_[side_.primitive].shape).diagonal() / std::sqrt(3.0);
    extend("KHR_materials_volume",
           {{"thicknessFactor", thickness}, {"attenuationDistance", 1}, {"attenuationColor", array(perMetre)}});
  }

  void addReflection(const Rgb& diffuse, const SpecularLobe& lobe) {
    const float roughness = std::sqrt(std::clamp(lobe.roughness, 0.0f, 1.0f));
    if (isBlack(lobe.reflectance)) {
      addBase(diffuse, 0, 1);
      extend("KHR_materials_specular", {{"specularFactor", 0}});
    } else if (isBlack(diffuse)) {
      addBase(glm::min(lobe.reflectance, Rgb(1.0f)), 1, roughness);
    } else {
      // The lobe's largest channel is taken from what the diffuse base receives. [glTF 2.0, appendix B]
      const float rest = std::max(1 - maxChannel(lobe.reflectance), maxChannel(diffuse));
      addBase(diffuse / rest, 0, roughness);
      extend("KHR_materials_specular", {{"specularColorFactor", array(lobe.reflectance / kDielectricF0)}});
    }
  }

  void addBase(const Rgb& base, float metallic, float roughness) {
    json_["pbrMetallicRoughness"] = {{"baseColorFactor", array(base, material_.coverage)},
                                     {"metallicFactor", metallic},
                                     {"roughnessFactor", roughness}};
  }

  void addTransmission(float ior) {
    extend("KHR_materials_transmission", {{"transmissionFactor", 1}});
    if (ior >= 1) extend("KHR_materials_ior", {{"ior", ior}});
  }

  void addEmission() {
    const float most = maxChannel(side_.radiance);
    if (!(most > 0)) return;
    json_["emissiveFactor"] = array(side_.radiance / std::max(most, 1.0f));
    if (most > 1) extend("KHR_materials_emissive_strength", {{"emissiveStrength", most}});
  }

  void extend(const char* extension, GlbJson values) {
    json_["extensions"][extension] = std::move(values);
    glb_.use(extension);
  }

  GlbContainer& glb_;
  const Scene& scene_;
  const SurfaceMesh& side_;
  const Material& material_;
  GlbJson json_;
};

}  // namespace

GlbJson litMaterial(GlbContainer& glb, const Scene& scene, const SurfaceMesh& side) {
  return MaterialWriter(glb, scene, side).write();
}

GlbJson unlitMaterial(GlbContainer& glb, const Material& material, const Rgb& colour,
                      std::optional<std::size_t> texture) {
  float alpha = material.coverage;
  if (isClear(material)) alpha *= 1 - std::clamp(gray(straightTransmittance(material, 1)), 0.0f, 1.0f);
  GlbJson json;
  json["name"] = material.name;
  json["pbrMetallicRoughness"] = {{"baseColorFactor", array(glm::clamp(colour, Rgb(0.0f), Rgb(1.0f)), alpha)},
                                  {"metallicFactor", 0}};
  if (texture) json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", *texture}};
  if (alpha < 1) json["alphaMode"] = "BLEND";
  json["extensions"]["KHR_materials_unlit"] = GlbJson::object();
  glb.use("KHR_materials_unlit");
  return json;
}

}  // namespace deltalux::exporting
