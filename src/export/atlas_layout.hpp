#pragma once
// Charts as rectangles of texels on the pages of an atlas.
//
// A chart's first and last texel centres lie on its borders: rectangles need no texel beyond them, so that nothing is
// extrapolated at their edges. Around each chart lies a gutter that no other uses.
#include <deltalux/math.hpp>
#include <vector>

#include "export/atlas_charts.hpp"

namespace deltalux::exporting {

struct AtlasSettings {
  double texelsPerUnit = 0;  // along charts [1/scene unit]; 0: as many as one page holds, but no more than of use
  int side = 2048;           // of the largest page [texels]
  int gutter = 2;            // texels around a chart
};

struct ChartPlace {
  std::uint32_t page = 0;
  glm::ivec2 first{0};   // the texel of the chart's least coordinates, its gutter beside it
  glm::ivec2 texels{1};  // without the gutter
};

struct Atlas {
  std::vector<AtlasChart> charts;
  std::vector<ChartPlace> places;  // by chart
  std::vector<glm::ivec2> pages;   // their sizes [texels]
  double texelsPerUnit = 0;        // what was taken; charts are larger by less than a texel
  int gutter = 0;
};

/// `finest`: texels smaller than that show nothing more [scene units]. Charts too large for a page have fewer texels.
/// Precondition: side > 2 gutter + 1.
Atlas layOut(std::vector<AtlasChart>, const AtlasSettings&, double finest);

/// A place of a chart in texels from the centre of its first one.
Vec2 texelOf(const AtlasChart&, const ChartPlace&, const Vec2& place);
/// The same as texture coordinates of the page: (0, 0) at the corner of its first texel.
Vec2 texcoordOf(const Atlas&, std::size_t chart, const Vec2& place);

}  // namespace deltalux::exporting
