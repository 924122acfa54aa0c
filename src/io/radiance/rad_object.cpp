#include "io/radiance/rad_object.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace deltalux::io::radiance {

namespace {

constexpr std::array<std::pair<std::string_view, Type>, 62> kTypes{{
    {"polygon", Type::Polygon},
    {"sphere", Type::Sphere},
    {"bubble", Type::Bubble},
    {"cylinder", Type::Cylinder},
    {"tube", Type::Tube},
    {"cone", Type::Cone},
    {"cup", Type::Cup},
    {"ring", Type::Ring},
    {"source", Type::Source},
    {"instance", Type::Instance},
    {"mesh", Type::Mesh},
    {"plastic", Type::Plastic},
    {"metal", Type::Metal},
    {"plastic2", Type::Plastic2},
    {"metal2", Type::Metal2},
    {"trans", Type::Trans},
    {"trans2", Type::Trans2},
    {"glass", Type::Glass},
    {"dielectric", Type::Dielectric},
    {"mirror", Type::Mirror},
    {"light", Type::Light},
    {"glow", Type::Glow},
    {"illum", Type::Illum},
    {"spotlight", Type::Spotlight},
    {"alias", Type::Alias},
    {"antimatter", Type::Unsupported},
    {"interface", Type::Unsupported},
    {"mist", Type::Unsupported},
    {"prism1", Type::Unsupported},
    {"prism2", Type::Unsupported},
    {"ashik2", Type::Unsupported},
    {"BRTDfunc", Type::Unsupported},
    {"BSDF", Type::Unsupported},
    {"aBSDF", Type::Unsupported},
    {"WGMDfunc", Type::Unsupported},
    {"plasfunc", Type::Unsupported},
    {"metfunc", Type::Unsupported},
    {"transfunc", Type::Unsupported},
    {"plasdata", Type::Unsupported},
    {"metdata", Type::Unsupported},
    {"transdata", Type::Unsupported},
    {"brightfunc", Type::Pattern},
    {"brightdata", Type::Pattern},
    {"brighttext", Type::Pattern},
    {"colorfunc", Type::Pattern},
    {"colordata", Type::Pattern},
    {"colorpict", Type::Pattern},
    {"colortext", Type::Pattern},
    {"specfunc", Type::Pattern},
    {"specdata", Type::Pattern},
    {"specfile", Type::Pattern},
    {"specpict", Type::Pattern},
    {"spectrum", Type::Pattern},
    {"texfunc", Type::Pattern},
    {"texdata", Type::Pattern},
    {"mixfunc", Type::Mixture},
    {"mixdata", Type::Mixture},
    {"mixpict", Type::Mixture},
    {"mixtext", Type::Mixture},
    // older spellings
    {"plasticfunc", Type::Unsupported},
    {"metalfunc", Type::Unsupported},
    {"spot", Type::Spotlight},
}};

/// Allowed numbers of arguments; an upper bound below zero means any.
struct Counts {
  int strings = 0, maxStrings = 0;
  int reals = 0, maxReals = 0;
  std::string_view meaning;
};

std::optional<Counts> countsOf(Type type) {
  switch (type) {
    case Type::Polygon:
      return Counts{0, 0, 9, -1, "x y z for each of at least 3 vertices"};
    case Type::Sphere:
    case Type::Bubble:
      return Counts{0, 0, 4, 4, "x y z radius"};
    case Type::Cylinder:
    case Type::Tube:
      return Counts{0, 0, 7, 7, "x0 y0 z0 x1 y1 z1 radius"};
    case Type::Cone:
    case Type::Cup:
      return Counts{0, 0, 8, 8, "x0 y0 z0 x1 y1 z1 radius0 radius1"};
    case Type::Ring:
      return Counts{0, 0, 8, 8, "x y z, the normal, and two radii"};
    case Type::Source:
      return Counts{0, 0, 4, 4, "direction x y z and the full angle in degrees"};
    case Type::Plastic:
    case Type::Metal:
      return Counts{0, 0, 5, 5, "red green blue specularity roughness"};
    case Type::Plastic2:
    case Type::Metal2:
      return Counts{0, -1, 6, -1, "red green blue specularity u-roughness v-roughness"};
    case Type::Trans:
      return Counts{0, 0, 7, 7, "red green blue specularity roughness transmission transmitted-specular"};
    case Type::Trans2:
      return Counts{0, -1, 8, -1,
                    "red green blue specularity u-roughness v-roughness transmission transmitted-specular"};
    case Type::Glass:
      return Counts{0, 0, 3, 4, "red green blue transmissivity and optionally the refractive index"};
    case Type::Dielectric:
      return Counts{0, 0, 5, 5, "red green blue transmission, refractive index, Hartmann's constant"};
    case Type::Mirror:
      return Counts{0, 1, 3, 3, "red green blue reflectance"};
    case Type::Light:
      return Counts{0, 0, 3, 3, "red green blue radiance"};
    case Type::Illum:
      return Counts{0, 1, 3, 3, "red green blue radiance"};
    case Type::Glow:
      return Counts{0, 0, 4, 4, "red green blue radiance and the maximum radius"};
    case Type::Spotlight:
      return Counts{0, 0, 7, 7, "red green blue radiance, cone angle in degrees, direction x y z"};
    default:
      return std::nullopt;
  }
}

std::string range(int least, int most) {
  if (most < 0) return "at least " + std::to_string(least);
  return least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most);
}

}  // namespace

InputError inputError(const SourceLine& where, std::string message, std::string hint) {
  return InputError(where.file ? *where.file : "", where.line, std::move(message), std::move(hint));
}

bool isSurface(Type type) { return type <= Type::GeneratedMesh; }

std::optional<Type> typeNamed(std::string_view word) {
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& entry) { return entry.first == word; });
  if (found == kTypes.end()) return std::nullopt;
  return found->second;
}

bool isSkyPattern(const RadObject& object) {
  return object.type == Type::SkyBrightness || object.type == Type::PerezBrightness;
}

std::string nameOf(Type type) {
  if (type == Type::GeneratedMesh) return "mesh";
  if (type == Type::SkyBrightness || type == Type::PerezBrightness) return "brightfunc";
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& entry) { return entry.second == type; });
  return std::string(found->first);
}

std::vector<std::string> typeNames() {
  std::vector<std::string> names;
  for (const auto& [name, type] : kTypes) names.emplace_back(name);
  return names;
}

void checkArgumentCounts(const RadObject& object) {
  const auto allowed = countsOf(object.type);
  if (!allowed) return;
  const auto outside = [](std::size_t n, int least, int most) {
    return n < static_cast<std::size_t>(least) || (most >= 0 && n > static_cast<std::size_t>(most));
  };
  const std::string subject = object.typeName + " '" + object.name + "' has ";
  if (outside(object.strings.size(), allowed->strings, allowed->maxStrings)) {
    throw inputError(object.where, subject + std::to_string(object.strings.size()) + " string arguments, not " +
                                       range(allowed->strings, allowed->maxStrings));
  }
  const bool wholeVertices = object.type != Type::Polygon || object.reals.size() % 3 == 0;
  if (outside(object.reals.size(), allowed->reals, allowed->maxReals) || !wholeVertices) {
    throw inputError(object.where,
                     subject + std::to_string(object.reals.size()) + " real arguments, not " +
                         range(allowed->reals, allowed->maxReals) + (wholeVertices ? "" : " in threes"),
                     "they are " + std::string(allowed->meaning));
  }
}

}  // namespace deltalux::io::radiance
