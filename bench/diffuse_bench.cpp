// diffuse_bench reference NAME SCENE VALUES.csv ERROR [diffuse-only]
// diffuse_bench copies NAME SCENE K ERROR
// diffuse_bench furnace RHO ERROR
//
// One solve of diffuse light a run, so that peak memory is that solve's, as CSV rows: scene, error, measure, value,
// unit.
//   reference   the solution probed where independent values are known. A difference is |E - E_ref| / E_ref of gray
//               (luminance-weighted) irradiance at one point; all points of the file count.
//   copies      k copies of the scene side by side, diffuse light only.
//   furnace     a closed box whose walls all emit and reflect alike: E = M / (1 - rho), probed at many points on its
//               walls and inside, with shadow rays until their own error is small against 0.5 %.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/points.hpp>
#include <deltalux/render.hpp>
#include <stdexcept>

#include "processor_time.hpp"
#include "scene_copies.hpp"

namespace deltalux::bench {
namespace {

class Table {
 public:
  Table(std::string scene, double error) : scene_(std::move(scene)), error_(error) {}
  void row(const std::string& measure, double value, const char* unit) const {
    fmt::print("{},{},{},{:.6g},{}\n", scene_, error_, measure, value, unit);
    std::fflush(stdout);
  }

 private:
  std::string scene_;
  double error_;
};

Engine solved(Scene scene, const SolveSettings& settings, const Table& table) {
  const double before = processorSeconds();
  Engine engine(std::move(scene), settings);
  const SolveReport report = engine.solve();
  table.row("solve", report.times.total, "s");
  table.row("solve processor time", processorSeconds() - before, "s");
  table.row("peak memory", static_cast<double>(peakResidentBytes()) / 1048576.0, "MiB");
  table.row("memory of elements", static_cast<double>(report.memory.elements) / 1048576.0, "MiB");
  table.row("elements", static_cast<double>(report.counts.elements), "");
  table.row("leaf elements", static_cast<double>(report.counts.leafElements), "");
  table.row("lines", static_cast<double>(report.counts.lines), "");
  table.row("visibility rays", static_cast<double>(report.counts.raysVisibility), "");
  return engine;
}

double quantile(std::vector<double> values, double q) {
  const auto at = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// Columns of numbers of a points file, row by row.
std::vector<glm::dvec3> tripleColumns(const PointTable& table, const std::array<const char*, 3>& names) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), names[c]);
    if (found == table.columns.end()) throw std::runtime_error(std::string("the values have no column ") + names[c]);
    columns[c] = static_cast<std::size_t>(found - table.columns.begin());
  }
  std::vector<glm::dvec3> values;
  for (const auto& row : table.rows)
    values.emplace_back(std::stod(row[columns[0]]), std::stod(row[columns[1]]), std::stod(row[columns[2]]));
  return values;
}

void reference(const std::string& name, const std::string& scene, const std::string& values, double error,
               bool diffuseOnly) {
  const Table table(name, error);
  SolveSettings settings;
  settings.error = error, settings.diffuseOnly = diffuseOnly;
  const PointTable points = readPoints(values);
  const auto expected = tripleColumns(points, {"E_r", "E_g", "E_b"}),
             noise = tripleColumns(points, {"se_r", "se_g", "se_b"});
  const Engine engine = solved(loadScene({scene}).scene, settings, table);
  for (const bool mesh : {false, true}) {
    const double before = processorSeconds();
    ProbeSettings probing;
    probing.mesh = mesh;
    const auto results = probe(engine.solution(), points.points, probing);
    std::vector<double> differences, signedOnes, own;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const double exact = gray(expected[i]);
      if (!(exact > 0)) continue;
      signedOnes.push_back(gray(results[i].irradiance) / exact - 1);
      differences.push_back(std::abs(signedOnes.back()));
      own.push_back(gray(noise[i]) / exact);
    }
    const std::string of = mesh ? "mesh " : "";
    table.row(of + "median difference", 100 * quantile(differences, 0.5), "%");
    table.row(of + "95th percentile of difference", 100 * quantile(differences, 0.95), "%");
    table.row(of + "largest difference", 100 * quantile(differences, 1), "%");
    table.row(of + "median signed difference", 100 * quantile(signedOnes, 0.5), "%");
    table.row(of + "probes", static_cast<double>(differences.size()), "");
    table.row(of + "probing processor time", processorSeconds() - before, "s");
    if (!mesh) table.row("95th percentile of the values' standard error", 100 * quantile(own, 0.95), "%");
  }
}

void copies(const std::string& name, const std::string& scene, int k, double error) {
  const Table table(fmt::format("{} x {}", name, k), error);
  SolveSettings settings;
  settings.error = error, settings.diffuseOnly = true;
  solved(sideBySide(loadScene({scene}).scene, k), settings, table);
}

Scene furnaceBox(float rho, const Vec3& size) {
  Scene scene;
  scene.materials.push_back({"wall", Opaque{Rgb(rho), {}, {}}, Emission{Rgb(1.0f), false, {}}});
  const auto corner = [&](int i) { return Vec3(i & 1, i >> 1 & 1, i >> 2 & 1) * size; };
  constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const auto& f : faces)
    scene.primitives.push_back(
        {*makePolygon({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])}), MaterialId(0), ObjectId()});
  return scene;
}

/// Midpoints of a grid on every face, and the same drawn towards the middle: points in the air.
std::vector<ProbePoint> furnacePoints(const Scene& scene, const Vec3& size) {
  constexpr int grid = 8;
  std::vector<ProbePoint> points;
  for (const Primitive& face : scene.primitives)
    for (int i = 0; i < grid * grid; ++i) {
      const SurfacePoint at = pointAt(face.shape, {(i % grid + 0.5) / grid, (i / grid + 0.5) / grid});
      points.push_back({at.position, at.normal});
      if (i % 7 == 0) points.push_back({glm::mix(at.position, 0.5 * size, 0.4), at.normal});
    }
  return points;
}

void furnace(double rho, double error) {
  const Vec3 size(1, 1.5, 0.8);
  const Table table(fmt::format("furnace {}", rho), error);
  SolveSettings settings;
  settings.error = error;
  const Scene scene = furnaceBox(static_cast<float>(rho), size);
  const Engine engine = solved(scene, settings, table);
  const auto points = furnacePoints(scene, size);
  const double exact = kPi / (1 - static_cast<double>(static_cast<float>(rho)));
  for (const bool mesh : {false, true}) {
    ProbeSettings probing;
    probing.mesh = mesh, probing.error = 0.0003, probing.maxSamples = 1 << 18;
    double worst = 0, noise = 0, sum = 0;
    for (const ProbeResult& r : probe(engine.solution(), points, probing)) {
      worst = std::max(worst, std::abs(r.irradiance.g / exact - 1));
      noise = std::max(noise, r.standardError.g / exact);
      sum += r.irradiance.g / exact - 1;
    }
    const std::string of = mesh ? "mesh " : "";
    table.row(of + "largest deviation", 100 * worst, "%");
    table.row(of + "mean deviation", 100 * sum / static_cast<double>(points.size()), "%");
    if (!mesh) table.row("largest standard error of a probe", 100 * noise, "%");
  }
}

double number(const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0') throw std::runtime_error(std::string("not a number: ") + text);
  return value;
}

bool run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "reference" && (argc == 6 || (argc == 7 && std::string(argv[6]) == "diffuse-only")))
    return reference(argv[2], argv[3], argv[4], number(argv[5]), argc == 7), true;
  if (what == "copies" && argc == 6)
    return copies(argv[2], argv[3], static_cast<int>(number(argv[4])), number(argv[5])), true;
  if (what == "furnace" && argc == 4) return furnace(number(argv[2]), number(argv[3])), true;
  return false;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  try {
    if (deltalux::bench::run(argc, argv)) return 0;
    std::fputs(
        "usage: diffuse_bench reference NAME SCENE VALUES.csv ERROR [diffuse-only]\n"
        "       diffuse_bench copies NAME SCENE K ERROR\n"
        "       diffuse_bench furnace RHO ERROR\n",
        stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "diffuse_bench: %s\n", error.what());
    return 1;
  }
}
