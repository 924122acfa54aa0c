// The driver: batches of paths per point or pixel, passes of growing size, standard errors from independent batches.
#include <deltalux/error.hpp>
#include <deltalux/reference.hpp>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/pilot_paths.hpp"
#include "base/tuning.hpp"
#include "direct/aim.hpp"
#include "direct/tuning.hpp"
#include "render/reference/path_tracer.hpp"
#include "render/tuning.hpp"

namespace deltalux {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr std::uint64_t kMaxPassBatches = 1024;  // [task]

/// A power of two, smaller when few paths are asked for.
std::uint32_t batchSize(std::uint64_t samples) {
  std::uint32_t size = direct::kEstimateRays;
  while (size > 1 && samples != 0 && samples < size * deltalux::tuning::kFewestEstimates) size /= 2;
  return size;
}

/// Test samples for the connection table: worth a small part of the job's paths, or of the time limit. `estimates` is
/// the number of points or pixels; a picture's many paths are worth a finer table than a few meters' are.
double tableBudget(const ReferenceSettings& settings, std::size_t estimates) {
  const double perSample = std::max(500.0, 1.5 * static_cast<double>(estimates));
  const double fromSamples =
      settings.samples > 0 ? perSample * static_cast<double>(settings.samples) : rendering::tuning::kMostTests;
  const double fromSeconds = settings.seconds > 0 ? 1.5e5 * settings.seconds : rendering::tuning::kMostTests;
  return std::clamp(std::min(fromSamples, fromSeconds), double(kPilotPaths), rendering::tuning::kMostTests);
}

/// Mean and spread of batch means per channel. [Welford62]
struct BatchMoments {
  std::uint64_t count = 0;
  RgbSum mean{0}, squares{0};

  void add(const RgbSum& x) {
    ++count;
    const RgbSum d = x - mean;
    mean += d / static_cast<double>(count);
    squares += d * (x - mean);
  }
  RgbSum standardError() const {
    if (count < 2) return RgbSum(0);
    const double n = static_cast<double>(count);
    return glm::sqrt(squares / (n * (n - 1)));
  }
};

/// Reports of parallel work, one thread at a time; remembers the wish to stop.
class Reporter {
 public:
  explicit Reporter(Progress* progress) : progress_(progress) {}
  void phase(std::string_view name, double base, double share, std::size_t tasks) {
    name_ = name, base_ = base, share_ = share, tasks_ = std::max<std::size_t>(tasks, 1), done_ = 0;
  }
  void taskDone() {
    ++done_;
    if (!progress_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return;
    const std::size_t done = done_;  // read under the lock: what is reported never goes back
    progress_->report(name_, std::min(1.0, base_ + share_ * static_cast<double>(done) / static_cast<double>(tasks_)));
    if (progress_->stopRequested()) stopped_ = true;
  }
  bool stopped() const { return stopped_; }
  void throwIfStopped() {
    if (progress_ && progress_->stopRequested()) stopped_ = true;
    if (stopped_) throw Interrupted();
  }

 private:
  Progress* progress_;
  std::mutex mutex_;
  std::string_view name_;
  double base_ = 0, share_ = 1;
  std::size_t tasks_ = 1;
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
};

}  // namespace

struct ReferenceIntegrator::Impl {
  Impl(const Scene& s, const ReferenceSettings& wanted)
      : settings(wanted), scene(s, wanted.diffuseOnly), connections(scene) {
    DELTALUX_CHECK(settings.samples > 0 || settings.seconds > 0 || settings.targetError > 0,
                   "samples, seconds or a target error");
  }

  /// Learns the connections for a job of so many points or pixels, unless the last job's table is the one.
  void prepare(std::size_t estimates);

  /// How many batches the next pass makes; 0 ends.
  struct Schedule {
    std::uint64_t total;  // batches; 0: no limit
    std::uint64_t done = 0;
  };
  std::uint64_t nextPass(const Schedule&, double elapsed) const;
  double fractionDone(const Schedule&, double elapsed) const;
  double fractionAfter(const Schedule&, std::uint64_t batches, double fractionBefore) const;

  template <class Estimate>
  RgbSum batchMean(std::uint64_t key, std::uint32_t first, std::uint32_t size, const Estimate& estimate);
  bool converged(const BatchMoments&) const;

  ReferenceSettings settings;
  rendering::ReferenceScene scene;
  rendering::LightConnections connections;
  double budget = 0;  // what the table was learnt with
  std::optional<rendering::ConnectionTable> table;
  std::optional<rendering::PathTracer> tracer;
  std::atomic<std::uint64_t> rays{0}, paths{0};
  double seconds = 0;
};

void ReferenceIntegrator::Impl::prepare(std::size_t estimates) {
  const double wanted = tableBudget(settings, estimates);
  if (table && budget == wanted) return;
  budget = wanted;
  tracer.reset();
  table.emplace(scene, connections, budget);
  tracer.emplace(scene, connections, *table, settings.maxDepth);
}

std::uint64_t ReferenceIntegrator::Impl::nextPass(const Schedule& s, double elapsed) const {
  // With a time limit the first pass is as small as can be: it tells how long a batch takes.
  const std::uint64_t fewest = settings.seconds > 0 ? 1 : 4;
  std::uint64_t batches = std::min<std::uint64_t>(std::max<std::uint64_t>(s.done, fewest), kMaxPassBatches);
  if (s.total > 0) batches = std::min(batches, s.total - s.done);
  if (settings.seconds > 0 && s.done > 0) {
    const double perBatch = elapsed / static_cast<double>(s.done);
    const double fit = (settings.seconds - elapsed) / perBatch;
    batches = fit < 1.0 ? 0 : std::min(batches, static_cast<std::uint64_t>(fit));
  }
  return batches;
}

double ReferenceIntegrator::Impl::fractionDone(const Schedule& s, double elapsed) const {
  const double bySamples = s.total > 0 ? static_cast<double>(s.done) / static_cast<double>(s.total) : 0.0;
  return std::max(bySamples, settings.seconds > 0 ? elapsed / settings.seconds : 0.0);
}

/// What fractionDone will be after `batches` more, if they take as long as those before.
double ReferenceIntegrator::Impl::fractionAfter(const Schedule& s, std::uint64_t batches, double fractionBefore) const {
  if (s.total > 0) return static_cast<double>(s.done + batches) / static_cast<double>(s.total);
  if (s.done == 0) return fractionBefore;
  return std::min(1.0, fractionBefore * static_cast<double>(s.done + batches) / static_cast<double>(s.done));
}

template <class Estimate>
RgbSum ReferenceIntegrator::Impl::batchMean(std::uint64_t key, std::uint32_t first, std::uint32_t size,
                                            const Estimate& estimate) {
  RgbSum sum(0);
  std::uint64_t traced = 0;
  for (std::uint32_t i = first; i < first + size; ++i) {
    rendering::PathSampler sampler(key, i);
    sum += estimate(sampler, traced);
  }
  rays.fetch_add(traced, std::memory_order_relaxed);
  paths.fetch_add(size, std::memory_order_relaxed);
  return sum / static_cast<double>(size);
}

bool ReferenceIntegrator::Impl::converged(const BatchMoments& m) const {
  if (settings.targetError <= 0 || m.count < 2 * deltalux::tuning::kFewestEstimates) return false;
  return glm::all(glm::lessThanEqual(m.standardError(), settings.targetError * m.mean));
}

ReferenceIntegrator::ReferenceIntegrator(const Scene& scene, ReferenceSettings settings)
    : impl_(std::make_unique<Impl>(scene, settings)) {}
ReferenceIntegrator::~ReferenceIntegrator() = default;

std::vector<ProbeResult> ReferenceIntegrator::probe(std::span<const ProbePoint> points, Progress* progress) {
  Impl& impl = *impl_;
  impl.prepare(points.size());
  const auto start = Clock::now();
  const std::uint32_t size = batchSize(impl.settings.samples);
  Impl::Schedule schedule{(impl.settings.samples + size - 1) / size};
  std::vector<BatchMoments> moments(points.size());
  std::vector<std::size_t> active(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) active[i] = i;
  Reporter reporter(progress);
  std::vector<RgbSum> means;
  while (!active.empty()) {
    const std::uint64_t batches = impl.nextPass(schedule, secondsSince(start));
    if (batches == 0) break;
    const double before = impl.fractionDone(schedule, secondsSince(start));
    const double after = impl.fractionAfter(schedule, batches, before);
    means.assign(active.size() * batches, RgbSum(0));
    reporter.phase("probes", before, std::max(0.0, after - before), means.size());
    parallelFor(means.size(), 1, [&](std::size_t task) {
      if (reporter.stopped()) return;
      const std::size_t point = active[task / batches];
      const std::uint64_t batch = schedule.done + task % batches;
      const std::uint64_t key = combineKeys(combineKeys(impl.settings.seed, point), batch);
      means[task] = impl.batchMean(key, 0, size, [&](rendering::PathSampler& sampler, std::uint64_t& rays) {
        return impl.tracer->irradiance(points[point].position, glm::normalize(points[point].normal), sampler, rays);
      });
      reporter.taskDone();
    });
    reporter.throwIfStopped();
    for (std::size_t task = 0; task < means.size(); ++task) moments[active[task / batches]].add(means[task]);
    schedule.done += batches;
    std::erase_if(active, [&](std::size_t point) { return impl.converged(moments[point]); });
  }
  std::vector<ProbeResult> results;
  for (const BatchMoments& m : moments) results.push_back({m.mean, m.standardError(), m.count * size});
  impl.seconds += secondsSince(start);
  return results;
}

Image ReferenceIntegrator::render(const View& view, int width, int height, Progress* progress) {
  Impl& impl = *impl_;
  impl.prepare(static_cast<std::size_t>(width) * height);
  const auto start = Clock::now();
  // A second may be over after a path a pixel; batches that follow each other share their stratified numbers then.
  const std::uint32_t most = impl.settings.seconds > 0 ? 1 : deltalux::tuning::kPilots,
                      size = std::min(most, batchSize(impl.settings.samples)),
                      shared = deltalux::tuning::kFewRays / std::min<std::uint32_t>(deltalux::tuning::kFewRays, size);
  Impl::Schedule schedule{(impl.settings.samples + size - 1) / size};
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  std::vector<BatchMoments> moments(pixels);
  Reporter reporter(progress);
  while (true) {
    const std::uint64_t batches = impl.nextPass(schedule, secondsSince(start));
    if (batches == 0) break;
    const double before = impl.fractionDone(schedule, secondsSince(start));
    const double after = impl.fractionAfter(schedule, batches, before);
    constexpr std::size_t kBlock = 64;  // [task]
    reporter.phase("render", before, std::max(0.0, after - before), (pixels + kBlock - 1) / kBlock);
    parallelBlocks(pixels, kBlock, [&](std::size_t begin, std::size_t end) {
      if (reporter.stopped()) return;
      for (std::size_t pixel = begin; pixel < end; ++pixel) {
        if (impl.converged(moments[pixel])) continue;
        const double x = static_cast<double>(pixel % width), y = static_cast<double>(pixel / width);
        for (std::uint64_t b = schedule.done; b < schedule.done + batches; ++b) {
          const std::uint64_t key = combineKeys(combineKeys(~impl.settings.seed, pixel), b / shared);
          moments[pixel].add(impl.batchMean(key, static_cast<std::uint32_t>(b % shared) * size, size,
                                            [&](rendering::PathSampler& sampler, std::uint64_t& rays) {
                                              const Vec2 in = sampler.next2();
                                              const ViewRay ray =
                                                  viewRay(view, (x + in.x) / width, (y + in.y) / height);
                                              return impl.tracer->radiance(ray.origin, ray.direction, sampler, rays);
                                            }));
        }
      }
      reporter.taskDone();
    });
    reporter.throwIfStopped();
    schedule.done += batches;
  }
  Image image;
  image.luminousEfficacy = impl_->scene.scene().luminousEfficacy;
  image.width = width, image.height = height;
  for (const BatchMoments& m : moments) image.pixels.push_back(Rgb(m.mean));
  impl.seconds += secondsSince(start);
  return image;
}

ReferenceStats ReferenceIntegrator::stats() const { return {impl_->rays, impl_->paths, impl_->seconds}; }

}  // namespace deltalux
