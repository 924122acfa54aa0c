// Glare from eyes: what Solution.glare() and Solution.ugr() ask for.
#include <pybind11/stl.h>

#include <deltalux/glare.hpp>
#include <stdexcept>

#include "arrays.hpp"
#include "bind.hpp"
#include "long_call.hpp"
#include "solution.hpp"

namespace deltalux::python {

namespace py = pybind11;

namespace {

constexpr int kLargestPicture = 4096;  // side [pixels], as `deltalux glare`

Eye eyeOf(const Scene& scene, const Vec3& position, const Vec3& direction, const std::optional<Vec3>& up) {
  if (!(glm::length(direction) > 0)) throw std::invalid_argument("direction: the eye looks somewhere");
  return {position - scene.origin, direction, up ? *up : scene.up};
}

/// JSON as of `deltalux glare --json`, and the fisheye picture of radiance, (size,size,3).
py::tuple glare(const SolutionHandle& solution, const Numbers& position, const Numbers& direction,
                const std::optional<Numbers>& up, double threshold, const std::optional<Numbers>& task, int size,
                int samples, std::uint64_t seed, const py::object& progress) {
  if (size < 1 || size > kLargestPicture)
    throw std::invalid_argument("size: 1 to " + std::to_string(kLargestPicture) + " pixels");
  if (samples < 1) throw std::invalid_argument("samples: rays of a pixel, at least 1");
  if (!(threshold > 0)) throw std::invalid_argument("threshold: above 0 cd/m2");
  const Vec3 from = vector(position, "position"), towards = vector(direction, "direction");
  const std::optional<Vec3> upright = up ? std::optional(vector(*up, "up")) : std::nullopt;
  const std::optional<Vec3> place = task ? std::optional(vector(*task, "task")) : std::nullopt;
  GlareSettings settings;
  settings.size = size, settings.samplesPerPixel = samples, settings.seed = seed;
  settings.sources.threshold = threshold;
  std::string json;
  DaylightGlare daylight;
  runLong(progress, solution.threads(), [&](Progress& p) {
    solution.read([&](const SolutionView& view) {
      const Eye eye = eyeOf(view.scene(), from, towards, upright);
      if (place) settings.task = *place - view.scene().origin;
      const std::vector<UnifiedGlare> unified = unifiedGlare(view, std::span(&eye, 1), settings, &p);
      daylight = daylightGlare(view, eye, settings, &p);
      json = toJson(view.scene(), &daylight, unified);
    });
  });
  return py::make_tuple(json, arrayOf<float>(std::move(daylight.picture.pixels), {size, size, 3}));
}

/// UGR of eyes (N,) and Lb (N,); infinities as they are.
py::tuple ugr(const SolutionHandle& solution, const Numbers& positions, const Numbers& directions, std::uint64_t seed,
              const py::object& progress) {
  const std::vector<Vec3> from = vectors(positions, "positions"), towards = vectors(directions, "directions");
  if (from.size() != towards.size()) throw std::invalid_argument("a direction for each position");
  std::vector<double> ratings, backgrounds;
  runLong(progress, solution.threads(), [&](Progress& p) {
    solution.read([&](const SolutionView& view) {
      std::vector<Eye> eyes;
      for (std::size_t i = 0; i < from.size(); ++i) eyes.push_back(eyeOf(view.scene(), from[i], towards[i], {}));
      GlareSettings settings;
      settings.seed = seed;
      for (const UnifiedGlare& g : unifiedGlare(view, eyes, settings, &p))
        ratings.push_back(g.rating), backgrounds.push_back(g.background);
    });
  });
  const auto count = static_cast<py::ssize_t>(from.size());
  return py::make_tuple(arrayOf<double>(std::move(ratings), {count}), arrayOf<double>(std::move(backgrounds), {count}));
}

}  // namespace

void bindGlare(py::module_& m) {
  m.def("glare", &glare, py::arg("solution"), py::arg("position"), py::arg("direction"), py::arg("up"),
        py::arg("threshold"), py::arg("task"), py::arg("size"), py::arg("samples"), py::arg("seed"),
        py::arg("progress"));
  m.def("ugr", &ugr, py::arg("solution"), py::arg("positions"), py::arg("directions"), py::arg("seed"),
        py::arg("progress"));
}

}  // namespace deltalux::python
