#include <deltalux/engine.hpp>

#include <algorithm>
#include <chrono>
#include <deltalux/error.hpp>
#include <optional>
#include <utility>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "caustics/texture_upkeep.hpp"
#include "engine/energy_balance.hpp"
#include "engine/growth.hpp"
#include "engine/motion.hpp"
#include "engine/moving_groups.hpp"
#include "engine/particle_count.hpp"
#include "engine/scene_update.hpp"
#include "engine/time_budget.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/reached_sides.hpp"
#include "particles/transfer.hpp"
#include "radiosity/coarse_solution.hpp"
#include "radiosity/gather.hpp"
#include "radiosity/line_space.hpp"
#include "radiosity/push_pull.hpp"
#include "radiosity/refine.hpp"
#include "radiosity/row_settling.hpp"
#include "scene/diffuse_only.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr double kFirstError = 64.0;   // of the links, relative to the target, in the first round
constexpr double kLastError = 20.0;    // in the last: what links leave, the leaves' own samples resolve
constexpr double kErrorFactor = 0.35;  // from round to round
constexpr double kHasty = 8.0;         // first round when time is limited, against the first otherwise
constexpr double kSettled = 1e-3;      // unsettled power, relative to emitted
constexpr double kSettledRows = 1e-4;  // over rows, where an iteration costs next to nothing
constexpr double kMostGaps = 1.5;      // size of particles with gaps, to that without
constexpr int kMaxIterations = 64;
constexpr float kBrighter = 8.0f;  // times as bright as when it was solved for, a light is solved for anew
constexpr int kMaxRowIterations = 1024;

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
  SurfaceSides textured;  // that textures show the particles of
  Clock clock;
  TimeBudget budget{0};
  SceneUpdate pending;                       // edits since the last update
  std::optional<ParticleTracing> tracing;    // knows the scene that the particles are of
  RgbSum unsettled{0.0};                     // power that the last iteration of rows changed
  bool counted = true;                       // the report is of the solution as it is
  std::optional<RowSettling> settling;       // of diffuse light, while nothing but rows changes
  std::optional<ParticleTransfer> transfer;  // of the particles, on the mesh of the rows
  std::optional<TextureUpkeep> upkeep;       // of the textures, once there are edits
  Backlog backlog;                           // what edits that were taken in have still to do
  MovingGroups groups;                       // of the tracer

  SolveReport step(Progress* progress) {
    const Clock time;
    Solution& s = *solution;
    if (!s.elements.sceneRoot.valid() && s.elements.size() == 0) prepare(progress);
    if (s.elements.sceneRoot.valid())
      round(progress);
    else
      s.report.converged = finished = true;
    s.report.times.total += time.seconds();
    return s.report;
  }

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
    tracing.emplace(s.scene, *s.tracer, ParticleSettings{particleCount(s.settings), s.settings.seed});
    s.particles = tracing->trace();
    DELTALUX_VALIDATED(validate(s.particles, s.scene));
    s.report.times.particles += time.seconds();
    countParticles();
  }

  void countParticles() {
    Solution& s = *solution;
    WorkCounts& c = s.report.counts;
    c.linksDs = s.particles.links.size();
    c.particles = s.particles.arrived();
    c.impacts = s.particles.impacts();
    s.report.cutParticles = s.particles.cut();
    c.raysParticles = s.particles.rays + s.particles.looks;
    s.report.memory.particles = s.particles.memoryBytes();
  }

  void round(Progress* progress) {
    Solution& s = *solution;
    OracleSettings oracle;
    const double least = s.settings.error * kLastError;
    oracle.error = std::max(nextError, least);
    const bool last = oracle.error <= least;
    const RefineReport refined = refineLinks(oracle, progress);

    chooseTextures();
    const Clock placing;
    subdivideForParticles(s.elements, s.scene, s.particles, textured);
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
    if (finished) makeTextures();
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

  /// Sides whose particles textures show: their mesh need not. [GD01 3]
  void chooseTextures() {
    Solution& s = *solution;
    textured.assign(2 * s.scene.primitives.size(), false);
    if (s.particles.impacts() == 0 || !s.settings.causticTextures) return;
    const Clock time;
    textured = sidesWithTextures(s.scene, s.elements, impacts(s.particles, s.elements, s.scene), s.settings.error);
    s.report.times.textures += time.seconds();
  }

  void makeTextures() {
    Solution& s = *solution;
    const Clock time;
    s.caustics =
        makeCaustics(s.scene, s.elements, impacts(s.particles, s.elements, s.scene), s.settings.error, textured);
    DELTALUX_VALIDATED(validate(s.caustics));
    s.report.times.textures += time.seconds();
    countTextures();
  }

  void countTextures() {
    Solution& s = *solution;
    s.report.counts.causticTextures = s.caustics.count();
    s.report.counts.causticTextureMeanSize = s.caustics.meanSize();
    s.report.memory.textures = s.caustics.memoryBytes() + (upkeep ? upkeep->memoryBytes() : 0);
  }

  /// Gathers until the light no longer changes. [algorithm 3]
  bool settle(Progress* progress) {
    Solution& s = *solution;
    const GatherPlan plan(s.links, s.elements);
    plan.gatherDirect(s.elements);
    const ParticleTransfer onMesh(s.particles, s.elements, s.scene);
    RgbSum emitted(0.0);
    for (int i = 0; i < kMaxIterations; ++i) {
      plan.gatherIndirect(s.elements);
      onMesh.apply(s.elements, s.scene);
      unsettled = pushPull(s.elements);
      ++s.report.counts.iterations;
      emitted = directPower();
      if (progress) progress->report("gather", gray(emitted) / std::max(gray(emitted) + gray(unsettled), 1e-30));
      if (gray(unsettled) <= kSettled * gray(emitted)) break;
    }
    return gray(unsettled) <= kSettled * gray(emitted);
  }

  struct Motion {
    SpaceChange all;                // bounds before and after
    std::vector<ElementId> inputs;  // of what moves
    LinkMarks marks;
    bool grown = false;           // elements were added above the leaves that there were
    std::vector<ElementId> rows;  // leaves whose rows are others than before
  };

  /// What a fresh solve would make of the edited scene, from the solution there is. [GD01 5]
  StepReport update(Progress* progress) {
    const Clock time;
    StepReport step;
    takeIn(step);
    if (backlog.afresh) {
      solveAfresh(progress);
      step.times.total = time.seconds();
      return step;
    }
    const SceneUpdate edits = std::exchange(backlog.links, {});
    Motion motion = leave(edits, step);
    ParticleUpdate followed;
    if (tracing) followed = followWithParticles(tracing->waiting().size(), step);
    const bool split = subdivideWhereParticlesLanded(step);
    arriveInLight(edits, motion, split, step);
    // Frames may have found origins on what had moved where its elements did not stand yet.
    if (std::exchange(backlog.frames, false) || split) transfer.reset();
    placeParticles(followed, step);
    const Clock gathering;
    settleAfter(motion, progress);
    step.times.gather += gathering.seconds();
    followWithTextures(step);
    if (gapsAreMany()) closeGaps();
    counted = false;
    step.times.total = time.seconds();
    return step;
  }

  /// What moves, and sides that come into the light by it.
  void arriveInLight(const SceneUpdate& edits, Motion& motion, bool split, StepReport& step) {
    Growth growth = grow(edits, backlog.landed, step);
    const std::vector<ElementId> reflecting = std::exchange(backlog.reflecting, {});
    growth.woken.insert(growth.woken.end(), reflecting.begin(), reflecting.end());
    motion.grown = split || growth.root.valid();
    motion.rows = leavesBelow(solution->elements, growth);
    if (split || !motion.marks.changes.empty() || !growth.empty()) arrive(motion, growth, step);
  }

  /// As much of an update as fits. [GD01 4.3]
  StepReport frame(double seconds) {
    const Clock time;
    const auto left = [&] { return seconds - time.seconds(); };
    Solution& s = *solution;
    StepReport step;
    constexpr double kLikely = 0.02;  // of the time of a solve
    if (!backlog.follow.known()) backlog.follow.learn(kLikely * s.report.times.total);
    constexpr double kMostGapsInMotion = 4;  // closing them takes longer than a frame
    if (gapsAreMany(kMostGapsInMotion)) {    // what the paths were, textures have to see first
      if (tracing && transfer) followWithTextures(step);
      closeGaps();
    }
    settling.reset();
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    const bool relit = !pending.dimmed.empty();
    takeIn(step, true);
    backlog.frames = true;
    if (!backlog.afresh) {
      if (tracing && !tracing->allWait() && !tracing->waiting().empty()) followInPart(left, step);
      const bool links = backlog.linksWait() && backlog.follow.seconds() < left();
      if (links) followWithLinks(step);
      if (links || relit) s.transfers.gatherDirect(s.elements);
      iterate(left, step);
    }
    countWaiting(step);
    step.particlesTotal = s.report.counts.particles;
    step.times.total = time.seconds();
    return step;
  }

  void countWaiting(StepReport& step) const {
    const Solution& s = *solution;
    step.deferred = backlog.links.moved.size() + backlog.links.movedLights.size();
    double stale = backlog.linksWait() ? lightOn(s, backlog.links) : 0.0;
    if (tracing && tracing->allWait()) {
      step.deferred += s.particles.paths();
      for (std::size_t path = 0; path < s.particles.paths(); ++path) stale += deposited(s, *transfer, path);
    } else if (tracing) {
      step.deferred += tracing->waiting().size();
      for (const ParticleTracing::Waiting& w : tracing->waiting()) stale += w.worth;
    }
    step.staleW = stale * s.scene.metresPerUnit * s.scene.metresPerUnit;
  }

  /// Edits reach the scene's emission, the tracer, and the lists of what has to follow.
  void takeIn(StepReport& step, bool inMotion = false) {
    const SceneUpdate edits = std::exchange(pending, {});
    step.op = edits.op, step.object = edits.subject;
    backlog.afresh |= !haveElements(solution->elements, solution->scene, edits) || outshines(edits);
    if (backlog.afresh) return;
    if (!edits.dimmed.empty() || !edits.materials.empty()) settling.reset();
    const std::vector<ElementId> reflecting = relight(edits);
    backlog.reflecting.insert(backlog.reflecting.end(), reflecting.begin(), reflecting.end());
    std::vector<PrimitiveId> moved;
    for (const SceneChange::Moved& m : edits.moved) moved.push_back(m.primitive);
    groups.rebuild(tracer(), moved);
    backlog.add(edits);
    if (!tracing) return;
    const Clock time;
    ParticleTracing::Worth worth;
    if (inMotion) worth = [&](std::size_t path) { return deposited(*solution, *transfer, path); };
    tracing->note(solution->particles, edits.whole, worth);
    step.times.particles += time.seconds();
  }

  /// Nobody traces now, and who holds the solution holds the engine's tracer.
  RayTracer& tracer() { return *std::const_pointer_cast<RayTracer>(solution->tracer); }

  /// Links and rows, to where things are now, and particles onto the mesh that there is then.
  void followWithLinks(StepReport& step) {
    const Clock time;
    const SceneUpdate edits = std::exchange(backlog.links, {});
    Motion motion = leave(edits, step);
    arriveInLight(edits, motion, false, step);
    transfer.emplace(solution->particles, solution->elements, solution->scene);
    backlog.follow.learn(time.seconds());
  }

  /// Whether a light is so much brighter than when links were refined and rows sampled that it needs its own.
  bool outshines(const SceneUpdate& edits) const {
    const Solution& s = *solution;
    return std::any_of(edits.dimmed.begin(), edits.dimmed.end(), [&](LightId light) {
      return light.index() >= s.sampledScale.size() ||  // it was not there
             gray(s.scene[light].scale) > kBrighter * gray(s.sampledScale[light.index()]);
    });
  }

  /// Traces those that deposit the most anew, as many as there is time for, and carries their light along.
  template <class Left>
  void followInPart(const Left& left, StepReport& step) {
    constexpr std::size_t kFewest = 256;  // so that every frame gets on
    Solution& s = *solution;
    const double time = left() - backlog.carry.seconds() - backlog.deposit.seconds();
    const auto fit = static_cast<std::size_t>(std::max(0.0, time) / backlog.path.seconds());
    const ParticleUpdate followed = followWithParticles(std::max(kFewest, fit), step);
    const Clock carrying;
    TextureFlux textures(s);
    textures.takeOut(followed, *transfer);
    transfer->follow(s.particles, followed, s.elements, s.scene);
    carryTextures(textures, followed);
    backlog.carry.learn(carrying.seconds());
    step.times.particles += carrying.seconds();
  }

  /// Retraces particles that edits have touched: `count` of those that wait. [GD01 4]
  ParticleUpdate followWithParticles(std::size_t count, StepReport& step) {
    Solution& s = *solution;
    const Clock time;
    ParticleUpdate followed =
        tracing->allWait() ? tracing->retraceAll(s.particles) : tracing->retrace(s.particles, count);
    DELTALUX_VALIDATED(validate(s.particles, s.scene));
    constexpr std::size_t kTelling = 2048;  // fewer paths cost what starting costs
    if (followed.paths.size() >= kTelling)
      backlog.path.learn(time.seconds(), static_cast<double>(followed.paths.size()));
    backlog.add(followed);
    if (!backlog.frames) countParticles();
    step.particlesRetraced = followed.all ? s.particles.arrived() : followed.particles;
    step.particlesTotal = s.particles.arrived();
    step.times.particles += time.seconds();
    return followed;
  }

  void carryTextures(TextureFlux& textures, const ParticleUpdate& followed) {
    Solution& s = *solution;
    if (backlog.textures.empty()) backlog.textures = s.caustics.surfaces;
    textures.putIn(followed, *transfer);
    textures.apply(s.caustics, backlog.textures);
  }

  /// Brings the particles' light to the elements, and hands on light as often as there is time for.
  template <class Left>
  void iterate(const Left& left, StepReport& step) {
    Solution& s = *solution;
    const Clock time;
    transfer->apply(s.elements, s.scene);
    pull(s.elements);
    backlog.deposit.learn(time.seconds());
    const double emitted = backlog.pass.seconds() < left() ? gray(directPower()) : 0.0;
    while (backlog.pass.seconds() < left()) {
      const Clock passing;
      s.transfers.gatherIndirect(s.elements);
      transfer->apply(s.elements, s.scene);
      unsettled = pull(s.elements);
      backlog.pass.learn(passing.seconds());
      ++s.report.counts.iterations;
      if (gray(unsettled) <= kSettledRows * emitted) break;
    }
    step.times.gather += time.seconds();
  }

  /// Where light of particles is new. It is sent on from where it lies, so the mesh must know.
  bool subdivideWhereParticlesLanded(StepReport& step) {
    Solution& s = *solution;
    const Clock time;
    if (!tracing) return false;
    if (backlog.landed.paths.empty() && !backlog.landed.all) return false;
    std::vector<bool> shown(2 * s.scene.primitives.size(), false);
    for (const SurfaceCaustics& c : s.caustics.surfaces) shown[2 * c.primitive.index() + (c.front ? 0 : 1)] = true;
    const std::size_t split = subdivideForParticles(s.elements, s.scene, s.particles, shown,
                                                    sidesThatKeepTheirMesh(s.scene, s.particles, backlog.landed));
    step.times.particles += time.seconds();
    return split > 0;
  }

  /// On the mesh as it is now.
  void placeParticles(const ParticleUpdate& followed, StepReport& step) {
    if (!transfer) return;
    const Clock time;
    if (!tracing || followed.all)
      transfer.reset();  // none, on a mesh that may have changed; or all of them
    else
      transfer->follow(solution->particles, followed, solution->elements, solution->scene);
    step.times.particles += time.seconds();
  }

  /// Elements for what the edits brought into the light.
  Growth grow(const SceneUpdate& edits, const ParticleUpdate& followed, StepReport& step) {
    const Clock time;
    const Growth growth = growInLight(*solution, edits, followed);
    DELTALUX_VALIDATED(validate(solution->elements));
    if (growth.root.valid()) transfer.reset();  // particles may have landed there all the while
    step.times.hierarchy = time.seconds();
    return growth;
  }

  /// Paths that were traced anew leave gaps.
  bool gapsAreMany(double most = kMostGaps) const {
    const Particles& p = solution->particles;
    std::size_t used = 0;
    for (const PathRange& r : p.range) used += r.vertices;
    return static_cast<double>(p.vertices.size()) > most * static_cast<double>(used);
  }
  void closeGaps() {
    solution->particles.compact();
    transfer.reset(), upkeep.reset();
  }

  /// Makes the textures anew whose light has changed.
  void followWithTextures(StepReport& step) {
    Solution& s = *solution;
    const Clock time;
    const ParticleUpdate followed = std::exchange(backlog.landed, {});
    if (!backlog.textures.empty()) s.caustics.surfaces = std::exchange(backlog.textures, {});
    if (!upkeep || followed.all) {
      upkeep.reset();
      chooseTextures();
      makeTextures();
      step.texturesRebuilt = s.caustics.count();
    } else {
      step.texturesRebuilt = upkeep->follow(followed, *transfer, s.caustics).rebuilt;
      DELTALUX_VALIDATED(validate(s.caustics));
      countTextures();
    }
    step.times.textures = time.seconds();
  }

  Restore apply(const Edit& edit) {
    if (pending.empty() && !backlog.frames) prepareToFollow();
    return applyInto(pending, solution->scene, edit);
  }

  /// Gives an object a place of its own in the tracer, and makes ready what updates need to know.
  void select(const std::string& object) {
    Solution& s = *solution;
    const std::vector<ObjectId> found = findObjects(s.scene, object);
    std::vector<PrimitiveId> primitives;
    for (const ObjectId id : found)
      for (const PrimitiveId p : primitivesOf(s.scene, id)) primitives.push_back(p);
    std::sort(primitives.begin(), primitives.end());
    primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
    groups.separate(tracer(), s.scene, primitives);
    if (pending.empty() && !backlog.frames) prepareToFollow();
    if (!finished) return;
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    Box box;
    for (const PrimitiveId p : primitives)
      if (const Box b = bounds(s.scene[p].shape); !b.empty()) box.extend(b);
    if (tracing) tracing->expectMotion(s.particles, box);
  }

  /// While the scene is still what the particles and textures are of.
  void prepareToFollow() {
    Solution& s = *solution;
    if (!finished) return;
    if (s.settings.diffuseOnly) {
      if (!settling) settling.emplace(s.transfers, s.elements);
      return;
    }
    if (!tracing) tracing.emplace(s.scene, *s.tracer, ParticleSettings{particleCount(s.settings), s.settings.seed});
    if (upkeep || !s.settings.causticTextures) return;
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    upkeep.emplace(TextureUpkeep::Parts{s.scene, s.elements, s.particles}, *transfer, s.settings.error);
  }

  /// There is no place in the trees for what was not there.
  void solveAfresh(Progress* progress) {
    Solution& s = *solution;
    s.tracer = makeEmbreeTracer(s.scene);
    tracing.reset(), transfer.reset(), upkeep.reset(), settling.reset(), backlog = {}, groups = {};
    s.elements = {}, s.links = {}, s.particles = {}, s.transfers = {}, s.caustics = {}, s.report = {};
    finished = false;
    clock = {};
    while (!finished) step(progress);
  }

  /// Emission and reflectance of what stays where it was. Returns what was black and reflects now: links took it for no
  /// sender.
  std::vector<ElementId> relight(const SceneUpdate& edits) {
    Solution& s = *solution;
    std::vector<ElementId> reflecting;
    for (const ElementId e : elementsOf(s.elements, edits.dimmed)) setEmission(s.elements, s.scene, e);
    for (const LightId light : edits.movedLights) s.sampledScale[light.index()] = s.scene[light].scale;
    std::vector<PrimitiveId> repainted;
    for (std::size_t i = 0; i < s.scene.primitives.size(); ++i)
      if (std::find(edits.materials.begin(), edits.materials.end(), s.scene.primitives[i].material) !=
          edits.materials.end())
        repainted.emplace_back(i);
    for (const ElementId e : elementsOf(s.elements, repainted)) {
      if (s.elements.at(e).emitter) continue;
      const ElementLight& l = s.elements.radiometry[e.index()];
      const bool wasBlack = isBlack(l.rho) && isBlack(l.tau);
      setReflectance(s.elements, s.scene, e);
      if (wasBlack && !(isBlack(l.rho) && isBlack(l.tau))) reflecting.push_back(e);
    }
    return reflecting;
  }

  /// What moves leaves its place: the links that it touches there, and the shapes of its elements.
  Motion leave(const SceneUpdate& edits, StepReport& step) {
    Solution& s = *solution;
    const Clock time;
    Motion motion;
    std::vector<PrimitiveId> primitives;
    SpaceChange before, after;
    for (const SceneChange::Moved& m : edits.moved) {
      primitives.push_back(m.primitive);
      before.add(m.before), motion.all.add(m.before);
    }
    for (const PrimitiveId id : primitives)
      if (const Box box = bounds(s.scene[id].shape); !box.empty()) after.add(box), motion.all.add(box);
    motion.inputs = elementsOf(s.elements, primitives);
    const std::vector<ElementId> lights = elementsOf(s.elements, edits.movedLights);
    motion.inputs.insert(motion.inputs.end(), lights.begin(), lights.end());
    motion.all.setMoved(subtrees(s.elements, motion.inputs));
    if (primitives.empty() && motion.inputs.empty()) return motion;
    motion.marks = LineSpace(s.links, s.elements, s.scene, motion.all, before, after).visit();
    reshape(s.elements, s.scene, motion.inputs);
    step.times.visibility = time.seconds();
    return motion;
  }

  /// It comes to its new place, and what has grown in the light with it: links and rows follow.
  void arrive(Motion& motion, const Growth& growth, StepReport& step) {
    Solution& s = *solution;
    const Clock time;
    LinkMarks& marks = motion.marks;
    if (marks.changes.empty() || !growth.woken.empty()) {
      SpaceChange woken;
      woken.setMoved(subtrees(s.elements, growth.woken));
      add(LineSpace(s.links, s.elements, s.scene, woken, {}, {}).visit(), marks);
      motion.inputs.insert(motion.inputs.end(), growth.woken.begin(), growth.woken.end());
      motion.all.setMoved(subtrees(s.elements, motion.inputs));
    }
    if (growth.root.valid()) addRootLinks(s.links, s.elements, growth.root);
    step.linksVisited = marks.visited;
    step.times.visibility += time.seconds();

    const Clock refining;
    OracleSettings oracle;
    oracle.error = s.settings.error * kLastError;
    std::vector<LinkId> changed;
    const RefineReport refined = rejudge(s.links, s.elements, s.scene, *s.tracer, oracle, motion.all, marks, changed);
    DELTALUX_VALIDATED(validate(s.links, s.elements));
    step.linksChanged = changed.size();
    step.times.refine = refining.seconds();
    const Clock gathering;
    const ConcernedLeaves leaves = s.transfers.concerned(s.elements, s.links, marks, changed, motion.all);
    const LeafUpdateReport rows =
        s.transfers.update(s.elements, s.links, s.scene, *s.tracer, leafSettings(), marks, changed, motion.all, leaves);
    DELTALUX_VALIDATED(s.transfers.validate(s.elements, s.links));
    s.report.counts.raysVisibility += refined.rays + rows.rays;
    step.leavesExamined = std::max(leaves.byLights.size(), leaves.byLeaves.size());
    step.leavesRenewed = std::max(rows.direct, rows.indirect);
    step.times.gather = gathering.seconds();
    motion.rows.insert(motion.rows.end(), rows.leaves.begin(), rows.leaves.end());
  }

  static std::vector<char> subtrees(const Elements& elements, const std::vector<ElementId>& tops) {
    std::vector<char> in(elements.size(), 0);
    for (const ElementId e : tops) in[e.index()] = 1;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const ElementTopology& t = elements.topology[i];
      if (t.parent.valid() && t.depth > 0 && in[t.parent.index()]) in[i] = 1;
    }
    return in;
  }

  LeafTransferSettings leafSettings() const {
    LeafTransferSettings settings;
    settings.error = solution->settings.error;
    return settings;
  }

  /// The links' transfers resolved to leaves, and settled again.
  bool resolve(const LeafTransferSettings& settings, Progress* progress) {
    Solution& s = *solution;
    transfer.reset();
    const LeafTransferReport r = s.transfers.build(s.elements, s.links, s.scene, *s.tracer, settings);
    s.report.counts.raysVisibility += r.rays;
    s.sampledScale.clear();
    for (const Light& light : s.scene.lights) s.sampledScale.push_back(light.scale);
    return settleRows(progress);
  }

  /// Gathers over rows, from the light there is, until it no longer changes.
  bool settleRows(Progress* progress) {
    Solution& s = *solution;
    s.transfers.gatherDirect(s.elements);
    pull(s.elements);
    const RgbSum emitted = directPower();
    if (!transfer) transfer.emplace(s.particles, s.elements, s.scene);
    for (int i = 0; i < kMaxRowIterations; ++i) {
      s.transfers.gatherIndirect(s.elements);
      transfer->apply(s.elements, s.scene);
      unsettled = pull(s.elements);
      ++s.report.counts.iterations;
      if (progress) progress->report("gather", gray(emitted) / std::max(gray(emitted) + gray(unsettled), 1e-30));
      if (gray(unsettled) <= kSettledRows * gray(emitted)) break;
    }
    return gray(unsettled) <= kSettledRows * gray(emitted);
  }

  /// Where nothing but rows has changed, only they and what they light is gathered again.
  void settleAfter(const Motion& motion, Progress* progress) {
    Solution& s = *solution;
    if (motion.grown) settling.reset();
    if (!settling) {
      settleRows(progress);
      return;
    }
    unsettled = settling->settle(s.transfers, s.elements, motion.rows, kSettledRows * gray(directPower()),
                                 kMaxRowIterations, s.report.counts.iterations);
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

  /// Sums that take a walk over everything, for who looks at the report.
  void count() {
    Solution& s = *solution;
    if (finished) s.report.energy = energyBalance(s, unsettled);
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
    counted = true;
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

SolveReport Engine::step(Progress* progress) { return state_->step(progress); }

SolveReport Engine::solve(Progress* progress) {
  SolveReport report = step(progress);
  while (!state_->finished) report = step(progress);
  return report;
}

Engine::Engine(SolutionView view) : state_(std::make_unique<State>()) {
  const std::shared_ptr<const Solution> held = view.share();
  view = SolutionView(nullptr);
  if (held.use_count() == 1) {
    state_->solution = std::const_pointer_cast<Solution>(held);
  } else {
    state_->solution = std::make_shared<Solution>(*held);
    state_->solution->tracer = makeEmbreeTracer(state_->solution->scene);
  }
  state_->finished = !state_->solution->transfers.empty() || state_->solution->elements.size() == 0;
}

Restore Engine::apply(const Edit& edit) { return state_->apply(edit); }

StepReport Engine::update(Progress* progress) {
  if (!state_->finished) solve(progress);
  return state_->update(progress);
}

StepReport Engine::frame(double milliseconds, Progress* progress) {
  if (!state_->finished) solve(progress);
  return state_->frame(1e-3 * milliseconds);
}

void Engine::select(const std::string& object) { state_->select(object); }

SolutionView Engine::solution() const {
  if (!state_->counted) state_->count();
  return SolutionView(state_->solution);
}

}  // namespace deltalux
