#include "io/mitsuba/materials.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>

#include "io/image/formats.hpp"
#include "io/import_file.hpp"
#include "io/import_material.hpp"
#include "io/import_texture.hpp"
#include "io/lower_case.hpp"

namespace deltalux::io::mitsuba {

namespace {

constexpr int kDeepestBsdf = 16;  // of bsdfs within bsdfs [limit]

double indexOf(const Properties& p, std::string_view name, double otherwise) {
  static const std::map<std::string, double> kNamed{{"vacuum", 1.0},   {"air", 1.000277},       {"water", 1.333},
                                                    {"bk7", 1.5046},   {"acrylic glass", 1.49}, {"polypropylene", 1.49},
                                                    {"diamond", 2.419}};
  const XmlElement* child = p.named(name);
  if (!child) return otherwise;
  const std::string* value = child->attribute("value");
  if (child->name != "string" || !value) return p.number(name, otherwise);
  const auto found = kNamed.find(lowerCase(*value));
  return found == kNamed.end() ? otherwise : found->second;
}

float relativeIndex(const Properties& p, double inside) {
  const double index = indexOf(p, "int_ior", inside) / indexOf(p, "ext_ior", 1.000277);
  if (!(index >= 0.01 && index <= 100)) p.fail(p.element(), "its refractive index is out of range");
  return static_cast<float>(index);
}

double alphaOf(const Properties& p, bool rough) {
  if (!rough) return 0;
  return p.named("alpha") ? p.number("alpha", 0.1) : 0.5 * (p.number("alpha_u", 0.1) + p.number("alpha_v", 0.1));
}

Opaque conductor(const Context& context, const Properties& p, bool rough) {
  Rgb reflectance(1.0f);
  if (p.named("eta") || p.named("k")) {
    reflectance = reflectanceOfConductor(colourOf(context, p, "eta", Rgb(0.0f)), colourOf(context, p, "k", Rgb(1.0f)));
  } else if (const auto name = p.word("material")) {
    const auto known = reflectanceOfMetal(*name);
    if (!known) ++context.report.ignored["metals not known (copper instead)"];
    reflectance = known.value_or(*reflectanceOfMetal("cu"));
  } else {
    reflectance = *reflectanceOfMetal("cu");  // Mitsuba's own default
  }
  return {
      Rgb(0.0f), {}, ggxLobe(reflectance * colourOf(context, p, "specular_reflectance", Rgb(1.0f)), alphaOf(p, rough))};
}

Opaque plastic(const Context& context, const Properties& p, bool rough) {
  return coatedDiffuse(colourOf(context, p, "diffuse_reflectance", Rgb(0.5f)), relativeIndex(p, 1.49),
                       colourOf(context, p, "specular_reflectance", Rgb(1.0f)), alphaOf(p, rough));
}

Surface principled(const Context& context, const Properties& p) {
  const Rgb base = asReflectance(colourOf(context, p, "base_color", Rgb(0.5f)));
  const auto share = [&](const char* name, double otherwise) {
    return static_cast<float>(std::clamp(p.number(name, otherwise), 0.0, 1.0));
  };
  const float metallic = share("metallic", 0), roughness = share("roughness", 0.5), f0 = 0.08f * share("specular", 0.5);
  if (share("spec_trans", 0) >= 0.5f) return Dielectric{base, relativeIndex(p, 1.5)};
  Opaque surface;
  surface.diffuse = base * (1 - metallic) * (1 - f0);
  surface.specular = {glm::mix(Rgb(f0), base, metallic), roughness * roughness, SpecularLobe::Distribution::Ggx};
  return surface;
}

/// The first bsdf within another, or one that it refers to.
const XmlElement* nested(const Context& context, const XmlElement& element) {
  for (const XmlElement& child : element.children) {
    if (child.name == "bsdf") return &child;
    if (child.name != "ref") continue;
    const XmlElement* target = context.target(child);
    if (target && target->name == "bsdf") return target;
  }
  return nullptr;
}

}  // namespace

Rgb colourOf(const Context& context, const Properties& p, std::string_view name, const Rgb& otherwise) {
  const XmlElement* child = p.named(name);
  if (child && child->name == "ref") child = context.target(*child);
  if (!child) return otherwise;
  if (child->name != "texture") return p.colour(*child, context.report.ignored).value_or(otherwise);
  const Properties texture(*child, context.file);
  ++context.report.ignored["textures (average used)"];
  if (texture.type() == "checkerboard") {
    const auto plain = [&](const char* square, float usual) {
      const XmlElement* own = texture.named(square);
      return own ? texture.colour(*own, context.report.ignored).value_or(Rgb(usual)) : Rgb(usual);
    };
    return 0.5f * (plain("color0", 0.4f) + plain("color1", 0.2f));
  }
  const auto file = texture.word("filename");
  if (texture.type() != "bitmap" || !file) return otherwise;
  const auto path = resolveReference(*file, context.folder, context.file, child->line, false);
  const auto decoded = decodeTexture(readInputFile(path), *file,
                                     texture.flag("raw", false) ? TexelEncoding::Linear : TexelEncoding::Srgb);
  if (!decoded) texture.fail(*child, "'" + file->substr(0, 100) + "' is no PNG or JPEG image");
  return average(*decoded);
}

Material materialOf(const Context& context, const XmlElement& bsdf, int depth) {
  const Properties p(bsdf, context.file);
  if (depth > kDeepestBsdf) p.fail(bsdf, "bsdfs refer to each other without an end");
  const std::string type = p.type();
  Material material;
  const auto inner = [&] {
    const XmlElement* within = nested(context, bsdf);
    if (!within) p.fail(bsdf, "a bsdf of type " + type.substr(0, 40) + " has none within");
    return materialOf(context, *within, depth + 1);
  };
  if (type == "twosided" || type == "bumpmap" || type == "normalmap" || type == "mask" || type == "blendbsdf" ||
      type == "coating") {
    material = inner();
    if (type == "mask") {
      const float opacity = asReflectance(colourOf(context, p, "opacity", Rgb(0.5f))).g;
      if (!std::holds_alternative<Dielectric>(material.surface)) material.coverage = opacity;
    } else if (type != "twosided") {
      ++context.report.ignored[type];
    }
  } else if (type == "diffuse" || type == "roughdiffuse") {
    material.surface = Opaque{asReflectance(colourOf(context, p, "reflectance", Rgb(0.5f))), {}, {}};
  } else if (type == "conductor" || type == "roughconductor") {
    material.surface = conductor(context, p, type == "roughconductor");
  } else if (type == "plastic" || type == "roughplastic" || type == "phong" || type == "ward") {
    material.surface = plastic(context, p, type != "plastic");
  } else if (type == "dielectric" || type == "roughdielectric") {
    if (type == "roughdielectric") ++context.report.ignored["roughness of glass"];
    material.surface = Dielectric{Rgb(1.0f), relativeIndex(p, 1.5046)};
  } else if (type == "thindielectric") {
    material.surface = ThinGlass{Rgb(1.0f), relativeIndex(p, 1.5046)};
  } else if (type == "principled" || type == "principledthin") {
    material.surface = principled(context, p);
  } else if (type == "null") {
    material.surface = ThinGlass{Rgb(1.0f), 1.0f};
  } else {
    ++context.report.ignored["bsdf " + type.substr(0, 40) + " (gray instead)"];
    material.surface = Opaque{Rgb(0.5f), {}, {}};
  }
  if (const std::string* id = bsdf.attribute("id")) material.name = *id;
  return material;
}

}  // namespace deltalux::io::mitsuba
