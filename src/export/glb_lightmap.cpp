// exportGlb: geometry, materials and irradiance.
#include <fmt/format.h>

#include <algorithm>
#include <deltalux/light_groups.hpp>
#include <deltalux/solution_reader.hpp>
#include <map>
#include <tuple>

#include "export/advance.hpp"
#include "export/glb_document.hpp"
#include "export/glb_images.hpp"
#include "export/glb_material.hpp"
#include "export/lightmap.hpp"
#include "export/rgbm.hpp"
#include "io/image/formats.hpp"
#include "scene/texture_tint.hpp"

namespace deltalux {

namespace exporting {

namespace {

/// The pages of an atlas in the file, and what a decoded texel is multiplied by to be irradiance [W/m2].
struct LightmapTextures {
  std::vector<std::size_t> textures;
  std::vector<float> intensities;
};

/// The value that all but a share of the covered pixels' channels stay within; 1 where all is dark.
float whiteOf(const Image& page, const std::vector<char>& covered, double clipped) {
  std::vector<float> peaks;
  for (std::size_t i = 0; i < page.pixels.size(); ++i)
    if (covered[i] && !isBlack(page.pixels[i])) peaks.push_back(maxChannel(page.pixels[i]));
  if (peaks.empty()) return 1;
  const auto at = peaks.begin() + static_cast<std::ptrdiff_t>((1 - clipped) * static_cast<double>(peaks.size() - 1));
  std::nth_element(peaks.begin(), at, peaks.end());
  return *at;
}

LightmapTextures addLightmaps(GlbContainer& glb, const std::vector<Image>& pages,
                              const std::vector<std::vector<char>>& covered, const GlbSettings& settings) {
  const bool linear = settings.lightmap == LightmapExtension::Moz;
  LightmapTextures result;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    // RGBM has steps to spare for the brightest.
    const float white = whiteOf(pages[i], covered[i], linear ? settings.clipped : 0.0);
    result.intensities.push_back(linear ? white : white / kRgbmRange);
    result.textures.push_back(addAtlasTexture(glb, (linear ? linearPng : rgbmPng)(pages[i], result.intensities[i]),
                                              fmt::format("lightmap {}", i)));
  }
  return result;
}

/// The materials of the file: one per material, what a side of it has, and page.
class LitMaterials {
 public:
  /// `lightmaps`: that materials name; null: nodes do.
  LitMaterials(GlbContainer& glb, const Scene& scene, const LightmapTextures* lightmaps)
      : glb_(glb), scene_(scene), lightmaps_(lightmaps) {}

  std::size_t of(const SurfaceMesh& side, std::optional<std::uint32_t> page) {
    const Rgb &a = side.albedo, &L = side.radiance;
    const bool back = !side.front && std::holds_alternative<Mirror>(scene_.materialOf(side.primitive).surface);
    const int named = lightmaps_ && page ? int(*page) : kNone;
    const Key key{scene_[side.primitive].material.value, named, back, a.r, a.g, a.b, L.r, L.g, L.b};
    const auto [place, fresh] = known_.try_emplace(key, 0);
    if (fresh) place->second = add(side, named);
    return place->second;
  }

 private:
  static constexpr int kNone = -1;  // [sentinel]
  using Key = std::tuple<std::uint32_t, int, bool, float, float, float, float, float, float>;

  std::size_t add(const SurfaceMesh& side, int page) {
    GlbJson json = litMaterial(glb_, scene_, side);
    if (const TextureId texture = scene::diffuseTexture(scene_, side.primitive); texture.valid())
      json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", textureOf(texture)}};
    if (page != kNone) {
      const auto at = static_cast<std::size_t>(page);
      json["extensions"]["MOZ_lightmap"] = {
          {"index", lightmaps_->textures[at]}, {"texCoord", 1}, {"intensity", lightmaps_->intensities[at]}};
      glb_.use("MOZ_lightmap");
    }
    return glb_.add("materials", std::move(json));
  }

  std::size_t textureOf(TextureId id) {
    const auto [place, fresh] = textures_.try_emplace(id.value, 0);
    if (fresh) place->second = addSceneTexture(glb_, scene_.textures[id.index()]);
    return place->second;
  }

  GlbContainer& glb_;
  const Scene& scene_;
  const LightmapTextures* lightmaps_;
  std::map<Key, std::size_t> known_;
  std::map<std::uint32_t, std::size_t> textures_;
};

std::filesystem::path besides(const std::filesystem::path& glb, const std::string& what) {
  std::filesystem::path path = glb;
  path.replace_filename(glb.stem().string() + ".lightmap" + what + ".exr");
  return path;
}

/// Letters, digits, dots and dashes of a name; the rest as underscores.
std::string fitForFile(std::string name) {
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-')) c = '_';
  return name;
}

std::string pageSuffix(std::size_t page) { return page == 0 ? "" : fmt::format(".{}", page); }

Rgb irradianceAt(const BakedTexel& texel) { return texel.irradiance; }

GlbJson lightmapExtras(const std::filesystem::path& glb, const LightmapTextures& lightmaps,
                       const GlbSettings& settings) {
  const bool linear = settings.lightmap == LightmapExtension::Moz;
  GlbJson extras{
      {"quantity", "irradiance E of direct, indirect and caustic light, without 1/pi"},
      {"units", "W/m2"},
      {"factor", 1},
      {"encoding", linear ? "linear, 8 bits: E = texel / 255 * intensity of the material's MOZ_lightmap * factor"
                          : fmt::format("RGBM, linear: E = {} * (a / 255)^{} * rgb / 255 * intensity of the "
                                        "node's MX_lightmap * factor",
                                        kRgbmRange, kRgbmPower)},
      {"clippedShare", linear ? settings.clipped : 0},
      {"texCoord", 1}};
  for (std::size_t i = 0; i < lightmaps.textures.size(); ++i)
    extras["pages"].push_back({{"texture", lightmaps.textures[i]},
                               {"intensity", lightmaps.intensities[i]},
                               {"exr", besides(glb, pageSuffix(i)).filename().string()}});
  return extras;
}

/// What a node says whose light is on a page. [MX_lightmap]
GlbJson nodeLightmap(GlbContainer& glb, const LightmapTextures& lightmaps, std::uint32_t page) {
  glb.use("MX_lightmap");
  return {{"MX_lightmap",
           {{"lightMapTexture", {{"index", lightmaps.textures[page]}, {"texCoord", 1}}},
            {"scale", {1, 1}},
            {"offset", {0, 0}},
            {"intensity", lightmaps.intensities[page]}}}};
}

/// The .glb and its pages as .exr.
std::vector<FileBytes> litFiles(const ChartedMesh& charted, const std::filesystem::path& path,
                                const GlbSettings& settings, GeometryCounts& counts) {
  std::vector<std::vector<char>> covered;
  const std::vector<Image> pages = bake(charted.atlas, charted.mesh, charted.light, irradianceAt, &covered);
  GlbContainer glb;
  glb.json["asset"] = assetOf(*charted.mesh.scene);
  const LightmapTextures lightmaps = addLightmaps(glb, pages, covered, settings);
  glb.json["asset"]["extras"]["deltalux"]["lightmap"] = lightmapExtras(path, lightmaps, settings);
  const bool ofMaterials = settings.lightmap == LightmapExtension::Moz;
  LitMaterials materials(glb, *charted.mesh.scene, ofMaterials ? &lightmaps : nullptr);
  PageOfNode ofNode;
  if (!ofMaterials) ofNode = [&](std::uint32_t page) { return nodeLightmap(glb, lightmaps, page); };
  counts = addGeometry(
      glb, charted.mesh, charted.atlas, AtlasSet::Second,
      [&](const SurfaceMesh& side, std::optional<std::uint32_t> page) { return materials.of(side, page); },
      addViewBy(settings), ofNode);
  std::vector<FileBytes> files{{path, glb.bytes()}};
  for (std::size_t i = 0; i < pages.size(); ++i)
    files.push_back({besides(path, pageSuffix(i)), io::encodeExr(pages[i])});
  return files;
}

void addGroupFiles(std::vector<FileBytes>& files, const SolutionView& solution, const ChartedMesh& charted,
                   const std::filesystem::path& path, Progress* progress) {
  const std::vector<LightGroup> groups = lightGroups(solution);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    advance(progress, "groups", static_cast<double>(g) / static_cast<double>(groups.size()));
    const SolutionView group = lightOf(solution, g);
    const MeasuredLight light = bakedLight(group, SolutionReader(group).mesh());
    const std::vector<Image> pages = bake(charted.atlas, charted.mesh, light, irradianceAt);
    for (std::size_t i = 0; i < pages.size(); ++i)
      files.push_back({besides(path, "." + fitForFile(groups[g].name) + pageSuffix(i)), io::encodeExr(pages[i])});
  }
}

GlbReport exportLit(const SolutionView& solution, const std::filesystem::path& path, const GlbSettings& settings,
                    bool byLight, Progress* progress) {
  const ChartedMesh charted = chartedMesh(solution, settings, progress);
  advance(progress, "light", 0);
  GeometryCounts counts;
  std::vector<FileBytes> files = litFiles(charted, path, settings, counts);
  if (byLight) addGroupFiles(files, solution, charted, path, progress);
  writeAll(files);
  return reportOf(charted, counts, files);
}

}  // namespace

}  // namespace exporting

GlbReport exportGlb(const SolutionView& solution, const std::filesystem::path& path, const GlbSettings& settings,
                    Progress* progress) {
  return exporting::exportLit(solution, path, settings, false, progress);
}

GlbReport exportGlbByLight(const SolutionView& solution, const std::filesystem::path& path, const GlbSettings& settings,
                           Progress* progress) {
  return exporting::exportLit(solution, path, settings, true, progress);
}

}  // namespace deltalux
