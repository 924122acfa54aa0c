#include <deltalux/engine.hpp>

#include <chrono>
#include <deltalux/error.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "engine/energy_balance.hpp"
#include "engine/particle_count.hpp"
#include "engine/time_budget.hpp"
#include "hierarchy/build.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/reached_sides.hpp"
#include "particles/transfer.hpp"
#include "radiosity/coarse_solution.hpp"
#include "radiosity/gather.hpp"
#include "radiosity/push_pull.hpp"
#include "radiosity/refine.hpp"
#include "scene/diffuse_only.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr double kFirstError = 64.0;   // of the links, relative to the target, in the first round
constexpr double kLastError = 20.0;    // in the last: what links leave, the leaves' own samples resolve
constexpr double kErrorFactor = 0.35;  // from round to round
constexpr double kHasty = 8.0;         // first round when time is limited, against the first otherwise
constexpr double kSettled = 1e-3;      // unsettled power, relative to emitted
constexpr int kMaxIterations = 64;

class Clock {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

struct Engine::State {
  std::shared_ptr<Solution> solution = std::make_shared<Solution>();
  double nextError = 0;   // of the next round
  bool finished = false;  // the last round has run
  Clock clock;
  TimeBudget budget{0};

  void prepare(Progress* progress) {
    Solution& s = *solution;
    const Clock time;
    CoarseReport coarse;
    auto sides = coarseSolution(s.scene, *s.tracer, &coarse);
    trace();
    addReachedSides(sides, s.particles, s.scene);
    s.elements = buildElements(s.scene, sides);
    pull(s.elements);
    DELTALUX_VALIDATED(validate(s.elements));
    s.report.counts.raysVisibility += coarse.rays;
    s.report.times.hierarchy += time.seconds() - s.report.times.particles;
    budget = TimeBudget(s.settings.seconds, clock.seconds());
    nextError = s.settings.error * kFirstError * (budget.limited() ? kHasty : 1.0);
    if (progress) progress->report("hierarchy", 1.0);
  }

  /// Once a geometry: what particles carry follows the light by itself.
  void trace() {
    Solution& s = *solution;
    if (s.settings.diffuseOnly) return;
    const Clock time;
    s.particles = traceParticles(s.scene, *s.tracer, {particleCount(s.settings), s.settings.seed});
    DELTALUX_VALIDATED(validate(s.particles, s.scene));
    s.report.times.particles += time.seconds();
    WorkCounts& c = s.report.counts;
    c.linksDs = s.particles.links.size();
    c.particles = s.particles.arrived();
    c.impacts = s.particles.impacts();
    s.report.cutParticles = s.particles.cut();
    c.raysParticles += s.particles.rays + s.particles.looks;
    s.report.memory.particles = s.particles.memoryBytes();
  }

  void round(Progress* progress) {
    Solution& s = *solution;
    OracleSettings oracle;
    const double least = s.settings.error * kLastError;
    oracle.error = std::max(nextError, least);
    const bool last = oracle.error <= least;
    const RefineReport refined = refineLinks(oracle, progress);

    const Clock placing;
    subdivideForParticles(s.elements, s.scene, s.particles);
    s.report.times.particles += placing.seconds();

    const Clock gathering;
    bool settled = settle(progress);
    LeafTransferSettings leaves;
    leaves.error = s.settings.error;
    nextError = std::max(least, oracle.error * kErrorFactor);
    bool whole = true;
    if (budget.limited()) {
      const double needed = leafRoundSeconds(s.elements, s.links, s.scene, *s.tracer, leaves), left = budget.left();
      nextError = budget.reach(LinkErrors(s.links, s.elements, oracle), oracle.error, nextError, left - needed);
      whole = needed <= left;
      leaves = shrunk(leaves, needed, left);
    }
    finished = last || refined.stopped || !(nextError < oracle.error);
    if (finished) settled = resolve(leaves, progress);
    s.report.times.gather += gathering.seconds();
    count();
    s.report.converged = settled && whole && last && !refined.stopped;
  }

  RefineReport refineLinks(const OracleSettings& oracle, Progress* progress) {
    Solution& s = *solution;
    const double predicted = budget.limited() ? LinkErrors(s.links, s.elements, oracle).madeBy(oracle.error) : 0;
    const Clock time;
    const RefineReport refined = refine(s.links, s.elements, s.scene, *s.tracer, oracle, [&] {
      if (progress && progress->stopRequested()) throw Interrupted();
      return budget.limited() && budget.left() < 0;
    });
    DELTALUX_VALIDATED(validate(s.links, s.elements));
    budget.learn(time.seconds(), predicted, static_cast<double>(refined.created));
    s.report.times.refine += time.seconds();
    s.report.counts.raysVisibility += refined.rays;
    s.report.provenClear += refined.provenClear;
    s.report.provenBlocked += refined.provenBlocked;
    return refined;
  }

  /// Gathers until the light no longer changes. [algorithm 3]
  bool settle(Progress* progress) {
    Solution& s = *solution;
    const GatherPlan plan(s.links, s.elements);
    plan.gatherDirect(s.elements);
    const ParticleTransfer transfer(s.particles, s.elements, s.scene);
    RgbSum unsettled(0.0), emitted(0.0);
    for (int i = 0; i < kMaxIterations; ++i) {
      plan.gatherIndirect(s.elements);
      transfer.apply(s.elements, s.scene);
      unsettled = pushPull(s.elements);
      ++s.report.counts.iterations;
      emitted = directPower();
      if (progress) progress->report("gather", gray(emitted) / std::max(gray(emitted) + gray(unsettled), 1e-30));
      if (gray(unsettled) <= kSettled * gray(emitted)) break;
    }
    return gray(unsettled) <= kSettled * gray(emitted);
  }

  /// The links' transfers resolved to leaves, and settled again.
  bool resolve(const LeafTransferSettings& settings, Progress* progress) {
    Solution& s = *solution;
    const LeafTransferReport r = s.transfers.build(s.elements, s.links, s.scene, *s.tracer, settings);
    s.report.counts.raysVisibility += r.rays;
    RgbSum unsettled(0.0);
    s.transfers.gatherDirect(s.elements);
    const RgbSum emitted = directPower();
    const ParticleTransfer particles(s.particles, s.elements, s.scene);
    for (int i = 0; i < kMaxIterations; ++i) {
      s.transfers.gatherIndirect(s.elements);
      particles.apply(s.elements, s.scene);
      unsettled = pull(s.elements);
      ++s.report.counts.iterations;
      if (progress) progress->report("gather", gray(emitted) / std::max(gray(emitted) + gray(unsettled), 1e-30));
      if (gray(unsettled) <= kSettled * gray(emitted)) break;
    }
    s.report.energy = energyBalance(s, unsettled);
    return gray(unsettled) <= kSettled * gray(emitted);
  }

  RgbSum directPower() const {
    const Elements& e = solution->elements;
    RgbSum sum(0.0);
    for (std::size_t i = 0; i < e.size(); ++i)
      if (isReceivingLeaf(i)) sum += double(e.geometry[i].litArea()) * RgbSum(e.radiometry[i].direct);
    return sum;
  }

  bool isReceivingLeaf(std::size_t e) const {
    const ElementTopology& t = solution->elements.topology[e];
    return !t.emitter && !t.blocker && t.kind == ElementKind::Patch && t.childCount == 0;
  }

  void count() {
    Solution& s = *solution;
    WorkCounts& c = s.report.counts;
    c.elements = s.elements.size();
    c.leafElements = 0;
    for (std::size_t i = 0; i < s.elements.size(); ++i) c.leafElements += isReceivingLeaf(i);
    c.links = s.links.size();
    s.report.activeLinks = 0;
    for (const Link& l : s.links.all) s.report.activeLinks += l.state == LinkState::Active;
    s.report.memory.elements = s.elements.memoryBytes();
    s.report.memory.links = s.links.memoryBytes() + s.transfers.memoryBytes();
    s.report.memory.peakRss = peakResidentBytes();
  }
};

Engine::Engine(Scene scene, SolveSettings settings) : state_(std::make_unique<State>()) {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the target error is a fraction between 0 and 1");
  addAreaLights(scene);
  if (settings.diffuseOnly) dropSpeculars(scene);
  validate(scene);
  Solution& s = *state_->solution;
  s.scene = std::move(scene);
  s.settings = settings;
  s.tracer = makeEmbreeTracer(s.scene);
}

Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;
Engine& Engine::operator=(Engine&&) noexcept = default;

SolveReport Engine::step(Progress* progress) {
  const Clock time;
  Solution& s = *state_->solution;
  if (!s.elements.sceneRoot.valid() && s.elements.size() == 0) state_->prepare(progress);
  if (s.elements.sceneRoot.valid())
    state_->round(progress);
  else
    s.report.converged = state_->finished = true;
  s.report.times.total += time.seconds();
  return s.report;
}

SolveReport Engine::solve(Progress* progress) {
  SolveReport report = step(progress);
  while (!state_->finished) report = step(progress);
  return report;
}

SolutionView Engine::solution() const { return SolutionView(state_->solution); }

}  // namespace deltalux
