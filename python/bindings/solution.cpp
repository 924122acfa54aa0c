// deltalux.Solution: what is read from it, and edits.
#include "solution.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <deltalux/check.hpp>
#include <deltalux/design.hpp>
#include <deltalux/error.hpp>
#include <deltalux/image.hpp>
#include <deltalux/report.hpp>
#include <deltalux/solution_file.hpp>
#include <functional>
#include <stdexcept>

#include "arrays.hpp"
#include "bind.hpp"
#include "long_call.hpp"
#include "scene.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

constexpr int kMostSamples = 1 << 17;  // lines or shadow rays of a point, as `deltalux probe`
constexpr double kMeterError = 0.25;   // standard error of a meter beside the error of the solution, as there
constexpr int kLargestSide = 32768;    // of a picture [pixels], as `deltalux render`

SolveMethod methodOf(const std::string& name) {
  if (name == "lines") return SolveMethod::Lines;
  if (name == "paper") return SolveMethod::Paper;
  throw std::invalid_argument("method: 'lines' or 'paper', not '" + name + "'");
}

void requireLights(const Scene& scene, const std::vector<LightPattern>& groups) {
  std::vector<std::string> names;
  for (const Light& light : scene.lights) names.push_back(light.name);
  for (const LightPattern& p : groups)
    if (lightsMatching(scene, p.pattern).empty()) {
      std::string hint;
      for (const std::string& near : nearMisses(p.pattern, names)) hint += (hint.empty() ? "nearest: " : ", ") + near;
      throw InputError("", 0, "groups: no light is called '" + p.pattern + "', of the group '" + p.group + "'",
                       hint.empty() ? "the scene has no light" : hint);
    }
}

std::unique_ptr<SolutionHandle> solve(const SceneHandle& scene, const SolveSettings& settings, std::size_t threads,
                                      const py::object& progress) {
  requireLights(*scene.scene, settings.groups);
  std::unique_ptr<SolutionHandle> solution;
  runLong(progress, threads, [&](Progress& p) {
    Engine engine(*scene.scene, settings);
    engine.solve(&p);
    solution = std::make_unique<SolutionHandle>(std::move(engine), threads);
  });
  return solution;
}

std::unique_ptr<SolutionHandle> open(const std::string& path, std::size_t threads) {
  std::unique_ptr<SolutionHandle> solution;
  runLong(py::none(), threads,
          [&](Progress&) { solution = std::make_unique<SolutionHandle>(Engine(loadSolution(path)), threads); });
  return solution;
}

/// Steps, checks and what solving did as the JSON of the command line's reports, whose keys they have.
std::string json(const StepReport& step) {
  RunReport report;
  report.steps = {step};
  return toJson(report);
}
std::string json(const CheckReport& check) {
  RunReport report;
  report.check = check;
  return toJson(report);
}
std::string json(const SolveReport& solved) {
  RunReport report;
  report.times = solved.times, report.counts = solved.counts, report.memory = solved.memory;
  report.error = solved.error, report.energy = solved.energy;
  return toJson(report);
}

/// Reads without the interpreter's lock, on this thread: for what takes no time.
template <class Read>
auto glance(const SolutionHandle& solution, const Read& read) {
  const py::gil_scoped_release unlocked;
  return solution.read(read);
}

SceneHandle sceneOf(const SolutionHandle& solution) {
  return glance(solution, [](const SolutionView& view) {
    return SceneHandle{std::make_shared<const Scene>(view.scene()), ImportReport{}};
  });
}

ProbeSettings meterSettings(const SolutionView& view, std::uint64_t seed) {
  return {.error = kMeterError * view.settings().error, .maxSamples = kMostSamples, .seed = seed};
}

Vec3 originOf(const SolutionHandle& solution) {
  return glance(solution, [](const SolutionView& view) { return view.scene().origin; });
}

/// Irradiance [W/m2] and its standard errors, (N,3) each, and lux, (N,).
py::tuple measure(const SolutionHandle& solution, const Numbers& points, const Numbers& normals, std::uint64_t seed,
                  const py::object& progress) {
  const std::vector<ProbePoint> meters = probePoints(originOf(solution), points, normals);
  std::vector<double> E, errors, lux;
  runLong(progress, solution.threads(), [&](Progress& p) {
    solution.read([&](const SolutionView& view) {
      for (const ProbeResult& r : probe(view, meters, meterSettings(view, seed), &p)) {
        for (int c = 0; c < 3; ++c) E.push_back(r.irradiance[c]), errors.push_back(r.standardError[c]);
        lux.push_back(photometric(r.irradiance, view.scene().luminousEfficacy));
      }
    });
  });
  const auto count = static_cast<py::ssize_t>(meters.size());
  return py::make_tuple(arrayOf<double>(std::move(E), {count, 3}), arrayOf<double>(std::move(errors), {count, 3}),
                        arrayOf<double>(std::move(lux), {count}));
}

/// What each group brings at scale 1 [lux], (N,G).
py::array_t<double> measureByLight(const SolutionHandle& solution, const Numbers& points, const Numbers& normals,
                                   std::uint64_t seed, const py::object& progress) {
  const std::vector<ProbePoint> meters = probePoints(originOf(solution), points, normals);
  std::vector<double> lux;
  std::size_t groups = 0;
  runLong(progress, solution.threads(), [&](Progress& p) {
    solution.read([&](const SolutionView& view) {
      const std::vector<std::vector<ProbeResult>> results = probeByLight(view, meters, meterSettings(view, seed), &p);
      groups = results.size();
      lux.resize(groups * meters.size());
      for (std::size_t g = 0; g < groups; ++g)
        for (std::size_t i = 0; i < meters.size(); ++i)
          lux[i * groups + g] = photometric(results[g][i].irradiance, view.scene().luminousEfficacy);
    });
  });
  return arrayOf<double>(std::move(lux), {static_cast<py::ssize_t>(meters.size()), static_cast<py::ssize_t>(groups)});
}

/// Names of groups, and those of their lights.
std::vector<std::pair<std::string, std::vector<std::string>>> groupsOf(const SolutionHandle& solution) {
  return glance(solution, [](const SolutionView& view) {
    std::vector<std::pair<std::string, std::vector<std::string>>> result;
    for (const LightGroup& group : lightGroups(view)) {
      result.emplace_back(group.name, std::vector<std::string>());
      for (const LightId light : group.lights) result.back().second.push_back(view.scene()[light].name);
    }
    return result;
  });
}

/// Radiance, (h,w,3), the largest picture of the view's shape in `size`.
py::array_t<float> picture(const SolutionHandle& solution, const py::object& view, std::pair<int, int> size,
                           int samples, std::uint64_t seed, const py::object& progress) {
  if (std::min(size.first, size.second) < 1 || std::max(size.first, size.second) > kLargestSide)
    throw std::invalid_argument("size: (width, height) in pixels, each 1 to " + std::to_string(kLargestSide));
  if (samples < 1) throw std::invalid_argument("samples: camera rays per pixel, at least 1");
  const ViewChoice choice = viewChoice(view);
  Image image;
  runLong(progress, solution.threads(), [&](Progress& p) {
    image = solution.read([&](const SolutionView& v) {
      const View seen = viewOf(v.scene(), choice);
      const glm::ivec2 fitted = fitResolution(seen, size.first, size.second);
      return render(v, seen, {.width = fitted.x, .height = fitted.y, .samplesPerPixel = samples, .seed = seed}, &p);
    });
  });
  return arrayOf<float>(std::move(image.pixels), {image.height, image.width, 3});
}

std::string check(const SolutionHandle& solution, const py::object& progress) {
  CheckReport report;
  runLong(progress, solution.threads(), [&](Progress& p) {
    solution.read([&](const SolutionView& view) {
      Engine fresh(view.scene(), view.settings());
      const SolveReport solved = fresh.solve(&p);
      report = compareSolutions(view, fresh.solution(), {}, &p);
      report.solveS = solved.times.total;
    });
  });
  return json(report);
}

/// A (N,G) and targets (N,): weights and what is reached.
py::tuple design(const Numbers& brings, const Numbers& targets) {
  if (brings.ndim() != 2 || targets.ndim() != 1 || brings.shape(0) != targets.shape(0) || brings.size() == 0)
    throw std::invalid_argument("A has a row for each target, and a column for each group: shapes (N, G) and (N,)");
  const auto a = brings.unchecked<2>();
  std::vector<std::vector<double>> columns(static_cast<std::size_t>(a.shape(1)));
  for (py::ssize_t g = 0; g < a.shape(1); ++g)
    for (py::ssize_t i = 0; i < a.shape(0); ++i) {
      if (!std::isfinite(a(i, g)) || a(i, g) < 0)
        throw std::invalid_argument("A: what a group brings is finite, and not negative");
      columns[static_cast<std::size_t>(g)].push_back(a(i, g));
    }
  std::vector<double> wanted;
  for (py::ssize_t i = 0; i < targets.shape(0); ++i) {
    if (!std::isfinite(targets.at(i))) throw std::invalid_argument("targets: all are finite");
    wanted.push_back(targets.at(i));
  }
  Dimmed dimmed = bestDimming(columns, wanted);
  return py::make_tuple(arrayOf<double>(std::move(dimmed.weights), {a.shape(1)}),
                        arrayOf<double>(std::move(dimmed.reached), {a.shape(0)}));
}

std::string change(SolutionHandle& solution, const py::object& progress,
                   const std::function<StepReport(Progress&)>& work) {
  StepReport report;
  runLong(progress, solution.threads(), [&](Progress& p) { report = work(p); });
  return json(report);
}

}  // namespace

void bindSolution(py::module_& m) {
  py::class_<SolutionHandle>(m, "Solution")
      .def_property_readonly("version", &SolutionHandle::version)
      .def_property_readonly("unfinished", &SolutionHandle::unfinished)
      .def_property_readonly("scene", &sceneOf)
      .def_property_readonly(
          "error",
          [](const SolutionHandle& s) { return glance(s, [](const auto& view) { return view.settings().error; }); })
      .def_property_readonly(
          "by_light",
          [](const SolutionHandle& s) { return glance(s, [](const auto& view) { return view.settings().byLight; }); })
      .def_property_readonly(
          "converged",
          [](const SolutionHandle& s) { return glance(s, [](const auto& view) { return view.report().converged; }); })
      .def_property_readonly("groups", &groupsOf)
      .def("report",
           [](const SolutionHandle& s) { return glance(s, [](const auto& view) { return json(view.report()); }); })
      .def("measure", &measure, py::arg("points"), py::arg("normals"), py::arg("seed"), py::arg("progress"))
      .def("measure_by_light", &measureByLight, py::arg("points"), py::arg("normals"), py::arg("seed"),
           py::arg("progress"))
      .def("render", &picture, py::arg("view"), py::arg("size"), py::arg("samples"), py::arg("seed"),
           py::arg("progress"))
      .def("check", &check, py::arg("progress"))
      .def(
          "save",
          [](const SolutionHandle& s, const std::string& path) {
            glance(s, [&](const SolutionView& view) { saveSolution(path, view); });
          },
          py::arg("path"))
      .def("mesh",
           [](SolutionHandle& s) {
             const py::gil_scoped_release unlocked;
             return std::make_shared<SolutionMesh>(s.mesh());
           })
      .def("edit",
           [](const SolutionHandle& s) {
             const py::gil_scoped_release unlocked;
             return s.edit();
           })
      .def(
          "update",
          [](SolutionHandle& s, EditList& edits, const py::object& progress) {
            return change(s, progress, [&](Progress& p) { return s.update(edits, p); });
          },
          py::arg("edits"), py::arg("progress"))
      .def(
          "frame",
          [](SolutionHandle& s, EditList& edits, double milliseconds) {
            return change(s, py::none(), [&](Progress& p) { return s.frame(edits, milliseconds, p); });
          },
          py::arg("edits"), py::arg("milliseconds"))
      .def(
          "take_back",
          [](SolutionHandle& s, EditList& edits) {
            runLong(py::none(), s.threads(), [&](Progress& p) { s.takeBack(edits, p); });
          },
          py::arg("edits"))
      .def(
          "finish",
          [](SolutionHandle& s, const py::object& progress) {
            runLong(progress, s.threads(), [&](Progress& p) { s.finish(p); });
          },
          py::arg("progress"));
  m.def(
      "solve",
      [](const SceneHandle& scene, double error, const py::object& progress, bool byLight,
         const std::vector<std::pair<std::string, std::string>>& groups, const std::string& method, std::size_t threads,
         std::uint64_t seed, double seconds, std::uint64_t particles, bool diffuseOnly, bool causticTextures) {
        SolveSettings settings{.error = error,
                               .particles = particles,
                               .seconds = seconds,
                               .diffuseOnly = diffuseOnly,
                               .causticTextures = causticTextures,
                               .seed = seed,
                               .method = methodOf(method),
                               .byLight = byLight};
        for (const auto& [group, pattern] : groups) settings.groups.push_back({group, pattern});
        return solve(scene, settings, threads, progress);
      },
      py::arg("scene"), py::arg("error"), py::arg("progress"), py::arg("by_light"), py::arg("groups"),
      py::arg("method"), py::arg("threads"), py::arg("seed"), py::arg("seconds"), py::arg("particles"),
      py::arg("diffuse_only"), py::arg("caustic_textures"));
  m.def("open", &open, py::arg("path"), py::arg("threads"));
  m.def("design", &design, py::arg("A"), py::arg("targets"));
}

}  // namespace deltalux::python
