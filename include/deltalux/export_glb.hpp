#pragma once
// A solution as a glTF 2.0 binary (.glb) for other programs: geometry, materials, and the light baked into an atlas of
// lightmaps. docs/export_glb.md says what stands where in the file, and how to show it.
#include <cstdint>
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltalux {

/// How a file says that its textures are light.
enum class LightmapExtension {
  Moz,  // MOZ_lightmap of materials: 8 linear bits of a page's full scale
  Mx    // MX_lightmap of nodes: RGBM, so that bright and dark share a page; an object is a node per page
};

struct GlbSettings {
  double texelsPerMetre = 0;  // of the atlas; 0: as many as one page holds, but no more than show something
  int atlasSize = 2048;       // side of the largest page [texels], 64 to 16384
  int gutter = 2;             // texels around a chart that no other uses, 0 to 16
  double crease = 40;         // degrees, below 90: how far triangles of a mesh may turn within one chart
  double clipped = 0.01;      // share of the lit texels that the 8-bit lightmap may clip, in [0, 1)
  double range = 8;           // brightness of charts that share a page, over each other, above 1
  bool meshopt = false;       // geometry by EXT_meshopt_compression, without loss
  LightmapExtension lightmap = LightmapExtension::Moz;  // of a lit file
};

struct GlbReport {
  std::vector<std::filesystem::path> files;  // written, the .glb first
  std::uint64_t bytes = 0;                   // of the .glb
  std::size_t triangles = 0, vertices = 0, charts = 0, pages = 0;
  double texelsPerMetre = 0;  // what was taken
  double ev = 0;              // exposure of an unlit one [stops]
};

/// Writes FILE.glb with the light in TEXCOORD_1 lightmaps, and beside it FILE.lightmap.exr
/// (page n from 1: FILE.lightmap.n.exr): irradiance E [W/m2], 32-bit float, direct, indirect and caustics, as the
/// lights are dimmed now. All files are written, then put in place, atomically one by one. Throws OutputError,
/// Interrupted.
GlbReport exportGlb(const SolutionView&, const std::filesystem::path&, const GlbSettings& = {},
                    Progress* progress = nullptr);

/// As exportGlb, and FILE.lightmap.GROUP.exr for each group of lights that the solution holds apart (light_groups.hpp),
/// at scale 1.
GlbReport exportGlbByLight(const SolutionView&, const std::filesystem::path&, const GlbSettings& = {},
                           Progress* progress = nullptr);

/// Writes one .glb that any viewer shows as it is (KHR_materials_unlit): what surfaces send, albedo E / pi + L,
/// tone-mapped as pictures are (image.hpp). `ev`: exposure in stops; nullopt: chosen from the atlas. Throws
/// OutputError, Interrupted.
GlbReport exportUnlitGlb(const SolutionView&, const std::filesystem::path&, std::optional<double> ev = std::nullopt,
                         const GlbSettings& = {}, Progress* progress = nullptr);

}  // namespace deltalux
