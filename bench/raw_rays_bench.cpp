// raw_rays_bench solve NAME SCENE COPIES
// raw_rays_bench render NAME SOLUTION VIEW.vf
//
// What a solve over lines, or a picture of 640 x 480 pixels at 16 samples, takes beyond its rays: the same rays are
// recorded in a run of their own and traced once more, raw, in one batch of each kind. CSV rows: scene, what, value,
// unit. `COPIES` of the scene stand side by side; of more than four the rays are not kept.
#include <fmt/format.h>

#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_file.hpp>
#include <stdexcept>

#include "base/per_thread.hpp"
#include "engine/line_solve.hpp"
#include "run_main.hpp"
#include "scene_copies.hpp"
#include "solution/solution.hpp"
#include "stopwatch.hpp"

namespace deltalux::bench {
namespace {

constexpr int kMostRecorded = 4;  // copies of a scene whose rays are kept: those of more take too much memory

struct Rays {
  std::vector<tracing::Ray> closest, shadow;
  std::size_t size() const { return closest.size() + shadow.size(); }
};

/// Answers as another tracer does, and keeps every ray.
class Recorder final : public tracing::RayTracer {
 public:
  explicit Recorder(std::unique_ptr<tracing::RayTracer> inner) : inner_(std::move(inner)) {}

  tracing::Hit closestHit(const tracing::Ray& ray) const override {
    rays_.local().closest.push_back(ray);
    return inner_->closestHit(ray);
  }
  void closestHits(std::span<const tracing::Ray> rays, std::span<tracing::Hit> hits) const override {
    auto& all = rays_.local().closest;
    all.insert(all.end(), rays.begin(), rays.end());
    inner_->closestHits(rays, hits);
  }
  bool occluded(const tracing::Ray& ray) const override { return shadow(ray), inner_->occluded(ray); }
  Rgb transmittance(const tracing::Ray& ray) const override { return shadow(ray), inner_->transmittance(ray); }
  tracing::Passing passing(const tracing::Ray& ray) const override { return shadow(ray), inner_->passing(ray); }
  Rgb transmittance(const tracing::Ray& ray, tracing::GroupId group) const override {
    return shadow(ray), inner_->transmittance(ray, group);
  }
  tracing::GroupId separate(std::span<const PrimitiveId> primitives) override { return inner_->separate(primitives); }
  void rebuild(tracing::GroupId group) override { inner_->rebuild(group); }
  void rejoin() override { inner_->rejoin(); }

  Rays take() {
    Rays all;
    for (Rays& r : rays_) {
      all.closest.insert(all.closest.end(), r.closest.begin(), r.closest.end());
      all.shadow.insert(all.shadow.end(), r.shadow.begin(), r.shadow.end());
      r = {};
    }
    return all;
  }

 private:
  void shadow(const tracing::Ray& ray) const { rays_.local().shadow.push_back(ray); }

  std::unique_ptr<tracing::RayTracer> inner_;
  mutable PerThread<Rays> rays_;
};

/// Seconds that the rays take in one batch of each kind.
double rawSeconds(const Rays& rays, const tracing::RayTracer& tracer) {
  std::vector<tracing::Hit> hits(rays.closest.size());
  std::vector<tracing::Passing> passings(rays.shadow.size());
  const Stopwatch time;
  tracer.closestHits(rays.closest, hits);
  tracer.passings(rays.shadow, passings);
  return time.wall();
}

void row(const std::string& name, const char* what, double value, const char* unit) {
  fmt::print("{},{},{:.6g},{}\n", name, what, value, unit);
}

void compare(const std::string& name, double seconds, const Rays& rays, double raw) {
  row(name, "time", seconds, "s");
  row(name, "rays", static_cast<double>(rays.size()), "");
  row(name, "the same rays raw", raw, "s");
  row(name, "time over raw rays", seconds / raw, "");
}

void ofSolve(const std::string& name, Scene scene, bool raw) {
  SolveSettings settings;
  const Stopwatch time;
  Engine engine(std::move(scene), settings);
  const SolveReport report = engine.solve();
  const double seconds = time.wall();
  row(name, "leaves", static_cast<double>(report.counts.leafElements), "");
  row(name, "lines", static_cast<double>(report.counts.lines), "");
  row(name, "peak memory", static_cast<double>(peakResidentBytes()) / 1048576.0, "MiB");
  if (!raw) return row(name, "time", seconds, "s");

  Solution again;
  again.scene = engine.solution().scene(), again.settings = settings;
  const auto recorder = std::make_shared<Recorder>(tracing::makeEmbreeTracer(again.scene));
  again.tracer = recorder;
  const engine::TimeBudget all(0);
  engine::solveFinely(*engine::solveCoarsely(again, nullptr, all, nullptr), all, nullptr);
  const Rays rays = recorder->take();
  compare(name, seconds, rays, rawSeconds(rays, *engine.solution().get().tracer));
}

void ofPicture(const std::string& name, const SolutionView& solution, const View& view) {
  const Stopwatch time;
  (void)render(solution, view);
  const double seconds = time.wall();
  const auto recorded = std::make_shared<Solution>(solution.get());
  const auto recorder = std::make_shared<Recorder>(tracing::makeEmbreeTracer(recorded->scene));
  recorded->tracer = recorder;
  (void)render(SolutionView(recorded), view);
  const Rays rays = recorder->take();
  compare(name, seconds, rays, rawSeconds(rays, *solution.get().tracer));
}

int run(const std::vector<std::string>& a) {
  if (a.size() == 4 && a[0] == "solve") {
    const int copies = std::atoi(a[3].c_str());
    ofSolve(a[1], sideBySide(loadScene({a[2]}).scene, copies), copies <= kMostRecorded);
  } else if (a.size() == 4 && a[0] == "render") {
    ofPicture(a[1], loadSolution(a[2]), loadView(a[3]));
  } else {
    throw std::runtime_error("usage: solve NAME SCENE COPIES | render NAME SOLUTION VIEW.vf");
  }
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) { return deltalux::bench::runMain("raw_rays_bench", argc, argv, deltalux::bench::run); }
