#include "io/pbrt/materials.hpp"

#include <algorithm>
#include <cmath>

#include "io/import_material.hpp"

namespace deltalux::io::pbrt {

namespace {

/// Of the parameter `prefix` + "roughness", or of its two directions.
double alphaOf(Context& context, const Entity& m, const std::string& prefix = "") {
  const double both = scalarOr(context, m, prefix + "roughness", 0);
  const double mean =
      0.5 * (scalarOr(context, m, prefix + "uroughness", both) + scalarOr(context, m, prefix + "vroughness", both));
  const double roughness = std::clamp(mean, 0.0, 1.0);
  return flagOr(m, "remaproughness", true) ? std::sqrt(roughness) : roughness;
}

float indexOf(Context& context, const Entity& m, const std::string& name) {
  // At 587.6 nm, as catalogues of glass have them.
  static const std::map<std::string_view, float> kGlasses{
      {"glass-BK7", 1.5168f}, {"glass-BAF10", 1.6700f}, {"glass-FK51A", 1.4866f}, {"glass-LASF9", 1.8503f},
      {"glass-F5", 1.6727f},  {"glass-F10", 1.7283f},   {"glass-F11", 1.7847f}};
  const Parameter* p = find(m, name);
  if (!p) return 1.5f;
  const auto glass = p->texts.empty() ? kGlasses.end() : kGlasses.find(p->texts[0]);
  const float index =
      glass != kGlasses.end() && p->type == "spectrum" ? glass->second : gray(colourOr(context, m, name, Rgb(1.5f)));
  if (!(index >= 0.01f && index <= 100)) fail(p->at, "the refractive index is out of range");
  return index;
}

/// The metal of "metal-Cu-eta" and "metal-Cu-k"; nullopt for other names.
std::optional<Rgb> namedMetal(const Parameter& p) {
  if (p.type != "spectrum" || p.texts.size() != 1) return std::nullopt;
  std::string_view name = p.texts[0];
  for (const std::string_view end : {"-eta", "-k"})
    if (name.starts_with("metal-") && name.ends_with(end))
      return reflectanceOfMetal(name.substr(6, name.size() - 6 - end.size()));
  return std::nullopt;
}

/// At normal incidence; copper unless something is said, as pbrt has it.
Rgb reflectanceOf(Context& context, const Entity& m, const std::string& prefix) {
  if (find(m, "reflectance")) return asReflectance(colourOr(context, m, "reflectance", Rgb(0.0f)));
  const Parameter *n = find(m, prefix + "eta"), *k = find(m, prefix + "k");
  const Rgb copper = *reflectanceOfMetal("cu");
  if (!n && !k) return copper;
  const auto named = n ? namedMetal(*n) : namedMetal(*k);
  if (named) return *named;
  const auto isUnknown = [](const Parameter* p) {
    return p && p->type == "spectrum" && !p->texts.empty() && p->texts[0].find('.') == std::string::npos;
  };
  if (isUnknown(n) || isUnknown(k)) {
    ignore(context, "metals not known (copper instead)");
    return copper;
  }
  // What is not said is copper's.
  return reflectanceOfConductor(colourOr(context, m, prefix + "eta", {0.20f, 0.92f, 1.10f}),
                                colourOr(context, m, prefix + "k", {3.91f, 2.45f, 2.14f}));
}

/// The metal seen through the coat, which light passes to and fro.
Rgb coatedMetal(Context& context, const Entity& m) {
  const float coat = reflectanceOfDielectric(indexOf(context, m, "interface.eta"));
  const Rgb metal = reflectanceOf(context, m, "conductor.");
  return coat + (1 - coat) * (1 - coat) * metal / (1.0f - std::min(coat, 0.99f) * metal);
}

Material mixture(Context& context, const NamedMaterials& named, const Entity& m, int depth) {
  constexpr int kDeepest = 8;  // of mixtures of mixtures [limit]
  const Parameter* names = find(m, "materials");
  if (!names || names->texts.size() != 2) fail(m.at, "a mixture does not name two materials");
  if (depth >= kDeepest) fail(m.at, "mixtures are made of each other without an end");
  const auto part = [&](std::size_t i) {
    const auto found = named.find(names->texts[i]);
    if (found == named.end()) fail(names->at, "the material " + shown(names->texts[i]) + " is not defined");
    return found->second;
  };
  const auto isNothing = [](const Entity& e) { return e.type.empty() || e.type == "interface" || e.type == "none"; };
  const auto share = static_cast<float>(std::clamp(scalarOr(context, m, "amount", 0.5), 0.0, 1.0));  // of the second
  const Material first = materialOf(context, named, *part(0), depth + 1);
  const Material second = materialOf(context, named, *part(1), depth + 1);
  const auto partly = [](Material whole, float covered) {
    if (!std::holds_alternative<Dielectric>(whole.surface)) whole.coverage *= covered;
    return whole;
  };
  if (isNothing(*part(0))) return partly(second, share);
  if (isNothing(*part(1))) return partly(first, 1 - share);
  const auto *a = std::get_if<Opaque>(&first.surface), *b = std::get_if<Opaque>(&second.surface);
  if (!a || !b) {
    ignore(context, "mixtures of unlike materials (the greater part instead)");
    return share > 0.5f ? second : first;
  }
  Material mixed;
  const Rgb gloss = glm::mix(a->specular.reflectance, b->specular.reflectance, share);
  const float of = (1 - share) * gray(a->specular.reflectance), other = share * gray(b->specular.reflectance);
  const float alpha = of + other > 0 ? (of * a->specular.roughness + other * b->specular.roughness) / (of + other) : 0;
  mixed.surface = Opaque{glm::mix(a->diffuse, b->diffuse, share), {}, ggxLobe(gloss, alpha)};
  mixed.coverage = std::lerp(first.coverage, second.coverage, share);
  return mixed;
}

Surface surfaceOf(Context& context, const Entity& m) {
  const auto reflectance = [&](float otherwise) {
    return asReflectance(colourOr(context, m, "reflectance", Rgb(otherwise)));
  };
  const std::string& kind = m.type;
  if (kind == "diffuse") return Opaque{reflectance(0.5f), {}, {}};
  if (kind == "coateddiffuse")
    return coatedDiffuse(reflectance(0.5f), indexOf(context, m, "eta"), Rgb(1.0f), alphaOf(context, m));
  if (kind == "conductor") return Opaque{Rgb(0.0f), {}, ggxLobe(reflectanceOf(context, m, ""), alphaOf(context, m))};
  if (kind == "coatedconductor")
    return Opaque{Rgb(0.0f), {}, ggxLobe(coatedMetal(context, m), alphaOf(context, m, "conductor."))};
  if (kind == "dielectric") {
    if (alphaOf(context, m) > 0) ignore(context, "roughness of glass");
    return Dielectric{Rgb(1.0f), indexOf(context, m, "eta")};
  }
  if (kind == "thindielectric") return ThinGlass{Rgb(1.0f), indexOf(context, m, "eta")};
  if (kind == "diffusetransmission") {
    const Rgb scale(static_cast<float>(std::max(numberOr(m, "scale", 1), 0.0)));
    const Rgb reflected = asReflectance(scale * reflectance(0.25f));
    const Rgb passed = asReflectance(scale * colourOr(context, m, "transmittance", Rgb(0.25f)));
    return Trans{reflected, glm::min(passed, Rgb(1.0f) - reflected), {}, {}};
  }
  if (kind.empty() || kind == "interface" || kind == "none") return ThinGlass{Rgb(1.0f), 1.0f};
  ignore(context, "material " + kind.substr(0, 40) + " (gray instead)");
  return Opaque{Rgb(0.5f), {}, {}};
}

}  // namespace

Material materialOf(Context& context, const NamedMaterials& named, const Entity& m, int depth) {
  if (!m.isDefined) fail(m.at, "the material " + shown(m.type) + " is not defined");
  for (const char* map : {"normalmap", "displacement"})
    if (find(m, map)) ignore(context, map);
  if (m.type == "mix") return mixture(context, named, m, depth);
  Material material;
  material.surface = surfaceOf(context, m);
  return material;
}

}  // namespace deltalux::io::pbrt
