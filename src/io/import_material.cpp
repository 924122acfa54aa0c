#include "io/import_material.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "base/tuning.hpp"
#include "io/lower_case.hpp"

namespace deltalux::io {

std::optional<Rgb> reflectanceOfMetal(std::string_view symbol) {
  static const std::map<std::string, Rgb> kMetals{
      {"none", Rgb(1.0f)},           {"al", {0.91f, 0.92f, 0.92f}}, {"ag", {0.97f, 0.96f, 0.91f}},
      {"au", {1.0f, 0.77f, 0.34f}},  {"cu", {0.95f, 0.64f, 0.54f}}, {"cuzn", {0.91f, 0.78f, 0.42f}},
      {"cr", {0.55f, 0.56f, 0.55f}}, {"w", {0.50f, 0.51f, 0.54f}},  {"ir", {0.72f, 0.70f, 0.66f}}};
  const auto found = kMetals.find(lowerCase(symbol));
  return found == kMetals.end() ? std::nullopt : std::optional(found->second);
}

Rgb reflectanceOfConductor(const Rgb& n, const Rgb& k) {
  return ((n - 1.0f) * (n - 1.0f) + k * k) / ((n + 1.0f) * (n + 1.0f) + k * k);
}

float reflectanceOfDielectric(float index) {
  const float root = (index - 1) / (index + 1);
  return root * root;
}

Rgb asReflectance(const Rgb& colour) { return glm::clamp(colour, Rgb(0.0f), Rgb(1.0f)); }

SpecularLobe ggxLobe(const Rgb& reflectance, double alpha) {
  const auto width = static_cast<float>(std::clamp(alpha, 0.0, 1.0));
  return {asReflectance(reflectance), width < tuning::kNegligible ? 0.0f : width, SpecularLobe::Distribution::Ggx};
}

Opaque coatedDiffuse(const Rgb& base, float index, const Rgb& gloss, double alpha) {
  const float f0 = reflectanceOfDielectric(index);
  return {(1 - f0) * asReflectance(base), {}, ggxLobe(f0 * gloss, alpha)};
}

}  // namespace deltalux::io
