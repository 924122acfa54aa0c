#include "export/atlas_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/check.hpp"
#include "export/atlas_pack.hpp"

namespace deltalux::exporting {

namespace {

constexpr int kHalvings =
    12;  // of the ratio between the finest and the coarsest density: it ends within a per cent [task]

int texelsAlong(double length, double density, int most) {
  if (!(length > 0)) return 1;
  return static_cast<int>(std::clamp(std::ceil(length * density) + 1, 2.0, double(std::max(most, 1))));
}

std::vector<glm::ivec2> sizesAt(const std::vector<AtlasChart>& charts, const AtlasSettings& settings, double density) {
  std::vector<glm::ivec2> sizes;
  const int most = settings.side - 2 * settings.gutter;
  for (const AtlasChart& c : charts)
    sizes.emplace_back(texelsAlong(c.size.x, density, most) + 2 * settings.gutter,
                       texelsAlong(c.size.y, density, most) + 2 * settings.gutter);
  return sizes;
}

bool fitsOnePage(const std::vector<AtlasChart>& charts, const AtlasSettings& settings, double density) {
  const std::vector<glm::ivec2> sizes = sizesAt(charts, settings, density);
  double area = 0;
  for (const glm::ivec2& s : sizes) area += double(s.x) * s.y;
  if (area > double(settings.side) * settings.side) return false;
  return packRects(sizes, settings.side).pages.size() <= 1;
}

/// The largest density at which the charts fit one page, `finest` at most; the least one where none does.
double fittingDensity(const std::vector<AtlasChart>& charts, const AtlasSettings& settings, double finest) {
  double length = 0;
  for (const AtlasChart& c : charts) length = std::max({length, c.size.x, c.size.y});
  if (!(length > 0)) return 1;
  double low = std::min(1 / length, finest), high = std::min(settings.side / length, finest);
  if (fitsOnePage(charts, settings, high)) return high;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (fitsOnePage(charts, settings, middle) ? low : high) = middle;
  }
  return low;
}

/// On pages of that side, or on one of half, a quarter ... where that is enough.
Packing packedTightly(const std::vector<glm::ivec2>& sizes, int side) {
  Packing packing = packRects(sizes, side);
  int largest = 1;
  for (const glm::ivec2& s : sizes) largest = std::max({largest, s.x, s.y});
  while (packing.pages.size() == 1 && side / 2 >= largest) {
    Packing smaller = packRects(sizes, side /= 2);
    if (smaller.pages.size() > 1) break;
    packing = std::move(smaller);
  }
  return packing;
}

/// The groups one after the other, in ascending order.
Packing packedByGroup(const std::vector<AtlasChart>& charts, const std::vector<glm::ivec2>& sizes, int side) {
  std::map<int, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < charts.size(); ++i) groups[charts[i].group].push_back(i);
  Packing all;
  all.at.resize(charts.size());
  for (const auto& [group, members] : groups) {
    std::vector<glm::ivec2> own;
    for (const std::size_t i : members) own.push_back(sizes[i]);
    const Packing packing = packedTightly(own, side);
    for (std::size_t k = 0; k < members.size(); ++k) {
      all.at[members[k]] = packing.at[k];
      all.at[members[k]].page += static_cast<std::uint32_t>(all.pages.size());
    }
    all.pages.insert(all.pages.end(), packing.pages.begin(), packing.pages.end());
  }
  return all;
}

}  // namespace

Atlas layOut(std::vector<AtlasChart> charts, const AtlasSettings& settings, double finest) {
  DELTALUX_CHECK(settings.gutter >= 0 && settings.side > 2 * settings.gutter + 1, "a page holds more than a gutter");
  Atlas atlas;
  atlas.gutter = settings.gutter;
  atlas.texelsPerUnit = settings.texelsPerUnit > 0
                            ? settings.texelsPerUnit
                            : fittingDensity(charts, settings, finest > 0 ? 1 / finest : kInfinity);
  const std::vector<glm::ivec2> sizes = sizesAt(charts, settings, atlas.texelsPerUnit);
  const Packing packing = packedByGroup(charts, sizes, settings.side);
  for (std::size_t i = 0; i < charts.size(); ++i)
    atlas.places.push_back(
        {packing.at[i].page, packing.at[i].corner + settings.gutter, sizes[i] - 2 * settings.gutter});
  atlas.charts = std::move(charts);
  atlas.pages = packing.pages;
  return atlas;
}

Vec2 texelOf(const AtlasChart& chart, const ChartPlace& place, const Vec2& p) {
  Vec2 texel(0);
  for (int axis = 0; axis < 2; ++axis)
    if (chart.size[axis] > 0) texel[axis] = p[axis] / chart.size[axis] * (place.texels[axis] - 1);
  return texel;
}

Vec2 texcoordOf(const Atlas& atlas, std::size_t chart, const Vec2& p) {
  const ChartPlace& place = atlas.places[chart];
  return (Vec2(place.first) + texelOf(atlas.charts[chart], place, p) + 0.5) / Vec2(atlas.pages[place.page]);
}

}  // namespace deltalux::exporting
