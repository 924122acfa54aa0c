#include <cmath>

#include "scene/edit/plan.hpp"

namespace deltalux::scene::edits {

namespace {

constexpr const char* kTooMuch = "it would reflect more than it receives";

void requireSum(const std::string& name, const Rgb& sum) {
  if (maxChannel(sum) > 1.0f + 1e-5f) refuse("the material '" + name + "' cannot take this reflectance: " + kTooMuch);
}

bool setReflectance(Opaque& s, const Rgb& rgb) {
  (isBlack(s.diffuse) && !isBlack(s.specular.reflectance) ? s.specular.reflectance : s.diffuse) = rgb;
  return true;
}
bool setReflectance(Mirror& s, const Rgb& rgb) { return s.reflectance = rgb, true; }
bool setReflectance(Trans& s, const Rgb& rgb) { return s.diffuseReflectance = rgb, true; }
bool setReflectance(ThinGlass&, const Rgb&) { return false; }
bool setReflectance(Dielectric&, const Rgb&) { return false; }

bool setLobe(SpecularLobe& lobe, float roughness) {
  if (isBlack(lobe.reflectance)) return false;
  lobe.roughness = roughness;
  return true;
}
bool setRoughness(Opaque& s, float roughness) { return setLobe(s.specular, roughness); }
bool setRoughness(Trans& s, float roughness) {
  const bool reflects = setLobe(s.reflection, roughness);
  return setLobe(s.transmission, roughness) || reflects;
}
bool setRoughness(auto&, float) { return false; }

Rgb total(const Opaque& s) { return s.diffuseTexture.valid() ? Rgb(0.0f) : s.diffuse + s.specular.reflectance; }
Rgb total(const Trans& s) {
  return s.diffuseReflectance + s.diffuseTransmittance + s.reflection.reflectance + s.transmission.reflectance;
}
Rgb total(const auto&) { return Rgb(0.0f); }

}  // namespace

Plan plan(const Scene& scene, const SetMaterial& edit) {
  if (!edit.reflectance && !edit.roughness) refuse("nothing is set of the material '" + edit.material + "'");
  if (edit.reflectance)
    for (int c = 0; c < 3; ++c)
      if (!((*edit.reflectance)[c] >= 0 && (*edit.reflectance)[c] <= 1)) refuse("a reflectance lies in 0 to 1");
  if (edit.roughness && !(*edit.roughness >= 0 && *edit.roughness <= 1)) refuse("a roughness lies in 0 to 1");
  Plan result;
  for (const MaterialId id : materialsNamed(scene, edit.material)) {
    Material m = scene[id];
    std::visit(
        [&](auto& s) {
          if (edit.reflectance && !setReflectance(s, *edit.reflectance))
            refuse("the material '" + edit.material + "' is clear: it has no reflectance to set");
          if (edit.roughness && !setRoughness(s, *edit.roughness))
            refuse("the material '" + edit.material + "' has no gloss whose roughness could be set");
          requireSum(edit.material, total(s));
        },
        m.surface);
    result.target.materials.push_back({id, std::move(m)});
  }
  return result;
}

}  // namespace deltalux::scene::edits
