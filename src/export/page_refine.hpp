#pragma once
// Direct light of suns and lamps on a page's mesh, measured at its corners and at more of them along shadows
// (refine.hpp), in the place of what the solution's mesh has.
#include "export/page_mesh.hpp"
#include "export/refine.hpp"

namespace deltalux::exporting {

/// Floors of the layers (LightFloors) over the mesh.
std::vector<double> floorsOf(const PageMesh&, const std::vector<std::vector<Rgb>>& layers);

/// `layers`, `direct`: by group and vertex, as pageLayer() and pageDirect() have them; layers are brought up to date.
/// `whole`: by side, those whose triangles stay as they are (sidesUnderTextures()). The mesh has no `source` then.
void refineDirect(PageMesh&, std::vector<std::vector<Rgb>>& layers, const std::vector<std::vector<Rgb>>& direct,
                  const Scene&, const DirectLight&, const Refinement&, const std::vector<char>& whole);

}  // namespace deltalux::exporting
