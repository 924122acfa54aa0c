// exportUnlitGlb: what surfaces send, as any viewer shows it.
#include <fmt/format.h>
#include <deltalux/image.hpp>
#include <map>
#include <memory>
#include <tuple>

#include "export/advance.hpp"
#include "export/glb_document.hpp"
#include "export/glb_images.hpp"
#include "export/glb_material.hpp"
#include "export/lightmap.hpp"
#include "export/lightmap_side_light.hpp"
#include "io/image/formats.hpp"
#include "scene/texture_tint.hpp"

namespace deltalux {

namespace exporting {

namespace {

/// What comes through a side from behind it.
class LightBehind {
 public:
  explicit LightBehind(const SolutionMesh& mesh) : sides_(mesh.surfaces.size()) {
    for (const auto& side : mesh.surfaces) {
      if (!side || isBlack(side->transmittance)) continue;
      const std::size_t behind = SolutionMesh::side(side->primitive, !side->front);
      if (mesh.surfaces[behind]) sides_[behind] = std::make_unique<const SideLight>(*mesh.surfaces[behind]);
    }
  }

  /// tau E of the other side [W/m2].
  Rgb at(const BakedTexel& t) const {
    if (isBlack(t.side.transmittance)) return Rgb(0.0f);
    const auto& behind = sides_[SolutionMesh::side(t.side.primitive, !t.side.front)];
    if (!behind) return Rgb(0.0f);
    const Vec3f a = t.side.vertices[t.corners[0]].position;
    const float size = std::max(glm::length(t.side.vertices[t.corners[1]].position - a),
                                glm::length(t.side.vertices[t.corners[2]].position - a));
    return t.side.transmittance * behind->at(t.position, size).value_or(Rgb(0.0f));
  }

 private:
  std::vector<std::unique_ptr<const SideLight>> sides_;
};

/// rho of a side with its texture, if it has one.
Rgb albedoAt(const Scene& scene, const BakedTexel& t) {
  const TextureId texture = scene::diffuseTexture(scene, t.side.primitive);
  if (!texture.valid()) return t.side.albedo;
  const glm::vec2 uv = within(t.side.vertices[t.corners[0]].uv, t.side.vertices[t.corners[1]].uv,
                              t.side.vertices[t.corners[2]].uv, t.texel.nearest);
  return t.side.albedo * scene.textures[texture.index()].sample(Vec2(uv));
}

std::vector<Image> radiancePages(const ChartedMesh& charted) {
  const LightBehind behind(charted.mesh);
  return bake(charted.atlas, charted.mesh, charted.light, [&](const BakedTexel& t) {
    const Rgb sent = albedoAt(*charted.mesh.scene, t) * t.irradiance + behind.at(t);
    return t.side.radiance + sent / static_cast<float>(kPi);
  });
}

double exposureFor(const std::vector<Image>& pages) {
  Image all;
  for (const Image& p : pages) all.pixels.insert(all.pixels.end(), p.pixels.begin(), p.pixels.end());
  return automaticEv(all);
}

/// A colour as the tone mapping has it, linear.
Rgb shownAs(const Rgb& radiance, const ToneMapping& mapping) {
  Image pixel;
  pixel.width = pixel.height = 1;
  pixel.pixels = {radiance};
  const std::array<std::uint8_t, 3> shown = toneMap(pixel, mapping).pixels[0];
  Rgb linear;
  for (std::size_t c = 0; c < 3; ++c) linear[static_cast<int>(c)] = static_cast<float>(decodeSrgb(shown[c] / 255.0));
  return linear;
}

class UnlitMaterials {
 public:
  UnlitMaterials(GlbContainer& glb, const Scene& scene, std::vector<std::size_t> pages, const ToneMapping& mapping)
      : glb_(glb), scene_(scene), pages_(std::move(pages)), mapping_(mapping) {}

  std::size_t of(const SurfaceMesh& side, std::optional<std::uint32_t> page) {
    const Rgb L = page ? Rgb(0.0f) : side.radiance;
    const Key key{scene_[side.primitive].material.value, page ? int(*page) : -1, L.r, L.g, L.b};
    const auto [place, fresh] = known_.try_emplace(key, 0);
    if (fresh)
      place->second = glb_.add(
          "materials", unlitMaterial(glb_, scene_.materialOf(side.primitive), page ? Rgb(1.0f) : shownAs(L, mapping_),
                                     page ? std::optional(pages_[*page]) : std::nullopt));
    return place->second;
  }

 private:
  using Key = std::tuple<std::uint32_t, int, float, float, float>;

  GlbContainer& glb_;
  const Scene& scene_;
  std::vector<std::size_t> pages_;
  ToneMapping mapping_;
  std::map<Key, std::size_t> known_;
};

}  // namespace

}  // namespace exporting

GlbReport exportUnlitGlb(const SolutionView& solution, const std::filesystem::path& path, std::optional<double> ev,
                         const GlbSettings& settings, Progress* progress) {
  using namespace exporting;
  const ChartedMesh charted = chartedMesh(solution, settings, progress);
  advance(progress, "light", 0);
  const std::vector<Image> pages = radiancePages(charted);
  ToneMapping mapping;
  mapping.ev = ev ? *ev : exposureFor(pages);

  GlbContainer glb;
  glb.json["asset"] = assetOf(*charted.mesh.scene);
  glb.json["asset"]["extras"]["deltalux"]["unlit"] = {{"quantity", "albedo E / pi + L [W/(sr m2)], tone-mapped, sRGB"},
                                                      {"ev", mapping.ev},
                                                      {"toneOperator", toneOperatorName(mapping.toneOperator)}};
  std::vector<std::size_t> textures;
  for (std::size_t i = 0; i < pages.size(); ++i)
    textures.push_back(addAtlasTexture(glb, io::encodePng(toneMap(pages[i], mapping)), fmt::format("light {}", i)));
  UnlitMaterials materials(glb, *charted.mesh.scene, std::move(textures), mapping);
  const GeometryCounts counts = addGeometry(
      glb, charted.mesh, charted.atlas, AtlasSet::Only,
      [&](const SurfaceMesh& side, std::optional<std::uint32_t> page) { return materials.of(side, page); },
      addViewBy(settings));
  const std::vector<FileBytes> files{{path, glb.bytes()}};
  writeAll(files);
  GlbReport report = reportOf(charted, counts, files);
  report.ev = mapping.ev;
  return report;
}

}  // namespace deltalux
