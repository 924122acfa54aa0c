// update_bench replay NAME SCENE EDITS.json OPTIONS...
// update_bench far NAME SCENE OPTIONS...
// update_bench table1 NAME SCENE EDITS.json OPTIONS...
//
// Updates against solving, in one run, as CSV rows: one an edit (columns: kColumns). Times are wall seconds, and
// processor seconds of all threads.
//   replay  solves, then edits one by one; an object is selected before it moves, which is timed by itself. The last
//   step, or every one with `each`, is held against a fresh solve of the
//           edited scene, whose time is then the one that updates are related to; with `unchecked` none is.
//   far     the scene with a small box ten of its diagonals away, which moves by its own size.
//   table1  the columns of Table 1 of [GD01] and what its Figures 7 and 9 tell of each position: as published where the
//           scene is of the same kind, by the paper's method here, and by ours (kTableColumns).
// Options: diffuse-only, error=E, metres=M (of a scene unit), each, unchecked.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deltalux/check.hpp>
#include <deltalux/edit_io.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/memory.hpp>
#include <stdexcept>
#include <string_view>

#include "stopwatch.hpp"

namespace deltalux::bench {
namespace {

constexpr const char* kColumns =
    "scene,edits,light,error,step,op,object,solve_s,update_s,solve_over_update,solve_cpu_s,update_cpu_s,"
    "leaves_changed,leaves_total,particles_retraced,particles_total,textures_rebuilt,mesh_s,light_s,particles_s,"
    "textures_s,peak_mib,median_percent,p95_percent,max_percent,particles_identical,select_s";

constexpr const char* kTableColumns = "scene,measure,published,paper_method,ours,unit";

enum class Checked { Last, Each, None };

struct Options {
  SolveSettings settings;
  ImportSettings import;
  Checked checked = Checked::Last;

  static Options parse(const std::vector<std::string>& words) {
    Options o;
    for (const std::string& word : words) {
      if (word == "diffuse-only")
        o.settings.diffuseOnly = true;
      else if (word == "each")
        o.checked = Checked::Each;
      else if (word == "unchecked")
        o.checked = Checked::None;
      else if (word.starts_with("error="))
        o.settings.error = std::stod(word.substr(6));
      else if (word.starts_with("metres="))
        o.import.metresPerUnit = std::stod(word.substr(7));
      else
        throw std::runtime_error("no option '" + word + "'");
    }
    return o;
  }
};

struct Seconds {
  double wall = 0, processor = 0;
};

Seconds read(const Stopwatch& watch) { return {watch.wall(), watch.processor()}; }

struct Solved {
  Engine engine;
  Seconds took;
};

Solved solve(Scene scene, const SolveSettings& settings) {
  const Stopwatch watch;
  Engine engine(std::move(scene), settings);
  engine.solve();
  return {std::move(engine), read(watch)};
}

std::string quoted(std::string text) {
  return text.find_first_of(",\"\n") == std::string::npos ? text : '"' + text + '"';
}

/// Scene, edits and settings of a run, at the head of each of its rows.
struct Heading {
  std::string scene, edits;
  SolveSettings settings;
};

void printRow(const Heading& h, std::size_t index, const StepReport& step, const SolveReport& now, Seconds solved,
              Seconds update, double selecting, const std::optional<CheckReport>& check) {
  fmt::print("{},{},{},{},{},{},{},", quoted(h.scene), quoted(h.edits), h.settings.diffuseOnly ? "diffuse" : "all",
             h.settings.error, index, step.op, quoted(step.object));
  fmt::print("{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},", solved.wall, update.wall, solved.wall / update.wall,
             solved.processor, update.processor);
  fmt::print("{},{},", step.leavesChanged, now.counts.leafElements);
  fmt::print("{},{},{},", step.particlesRetraced, step.particlesTotal, step.texturesRebuilt);
  fmt::print("{:.4g},{:.4g},{:.4g},{:.4g},{:.0f},", step.times.visibility + step.times.refine, step.times.gather,
             step.times.particles, step.times.textures, static_cast<double>(peakResidentBytes()) / 1048576.0);
  if (check)
    fmt::print("{:.3g},{:.3g},{:.3g},{},", 100 * check->medianRelDiff, 100 * check->p95RelDiff, 100 * check->maxRelDiff,
               check->particlesIdentical ? "yes" : "no");
  else
    fmt::print(",,,,");
  fmt::print("{:.4g}\n", selecting);
  std::fflush(stdout);
}

/// Selects what the edit moves, as one who drags it does, unless it is what was selected last. The seconds that takes.
double selectFor(const Edit& edit, Engine& engine, std::string& selected) {
  const auto* moved = std::get_if<TransformObject>(&edit);
  if (!moved || moved->object == selected) return 0;
  const Stopwatch watch;
  engine.select(selected = moved->object);
  return watch.wall();
}

void play(const Heading& heading, Solved solved, const std::vector<Edit>& edits, Checked checked) {
  std::string selected;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const double selecting = selectFor(edits[i], solved.engine, selected);
    const Stopwatch watch;
    solved.engine.apply(edits[i]);
    const StepReport step = solved.engine.update();
    const Seconds update = read(watch);
    std::optional<CheckReport> check;
    Seconds against = solved.took;
    if (checked == Checked::Each || (checked == Checked::Last && i + 1 == edits.size())) {
      const Solved fresh = solve(solved.engine.solution().scene(), heading.settings);
      check = compareSolutions(solved.engine.solution(), fresh.engine.solution());
      against = fresh.took;
    }
    printRow(heading, i + 1, step, solved.engine.solution().report(), against, update, selecting, check);
  }
}

std::vector<Edit> editsOf(const std::string& file, const ImportSettings& import) {
  std::vector<Edit> edits;
  for (const EditStep& step : loadEdits(file, import)) {
    const auto* edit = std::get_if<Edit>(&step);
    if (!edit) throw std::runtime_error(file + ": undo and redo are not measured");
    edits.push_back(*edit);
  }
  return edits;
}

std::string stemOf(const std::string& file) { return std::filesystem::path(file).stem().string(); }

void replay(const std::string& name, const std::string& scene, const std::string& file, const Options& o) {
  const std::vector<Edit> edits = editsOf(file, o.import);
  play({name, stemOf(file), o.settings}, solve(loadScene({scene}, o.import).scene, o.settings), edits, o.checked);
}

/// Adds a box of the size of a hundredth of the scene, ten diagonals of it away; returns its name and the size.
std::pair<std::string, double> addFarBox(Scene& scene) {
  const Box box = bounds(scene);
  const double size = 0.01 * box.diagonal();
  const Vec3 lower = box.center() + 10 * box.diagonal() * glm::normalize(Vec3(1, 0.3, 0.2));
  Material material{"far_box_paint", Opaque{Rgb(0.5f), {}, {}}, {}};
  scene.materials.push_back(std::move(material));
  const MaterialId paint(scene.materials.size() - 1);
  const ObjectId object = internObject(scene, "far_box", '.');
  const auto corner = [&](int i) { return lower + size * Vec3(i & 1, i >> 1 & 1, i >> 2 & 1); };
  constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces)
    scene.primitives.push_back({*makePolygon({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])}), paint, object});
  return {"far_box", size};
}

void far(const std::string& name, const std::string& file, const Options& o) {
  Scene scene = loadScene({file}, o.import).scene;
  const auto [object, size] = addFarBox(scene);
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(0, size, 0, 1);
  play({name, "far", o.settings}, solve(std::move(scene), o.settings), {TransformObject{object, matrix}}, o.checked);
}

/// What [GD01 7] says of its scenes; nothing of ours that it has no like of.
struct Published {
  std::string name;
  double polygons, solve, particles, octreeKb, update, leastRetraced, mostRetraced, leastPercent, mostPercent;
  double textures, textureSide, gain;
};
constexpr double kNotSaid = -1;
const std::vector<Published> kPublished = {
    {"cabin", 180000, 2144, 1600000, 370, 14.5, 0, 97000, 0, 6, 25, 85, 148},  // [GD01 7, Table 1]
    {"street", 47000, 4740, 800000, 2300, 96, 5700, 41000, 0.8, 17, kNotSaid, kNotSaid, 49},
};

/// A measure of [GD01 7], or of our own, of one run.
struct Measured {
  std::string name;
  double Published::*published;  // nullptr: not said
  double value;
  const char* unit;
};

std::vector<Measured> measure(const Scene& scene, const std::vector<Edit>& edits, const SolveSettings& settings) {
  std::vector<Measured> all;
  const auto add = [&](const std::string& measure, double Published::*published, double value, const char* unit) {
    all.push_back({measure, published, value, unit});
  };
  std::uint64_t polygons = 0;
  for (const Primitive& p : scene.primitives) polygons += tessellatedPolygonCount(p.shape);
  Solved solved = solve(scene, settings);
  const WorkCounts counts = solved.engine.solution().report().counts;
  add("polygons if tessellated", &Published::polygons, static_cast<double>(polygons), "");
  add("first solution", &Published::solve, solved.took.wall, "s");
  add("first solution: processor time", nullptr, solved.took.processor, "s");
  add("particles", &Published::particles, static_cast<double>(counts.particles), "");
  add("caustic textures", &Published::textures, static_cast<double>(counts.causticTextures), "");
  add("mean side of caustic textures", &Published::textureSide, counts.causticTextureMeanSize, "texels");
  std::string selected;
  add("selecting the object", nullptr, selectFor(edits.front(), solved.engine, selected), "s");
  const double octree = static_cast<double>(solved.engine.solution().report().memory.octree);
  add("memory of the octree (over lines: a bit a path)", &Published::octreeKb, 1e-3 * octree, "KB");
  double sum = 0, processor = 0, least = 1e30, most = 0, leastShare = 1e30, mostShare = 0;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const Stopwatch watch;
    solved.engine.apply(edits[i]);
    const StepReport step = solved.engine.update();
    const double seconds = watch.wall(), retraced = static_cast<double>(step.particlesRetraced);
    const double share = 100 * retraced / std::max(1.0, static_cast<double>(step.particlesTotal));
    add(fmt::format("position {}: update", i + 1), nullptr, seconds, "s");
    add(fmt::format("position {}: particles retraced", i + 1), nullptr, retraced, "");
    add(fmt::format("position {}: particles retraced of all", i + 1), nullptr, share, "%");
    processor += watch.processor();
    sum += seconds, least = std::min(least, retraced), most = std::max(most, retraced);
    leastShare = std::min(leastShare, share), mostShare = std::max(mostShare, share);
  }
  const double mean = sum / static_cast<double>(edits.size());
  const double meanProcessor = processor / static_cast<double>(edits.size());
  add("mean update", &Published::update, mean, "s");
  add("mean update: processor time", nullptr, meanProcessor, "s");
  add("particles retraced at least", &Published::leastRetraced, least, "");
  add("particles retraced at most", &Published::mostRetraced, most, "");
  add("particles retraced of all at least", &Published::leastPercent, leastShare, "%");
  add("particles retraced of all at most", &Published::mostPercent, mostShare, "%");
  add("first solution over mean update", &Published::gain, solved.took.wall / mean, "");
  add("first solution over mean update: processor time", nullptr, solved.took.processor / meanProcessor, "");
  return all;
}

void table1(const std::string& name, const std::string& file, const std::string& editsFile, const Options& o) {
  const std::vector<Edit> edits = editsOf(editsFile, o.import);
  const Scene scene = loadScene({file}, o.import).scene;
  SolveSettings settings = o.settings;
  settings.method = SolveMethod::Paper;
  const std::vector<Measured> theirs = measure(scene, edits, settings), ours = measure(scene, edits, o.settings);
  const auto published = std::ranges::find(kPublished, name, &Published::name);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const Measured& m = ours[i];
    const bool said = m.published && published != kPublished.end() && (*published).*m.published != kNotSaid;
    fmt::print("{},{},{},{:.6g},{:.6g},{}\n", name, m.name,
               said ? fmt::format("{:.6g}", (*published).*m.published) : "", theirs[i].value, m.value, m.unit);
  }
}

bool run(const std::vector<std::string>& words) {
  const auto command = words.empty() ? std::string() : words[0];
  const auto rest = [&](std::size_t from) {
    return Options::parse({words.begin() + std::ptrdiff_t(from), words.end()});
  };
  if (command == "columns" && words.size() == 1)
    fmt::print("{}\n", kColumns);
  else if (command == "replay" && words.size() >= 4)
    replay(words[1], words[2], words[3], rest(4));
  else if (command == "table1-columns" && words.size() == 1)
    fmt::print("{}\n", kTableColumns);
  else if (command == "table1" && words.size() >= 4)
    table1(words[1], words[2], words[3], rest(4));
  else if (command == "far" && words.size() >= 3)
    far(words[1], words[2], rest(3));
  else
    return false;
  return true;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  deltalux::keepFreedMemory();
  try {
    if (deltalux::bench::run({argv + 1, argv + argc})) return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "update_bench: {}\n", error.what());
    return 1;
  }
  std::fputs(
      "usage: update_bench columns | table1-columns\n"
      "       update_bench replay NAME SCENE EDITS.json OPTIONS...\n"
      "       update_bench far NAME SCENE OPTIONS...\n"
      "       update_bench table1 NAME SCENE EDITS.json OPTIONS...\n"
      "options: diffuse-only, error=E, metres=M, each, unchecked\n",
      stderr);
  return 2;
}
