#include "io/obj/material.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <sstream>

#include "io/import_file.hpp"
#include "io/import_texture.hpp"
#include "io/obj/tinyobj.hpp"

namespace deltalux::io {

namespace {

using Ignored = std::map<std::string, std::size_t>;
namespace fs = std::filesystem;

Rgb fractions(const double (&values)[3]) {
  Rgb rgb(0.0f);
  for (int c = 0; c < 3; ++c)
    rgb[c] = std::isfinite(values[c]) ? static_cast<float>(std::clamp(values[c], 0.0, 1.0)) : 0.0f;
  return rgb;
}

// Tf filters what passes. Black is also what it reads as where there is none.
Rgb filterOf(const tinyobj::material_t& m) {
  const Rgb filter = fractions(m.transmittance);
  return isBlack(filter) ? Rgb(1.0f) : filter;
}

// How much of a surface is there: d and Tr, the same at every angle. Without them the illumination models of glass say
// that light passes all of it.
float coverageOf(const tinyobj::material_t& m) {
  const bool glass = m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9;
  if (m.dissolve < 1) return static_cast<float>(std::max(m.dissolve, 0.0));
  return glass ? 0.0f : 1.0f;
}

// Glass that refracts is a pane, whose reflection and transmission go by the angle.
bool isPaneOfGlass(const tinyobj::material_t& m) { return coverageOf(m) == 0 && !(m.dissolve < 1) && m.ior > 1; }

ThinGlass glassOf(const tinyobj::material_t& m) {
  return {filterOf(m), static_cast<float>(std::clamp(m.ior, 1.0, 100.0))};
}

// Textures by file, each read once.
class ObjTextures {
 public:
  ObjTextures(const fs::path& folder, std::string referrer) : folder_(folder), referrer_(std::move(referrer)) {}

  TextureId put(std::string reference, Scene& scene, Ignored& ignored) {
    std::replace(reference.begin(), reference.end(), '\\', '/');
    const auto [entry, isNew] = placed_.try_emplace(reference);
    if (!isNew) return entry->second;
    std::optional<Texture> texture = read(reference);
    if (!texture) return ++ignored["textures not found or not readable"], TextureId();
    entry->second = TextureId(scene.textures.size());
    scene.textures.push_back(std::move(*texture));
    return entry->second;
  }

 private:
  std::optional<Texture> read(const std::string& reference) const {
    // Paths of the machine that wrote the file are common, and a missing picture is no reason to refuse a building.
    try {
      const fs::path file = resolveReference(reference, folder_, referrer_, 0, false);
      return decodeTexture(readInputFile(file), reference, TexelEncoding::Srgb);
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  fs::path folder_;
  std::string referrer_;
  std::map<std::string, TextureId> placed_;
};

Opaque opaqueOf(const tinyobj::material_t& m, ObjTextures& textures, Scene& scene, Ignored& ignored) {
  Opaque surface;
  surface.diffuse = fractions(m.diffuse);
  if (!m.diffuse_texname.empty()) surface.diffuseTexture = textures.put(m.diffuse_texname, scene, ignored);
  if (surface.diffuseTexture.valid() && isBlack(surface.diffuse)) surface.diffuse = Rgb(1.0f);
  const double exponent = std::isfinite(m.shininess) ? std::max(m.shininess, 0.0) : 0.0;
  surface.specular.reflectance = m.illum == 1 ? Rgb(0.0f) : fractions(m.specular);
  surface.specular.roughness = static_cast<float>(std::sqrt(2 / (exponent + 2)));
  const Rgb sum = surface.diffuse + surface.specular.reflectance;
  if (maxChannel(sum) > 1) {
    surface.diffuse /= maxChannel(sum), surface.specular.reflectance /= maxChannel(sum);
    ++ignored["excesses of Kd + Ks over 1 (scaled down)"];
  }
  return surface;
}

Material materialOf(const tinyobj::material_t& m, const std::string& file, ObjTextures& textures, Scene& scene,
                    Ignored& ignored) {
  Material material;
  material.name = m.name;
  if (isPaneOfGlass(m)) {
    material.surface = glassOf(m);
  } else {
    material.surface = opaqueOf(m, textures, scene, ignored);
    material.coverage = coverageOf(m);
    material.filter = filterOf(m);
  }
  const glm::dvec3 emitted(m.emission[0], m.emission[1], m.emission[2]);
  constexpr double kLargest = 1e15;
  for (int c = 0; c < 3; ++c) {
    if (emitted[c] >= 0 && emitted[c] <= kLargest) continue;
    throw InputError(file, 0, "material '" + m.name + "' emits " + std::to_string(emitted[c]), "correct its Ke");
  }
  const Rgb radiance = material.coverage * Rgb(emitted);
  if (!isBlack(radiance)) material.emission = Emission{radiance, false, std::nullopt};
  for (const std::string* map :
       {&m.specular_texname, &m.specular_highlight_texname, &m.bump_texname, &m.normal_texname, &m.displacement_texname,
        &m.alpha_texname, &m.reflection_texname, &m.emissive_texname}) {
    if (!map->empty()) ++ignored["material maps other than map_Kd"];
  }
  if (m.roughness != 0 || m.metallic != 0) ++ignored["Pr and Pm parameters"];
  return material;
}

// `d -halo f` is f for us at every angle; tinyobjloader would take the option for the number.
std::string withoutHalo(std::string text, Ignored& ignored) {
  const std::string option = "-halo", blanks = " \t";
  for (std::size_t at = text.find(option, 2); at != std::string::npos; at = text.find(option, at + 1)) {
    const std::size_t d = text.find_last_not_of(blanks, at - 1);
    if (d == std::string::npos || d == at - 1 || text[d] != 'd') continue;
    const std::size_t before = d > 0 ? text.find_last_not_of(blanks, d - 1) : std::string::npos;
    if (before != std::string::npos && text[before] != '\n' && text[before] != '\r') continue;
    text.replace(at, option.size(), option.size(), ' ');
    ++ignored["-halo of d (the same at every angle)"];
  }
  return text;
}

std::vector<tinyobj::material_t> parseMaterials(const std::string& text, Ignored& ignored) {
  std::istringstream stream(withoutHalo(text, ignored));
  std::map<std::string, int> indices;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  tinyobj::LoadMtl(&indices, &materials, &stream, &warning, &error);
  return materials;
}

// A name may hold blanks, and one line may name several files: the whole line counts first.
std::vector<std::string> filesOf(const std::string& line, const std::string& name, int lineNumber,
                                 const fs::path& folder) {
  std::vector<std::string> candidates{line};
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    if (word != line) candidates.push_back(word);
  }
  std::vector<std::string> found;
  for (const std::string& candidate : candidates) {
    const fs::path file = resolveReference(candidate, folder, name, lineNumber, false);
    if (!fs::is_regular_file(file)) continue;
    found.push_back(file.string());
    if (candidate == line) break;
  }
  return found;
}

}  // namespace

std::map<std::string, MaterialId> addObjMaterials(const ObjSurvey& survey, const std::string& name,
                                                  const fs::path& folder, Scene& scene, Ignored& ignored) {
  std::map<std::string, MaterialId> ids;
  ObjTextures textures(folder, name);
  for (std::size_t i = 0; i < survey.materialLines.size(); ++i) {
    const std::vector<std::string> files =
        filesOf(survey.materialLines[i], name, survey.materialLineNumbers[i], folder);
    if (files.empty()) ++ignored["material files not found"];
    for (const std::string& file : files) {
      for (const tinyobj::material_t& material : parseMaterials(readInputFile(file), ignored)) {
        if (material.name.empty() || !ids.try_emplace(material.name, MaterialId(scene.materials.size())).second)
          continue;
        scene.materials.push_back(materialOf(material, file, textures, scene, ignored));
      }
    }
  }
  return ids;
}

}  // namespace deltalux::io
