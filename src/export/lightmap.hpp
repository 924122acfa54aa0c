#pragma once
// The light of a solution's sides on the pages of an atlas: irradiance at every texel's centre is what the mesh has
// there, direct, indirect and particles, and what was measured in its place, plus the mean over the texel of what the
// caustic textures of its side show.
#include <deltalux/image.hpp>
#include <deltalux/solution_mesh.hpp>
#include <functional>
#include <vector>

#include "export/atlas_layout.hpp"
#include "export/lightmap_texels.hpp"
#include "export/measured_direct.hpp"

namespace deltalux::exporting {

/// Charts of all sides that light falls on. `crease` [radians] as for chartsOf().
std::vector<AtlasChart> litCharts(const SolutionMesh&, double crease);
bool isLit(const SolutionMesh&, std::size_t side);
/// Puts charts of different brightness into different groups, by the median over their vertices: within a group one is
/// at most `range` times as bright as another. Eight bits of a page then serve all of it.
void groupByBrightness(std::vector<AtlasChart>&, const SolutionMesh&, double range);

/// The size of texel below which nothing more would be seen: a quarter of the median size of a triangle of the charts,
/// or the median texel of the caustic textures where those are finer [scene units].
double finestTexel(const SolutionMesh&, const std::vector<AtlasChart>&);

/// A texel of a chart to be coloured.
struct BakedTexel {
  std::size_t chart = 0;
  const SurfaceMesh& side;
  const LightmapTexel& texel;
  std::array<std::uint32_t, 3> corners;  // vertices of the side
  Rgb irradiance{0.0f};                  // E [W/m2]
  Vec3f position{0.0f};                  // of the nearest point of the side
};

/// The pages. `colour` makes a pixel of a texel: irradiance itself, or what is seen there. Pixels of no chart are 0.
/// `covered`, unless null, gets 1 for every pixel of a chart, by page. `light` holds what is read, and may be the light
/// of a group (light_groups.hpp), whose vertices are those of the mesh the charts were made of.
/// Cost: a triangle per texel, and some lookups of caustic textures.
std::vector<Image> bake(const Atlas&, const SolutionMesh& whole, const MeasuredLight& light,
                        const std::function<Rgb(const BakedTexel&)>& colour,
                        std::vector<std::vector<char>>* covered = nullptr);

}  // namespace deltalux::exporting
