// A page of a solution: read once for each group of lights, packed, put into the template.
#include <deltalux/export.hpp>
#include <deltalux/light_groups.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_reader.hpp>

#include "export/advance.hpp"
#include "export/overlap.hpp"
#include "export/page_data.hpp"
#include "export/page_html.hpp"
#include "export/page_points.hpp"
#include "export/page_refine.hpp"
#include "export/page_template.hpp"
#include "export/simplify.hpp"
#include "io/atomic_file.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

using namespace exporting;

constexpr double kOverlap = 1e-4;                         // of sides over their outlines [m] [shown]
constexpr int kExposureWidth = 96, kExposureHeight = 72;  // of the picture that the exposure is chosen from [shown]

std::vector<View> viewsOf(const Scene& scene, const PageSettings& settings) {
  std::vector<View> views = settings.views;
  views.insert(views.end(), scene.views.begin(), scene.views.end());
  std::erase_if(views, [](const View& v) { return v.kind != View::Kind::Perspective; });
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].name.empty()) views[i].name = "view " + std::to_string(i + 1);
  return views;
}

double exposureOf(const SolutionView& solution, const std::vector<View>& views) {
  if (views.empty()) return 0;
  RenderSettings settings;
  settings.width = kExposureWidth, settings.height = kExposureHeight, settings.samplesPerPixel = 1;
  settings.meshDirect = true;
  return automaticEv(render(solution, views.front(), settings));
}

/// Reads the mesh, and the points, of every group.
std::vector<SolutionMesh> readGroups(const SolutionView& solution, const std::vector<LightGroup>& groups,
                                     const PageSettings& settings, PageData& page, Progress* progress) {
  ProbeSettings meters;
  meters.error = settings.meterError, meters.maxSamples = settings.meterSamples, meters.seed = settings.seed;
  const std::vector<ProbePoint> points = pointsOf(page.grids);
  std::vector<Rgb> whole;
  if (!points.empty())
    for (const ProbeResult& r : probe(solution, points, meters)) whole.emplace_back(r.irradiance);
  std::vector<SolutionMesh> meshes;
  GroupLight light(solution);
  std::optional<SolutionReader> reader;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    advance(progress, "export", static_cast<double>(g) / static_cast<double>(groups.size() + 1));
    light.show(g);
    if (reader)
      reader->refresh();
    else
      reader.emplace(light.view());
    meshes.push_back(reader->mesh());
    if (!points.empty()) page.pointLight.push_back(groupAtPoints(*reader, points, whole, meters));
  }
  return meshes;
}

}  // namespace

void exportPage(const SolutionView& solution, const std::filesystem::path& path, const PageSettings& settings,
                Progress* progress) {
  const Scene& scene = solution.scene();
  const std::vector<LightGroup> groups = lightGroups(solution);
  PageData page;
  page.title = settings.title, page.efficacy = scene.luminousEfficacy, page.grids = settings.grids;
  page.byLight = !solution.get().columns.empty();
  page.groups = pageGroups(scene, groups, !page.byLight);
  page.views = viewsOf(scene, settings);
  page.ev = settings.ev ? *settings.ev : exposureOf(solution, page.views);
  const std::vector<SolutionMesh> meshes = readGroups(solution, groups, settings, page, progress);
  page.mesh = pageMesh(groups, meshes);
  std::vector<std::vector<Rgb>> direct;
  for (std::size_t g = 0; g < meshes.size(); ++g) {
    page.layers.push_back(pageLayer(page.mesh, g, meshes[g]));
    direct.push_back(pageDirect(page.mesh, g, meshes[g]));
    page.caustics.push_back(pageCaustics(page.mesh, meshes[g]));
  }
  const std::vector<char> whole = sidesUnderTextures(page.mesh, meshes);
  const double error = kShareOfError * solution.settings().error;
  Refinement refinement = Refinement::of(scene, error);
  refinement.floors = floorsOf(page.mesh, page.layers);
  refineDirect(page.mesh, page.layers, direct, scene, DirectLight(solution), refinement, whole);
  simplify(page.mesh, page.layers, {error, refinement.floors}, whole);
  widenSides(page.mesh, kOverlap / scene.metresPerUnit);
  page.skies = pageSkies(scene, groups, !page.byLight), page.suns = pageSuns(scene, groups, !page.byLight);
  advance(progress, "export", static_cast<double>(groups.size()) / static_cast<double>(groups.size() + 1));
  io::writeFile(path, pageHtml(pageTemplate(), pageBytes(page, scene)));
  if (progress) progress->report("export", 1);
}

}  // namespace deltalux
