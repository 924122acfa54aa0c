#pragma once
// What lit and unlit files have in common: the mesh with its atlas, what the file says of itself, and how it is
// written.
#include <deltalux/export_glb.hpp>
#include <deltalux/solution_mesh.hpp>

#include "export/atlas_layout.hpp"
#include "export/glb_container.hpp"
#include "export/glb_geometry.hpp"
#include "export/measured_direct.hpp"

namespace deltalux::exporting {

struct ChartedMesh {
  SolutionMesh mesh;
  MeasuredLight light;  // of it
  Atlas atlas;
};

/// Throws Interrupted. Precondition: the settings are in their ranges.
ChartedMesh chartedMesh(const SolutionView&, const GlbSettings&, Progress*);

/// Measures the light of the solution, or of a group of its lights, for the atlas of the whole.
MeasuredLight bakedLight(const SolutionView&, const SolutionMesh&);

/// glTF's `asset`, whose extras say where the origin lies and what the numbers mean.
GlbJson assetOf(const Scene&);

/// How views of geometry are added.
AddView addViewBy(const GlbSettings&);

/// A file to be written, complete.
struct FileBytes {
  std::filesystem::path path;
  std::string bytes;
};
/// Writes all, and then puts each in its place. Throws OutputError.
void writeAll(const std::vector<FileBytes>&);

GlbReport reportOf(const ChartedMesh&, const GeometryCounts&, const std::vector<FileBytes>&);

}  // namespace deltalux::exporting
