#include "export/glb_document.hpp"

#include <deltalux/solution_reader.hpp>
#include <memory>

#include "base/check.hpp"
#include "export/advance.hpp"
#include "export/lightmap.hpp"
#include "io/atomic_file.hpp"

namespace deltalux::exporting {

namespace {

void requireRanges(const GlbSettings& s) {
  DELTALUX_CHECK(s.texelsPerMetre >= 0 && std::isfinite(s.texelsPerMetre), "texels per metre are 0 or more");
  DELTALUX_CHECK(s.atlasSize >= 64 && s.atlasSize <= 16384, "a page has 64 to 16384 texels a side");
  DELTALUX_CHECK(s.gutter >= 0 && s.gutter <= 16, "a gutter has 0 to 16 texels");
  DELTALUX_CHECK(s.crease > 0 && s.crease < 90, "a crease is between 0 and 90 degrees");
  DELTALUX_CHECK(s.range > 1 && std::isfinite(s.range), "a range of brightness is above 1");
  DELTALUX_CHECK(s.clipped >= 0 && s.clipped < 1, "what is clipped is a share below 1");
}

}  // namespace

ChartedMesh chartedMesh(const SolutionView& solution, const GlbSettings& settings, Progress* progress) {
  requireRanges(settings);
  advance(progress, "mesh", 0);
  ChartedMesh result;
  result.mesh = SolutionReader(solution).mesh();
  advance(progress, "direct light", 0);
  result.light = bakedLight(solution, result.mesh);
  advance(progress, "charts", 0);
  std::vector<AtlasChart> charts = litCharts(result.mesh, glm::radians(settings.crease));
  groupByBrightness(charts, result.mesh, settings.range);
  AtlasSettings layout;
  layout.texelsPerUnit = settings.texelsPerMetre * result.mesh.scene->metresPerUnit;
  layout.side = settings.atlasSize, layout.gutter = settings.gutter;
  const double finest = finestTexel(result.mesh, charts);
  result.atlas = layOut(std::move(charts), layout, finest);
  return result;
}

MeasuredLight bakedLight(const SolutionView& solution, const SolutionMesh& mesh) {
  return measuredLight(solution, mesh, kShareOfError * solution.settings().error);
}

GlbJson assetOf(const Scene& scene) {
  GlbJson asset{{"version", "2.0"}, {"generator", "deltalux " DELTALUX_VERSION}};
  GlbJson& extras = asset["extras"]["deltalux"];
  if (scene.origin != Vec3(0)) extras["origin"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  extras["metresPerUnit"] = scene.metresPerUnit;
  extras["up"] = {scene.up.x, scene.up.y, scene.up.z};
  extras["luminousEfficacy"] = scene.luminousEfficacy;
  extras["luminanceWeights"] = {kLuminanceWeights.r, kLuminanceWeights.g, kLuminanceWeights.b};
  return asset;
}

AddView addViewBy(const GlbSettings& settings) {
  return settings.meshopt ? &GlbContainer::addPackedView : &GlbContainer::addView;
}

void writeAll(const std::vector<FileBytes>& all) {
  std::vector<std::unique_ptr<io::AtomicFile>> files;
  for (const FileBytes& f : all) {
    files.push_back(std::make_unique<io::AtomicFile>(f.path));
    files.back()->write(f.bytes);
  }
  for (const auto& file : files) file->commit();
}

GlbReport reportOf(const ChartedMesh& charted, const GeometryCounts& counts, const std::vector<FileBytes>& files) {
  GlbReport report;
  for (const FileBytes& f : files) report.files.push_back(f.path);
  report.bytes = files.front().bytes.size();
  report.triangles = counts.triangles, report.vertices = counts.vertices;
  report.charts = charted.atlas.charts.size(), report.pages = charted.atlas.pages.size();
  report.texelsPerMetre = charted.atlas.texelsPerUnit / charted.mesh.scene->metresPerUnit;
  return report;
}

}  // namespace deltalux::exporting
