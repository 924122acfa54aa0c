#pragma once
// The triangles of a solution as nodes and meshes of a .glb: a node per object, a primitive of its mesh per material
// and page of the atlas, single-sided, each side of a surface for itself.
//
// Left out are backs that no light falls on and that send none, but for panes: nobody sees them.
#include <deltalux/solution_mesh.hpp>
#include <functional>
#include <optional>

#include "export/atlas_layout.hpp"
#include "export/glb_container.hpp"

namespace deltalux::exporting {

/// Where a primitive's texture coordinates go.
enum class AtlasSet {
  Second,  // TEXCOORD_1, and the mesh's own in TEXCOORD_0
  Only     // TEXCOORD_0
};

/// What of a .glb a side becomes: the number of its material. `page`: of the atlas; nullopt: no light falls on it.
using MaterialOfSide = std::function<std::size_t(const SurfaceMesh&, std::optional<std::uint32_t> page)>;
/// Extensions of a node whose sides have their light on this page of the atlas; empty: nodes do not say.
using PageOfNode = std::function<GlbJson(std::uint32_t page)>;
using AddView = std::size_t (GlbContainer::*)(std::string_view bytes, std::size_t stride, int target);

struct GeometryCounts {
  std::size_t triangles = 0, vertices = 0;
};

/// Whether a side is exported.
bool isShown(const SolutionMesh&, std::size_t side);

/// Adds accessors, meshes, nodes and the scene. The root node turns the scene's up to +y and its units to metres. Where
/// nodes say on which page their light is, an object on several pages is a node with one child a page.
GeometryCounts addGeometry(GlbContainer&, const SolutionMesh&, const Atlas&, AtlasSet, const MaterialOfSide&, AddView,
                           const PageOfNode& = {});

}  // namespace deltalux::exporting
