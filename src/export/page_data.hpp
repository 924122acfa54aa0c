#pragma once
// All that a page holds, and the bytes that it becomes: what its first picture needs, and the light of each group of
// several, which it reads after that. First:
//
//   u32 length of the header, the header (JSON), zeros up to a multiple of 4, sections one after the other, each padded
//   with zeros to a multiple of 4. Numbers have their lowest byte first. header.sections: name -> [offset from the end
//   of the header's zeros, bytes].
//
//   positions         three times differencePlanes() of multiples of header.step above header.lower [scene units]
//   normals           octahedral, int8: all first ones, all second ones, times 127
//   uvs               float32 pairs; only where a draw has a texture
//   sides             u32 pairs: vertices of a side, its material
//   triangles         differencePlanes() of three indices each, header.draws after header.draws
//   sum               rgb9e5Planes(): irradiance of all groups at their weights, by vertex, roughly [W/m2]
//   skyI              float32, header.skySize texels of header.skies[I] [W/(sr m2)]
//   textureI          bytes, header.textures[I]
//   causticI.*        header.caustics[I]: positions, texcoords (float32), materials, triangles, texels (u32, RGB9E5),
//                     shows (u8)
//   points.places     float32, position and normal of a point; points.light: float32 by group, point, channel [W/m2]
//
// Later, sections alone, of which header.later tells: name -> [offset, bytes]. Of a single group it is the first part's
// and in the place of the sum.
//
//   layerG            rgb9e5Planes(): irradiance of group G at weight 1, by vertex [W/m2]
#include <deltalux/export.hpp>
#include <optional>
#include <string>
#include <vector>

#include "export/page_caustics.hpp"
#include "export/page_lights.hpp"
#include "export/page_mesh.hpp"
#include "export/page_sky.hpp"

namespace deltalux::exporting {

struct PageData {
  std::string title;
  double efficacy = kLuminousEfficacy;  // [lm/W]
  double ev = 0;
  bool byLight = false;
  std::vector<PageGroup> groups;
  std::vector<View> views;
  PageMesh mesh;
  std::vector<std::vector<Rgb>> layers;               // by group, pageLayer()
  std::vector<std::optional<PageCaustics>> caustics;  // by group
  std::vector<PageSky> skies;
  std::vector<PageSun> suns;
  std::vector<PageGrid> grids;
  std::vector<std::vector<Rgb>> pointLight;  // by group and point [W/m2]
};

struct PageBytes {
  std::string first, later;
};
PageBytes pageBytes(const PageData&, const Scene&);

}  // namespace deltalux::exporting
