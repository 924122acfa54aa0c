#include "io/obj/material.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <sstream>

#include "io/import_file.hpp"
#include "io/import_texture.hpp"
#include "io/obj/mtl.hpp"

namespace deltalux::io {

namespace {

using IgnoredStatements = std::map<std::string, std::size_t>;
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
float coverageOfMtl(const tinyobj::material_t& m) {
  const bool glass = m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9;
  if (m.dissolve < 1) return static_cast<float>(std::max(m.dissolve, 0.0));
  return glass ? 0.0f : 1.0f;
}

// Glass that refracts is a pane, whose reflection and transmission go by the angle.
bool isPaneOfGlass(const tinyobj::material_t& m) { return coverageOfMtl(m) == 0 && !(m.dissolve < 1) && m.ior > 1; }

ThinGlass glassOf(const tinyobj::material_t& m) {
  return {filterOf(m), static_cast<float>(std::clamp(m.ior, 1.0, 100.0))};
}

// Textures by file, each read once.
class ObjTextures {
 public:
  ObjTextures(const fs::path& folder, std::string referrer) : folder_(folder), referrer_(std::move(referrer)) {}

  TextureId put(std::string reference, Scene& scene, IgnoredStatements& ignored) {
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

Opaque opaqueOfMtl(const tinyobj::material_t& m, ObjTextures& textures, Scene& scene, IgnoredStatements& ignored) {
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

Material materialOf(const tinyobj::material_t& m, ObjTextures& textures, Scene& scene, IgnoredStatements& ignored) {
  Material material;
  material.name = m.name;
  if (isPaneOfGlass(m)) {
    material.surface = glassOf(m);
  } else {
    material.surface = opaqueOfMtl(m, textures, scene, ignored);
    material.coverage = coverageOfMtl(m);
    material.filter = filterOf(m);
  }
  const glm::dvec3 emitted(m.emission[0], m.emission[1], m.emission[2]);
  if (const Rgb radiance = material.coverage * Rgb(emitted); !isBlack(radiance))
    material.emission = Emission{radiance, false, std::nullopt};
  if (m.roughness != 0 || m.metallic != 0) ++ignored["Pr and Pm parameters"];
  return material;
}

// A name may hold blanks, and one line may name several files: the whole line counts first. What is not there is
// appended to `missing`.
std::vector<std::string> filesOf(const std::string& line, const std::string& name, int lineNumber,
                                 const fs::path& folder, std::vector<std::string>& missing) {
  std::vector<std::string> candidates{line};
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    if (word != line) candidates.push_back(word);
  }
  std::vector<std::string> found, lost;
  for (const std::string& candidate : candidates) {
    const fs::path file = resolveReference(candidate, folder, name, lineNumber, false);
    if (!fs::is_regular_file(file)) {
      lost.push_back(candidate);
      continue;
    }
    found.push_back(file.string());
    if (candidate == line) break;
  }
  // The line as a whole is a name only when none of its words is one.
  if (found.empty()) missing.push_back(line);
  if (!found.empty() && lost.size() > 1) missing.insert(missing.end(), lost.begin() + 1, lost.end());
  return found;
}

void warnOfMissing(const std::vector<std::string>& files, const fs::path& folder, ImportReport& report) {
  if (files.empty()) return;
  constexpr std::size_t kShown = 5;  // [shown]
  std::string list;
  for (std::size_t i = 0; i < std::min(files.size(), kShown); ++i)
    list += (i > 0 ? ", " : "") + ("'" + files[i].substr(0, 100) + "'");
  if (files.size() > kShown) list += " and " + std::to_string(files.size() - kShown) + " more";
  report.ignored["material files not found"] += files.size();
  report.warnings.push_back("material files not found in " + (folder.empty() ? fs::path(".") : folder).string() + ": " +
                            list + "; surfaces of their materials are grey");
}

}  // namespace

std::map<std::string, MaterialId> addObjMaterials(const ObjSurvey& survey, const std::string& name,
                                                  const fs::path& folder, Scene& scene, ImportReport& report) {
  std::map<std::string, MaterialId> ids;
  std::vector<std::string> missing;
  ObjTextures textures(folder, name);
  for (std::size_t i = 0; i < survey.materialLines.size(); ++i) {
    const std::vector<std::string> files =
        filesOf(survey.materialLines[i], name, survey.materialLineNumbers[i], folder, missing);
    for (const std::string& file : files) {
      for (const tinyobj::material_t& material : readMtl(readInputFile(file), file, report.ignored)) {
        if (material.name.empty() || !ids.try_emplace(material.name, MaterialId(scene.materials.size())).second)
          continue;
        scene.materials.push_back(materialOf(material, textures, scene, report.ignored));
      }
    }
  }
  warnOfMissing(missing, folder, report);
  return ids;
}

}  // namespace deltalux::io
