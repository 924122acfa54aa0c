#pragma once
// What an engine holds between calls, and its three ways to get on: it solves (solving.cpp), takes edits in whole
// (updating.cpp), or takes them in frame by frame, as far as time goes (frames.cpp).
#include <deltalux/engine.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "caustics/texture_upkeep.hpp"
#include "engine/clock.hpp"
#include "engine/growth.hpp"
#include "engine/light_settling.hpp"
#include "engine/line_motion.hpp"
#include "engine/line_solve.hpp"
#include "engine/motion.hpp"
#include "engine/moving_groups.hpp"
#include "engine/scene_update.hpp"
#include "engine/time_budget.hpp"
#include "paper/line_space.hpp"
#include "paper/oracle.hpp"
#include "paper/refine.hpp"
#include "paper/update.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/transfer.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

constexpr double kLastError = 20.0;    // of the links, relative to the target: the rest the leaves' own samples resolve
constexpr double kSettledRows = 1e-4;  // unsettled power over rows, relative to emitted
constexpr double kSettledWell = 1e-6;  // the same, where it shall be right in dark corners too
constexpr double kMissed = 3e-5;       // power that leaves may fail to send after an update, relative to emitted
constexpr int kMaxRowIterations = 1024;
constexpr double kMostGaps = 1.5;  // size of particles with gaps, to that without

}  // namespace deltalux::engine

namespace deltalux {

struct Engine::State {
  std::shared_ptr<Solution> solution = std::make_shared<Solution>();
  double nextError = 0;    // of the next round
  bool finished = false;   // the last round has run
  bool previewed = false;  // the first round is to be a coarse one
  engine::Clock clock;
  engine::TimeBudget budget{0};
  bool curtailed = false;                               // fewer particles than the error asks for: there was no time
  engine::SceneUpdate pending;                          // edits since the last update
  std::optional<particles::ParticleTracing> tracing;    // knows the scene that the particles are of
  RgbSum unsettled{0.0};                                // power that the last iteration of rows changed
  bool counted = true;                                  // the report is of the solution as it is
  bool updated = false;                                 // since it was solved: its balance waits until it is asked for
  std::optional<engine::LightSettling> settling;        // from update to update
  std::optional<particles::ParticleTransfer> transfer;  // of the particles, on the mesh of the rows
  std::optional<caustics::TextureUpkeep> upkeep;        // of the textures, once there are edits
  engine::Backlog backlog;                              // what edits that were taken in have still to do
  engine::MovingGroups groups;                          // of the tracer
  std::unique_ptr<engine::LineSolve> lineSolve;         // between rounds of a solve over lines
  std::optional<engine::LineMotion> lineMotion;         // since the last solve over lines
  engine::SceneUpdate lineEdits;                        // since the last solve over lines
  StepReport counts;                                    // counts of the update over lines that runs
  std::optional<particles::ParticleUpdate> newPaths;    // paths that the last edits have led elsewhere
  std::optional<engine::KnownSolve> known;              // of the solution before, while the next is found

  /// Whether light is exchanged by lines: an update is then a solve of the edited scene.
  bool byLines() const { return solution->settings.method == SolveMethod::Lines; }
  /// Whether by links alone, which have no rows.
  bool byPaper() const { return solution->settings.method == SolveMethod::Paper; }

  // Solving.
  SolveReport step(Progress* progress);
  void prepare(Progress* progress);
  void lineRound(Progress* progress);
  /// Once a geometry: what particles carry follows the light by itself.
  void trace();
  void countParticles();
  void round(Progress* progress);
  paper::RefineReport refineLinks(const paper::OracleSettings& oracle, Progress* progress);
  /// The mesh, but where textures show the particles.
  void subdivideForParticles();
  /// Sides whose particles textures would show by the light there is: their mesh need not. [GD01 3]
  caustics::SurfaceSides chooseTextures();
  /// Of the light in the end, as updates judge it.
  void makeTextures();
  /// Those there were, where edits have left nearly all of their particles.
  void followTextures();
  void countTextures();
  /// Gathers until the light no longer changes.
  bool settle(Progress* progress);
  /// There is no place in the trees for what was not there.
  void solveAfresh(Progress* progress);
  /// The links' transfers resolved to leaves, and settled again.
  bool resolve(const radiosity::LeafTransferSettings& settings, Progress* progress);
  /// Gathers over rows, from the light there is, until it no longer changes.
  bool settleRows(Progress* progress);
  void settleCorners();
  RgbSum directPower() const;
  // Over links alone: paper_method.cpp.
  void paperRound(Progress* progress);
  /// Returns whether light has settled; `well`: it is to be the last time.
  bool settleOverLinks(bool well, Progress* progress);
  void paperUpdate(StepReport& step, Progress* progress);
  /// How links are judged when they are as fine as the error asks for.
  paper::OracleSettings linksJudged() const;
  /// Returns the topmost links that are others now.
  std::vector<hierarchy::LinkId> judgeAnew(paper::Motion& motion, const engine::Growth& growth, StepReport& step);
  bool refineByNewLight(Progress* progress);
  /// Sums that take a walk over everything, for who looks at the report.
  void count();
  /// Those of them that dimming changes.
  void countLight();
  EnergyLedger balance();
  radiosity::LeafTransferSettings leafSettings() const {
    radiosity::LeafTransferSettings settings;
    settings.error = solution->settings.error;
    return settings;
  }

  // Updating.
  struct Motion : paper::Motion {
    engine::LightChanges light;
  };
  /// What a fresh solve would make of the edited scene, from the solution there is. [GD01 5]
  StepReport update(Progress* progress);
  /// What moves, and sides that come into the light by it.
  engine::RowWork arriveInLight(const engine::SceneUpdate& edits, Motion& motion, bool split, StepReport& step);
  /// Edits reach the scene's emission, the tracer, and the lists of what has to follow.
  void takeIn(StepReport& step, bool inMotion = false);
  /// What the solve before knows that edits leave as it was, for the next.
  void recall(const engine::SceneUpdate& edits);
  /// Whether edits have but dimmed lights, by less than would change what they count for.
  bool onlyDims(const engine::SceneUpdate& edits) const;
  /// The light over the lines there are, then: no ray is traced.
  void relightOverLines(const engine::SceneUpdate& edits);
  /// Whether a light is so much brighter than when links were refined and rows sampled that it needs its own.
  bool outshines(const engine::SceneUpdate& edits) const;
  /// Retraces particles that edits have touched: `count` of those that wait. [GD01 4]
  particles::ParticleUpdate followWithParticles(std::size_t count, StepReport& step);
  /// Where light of particles is new. It is sent on from where it lies, so the mesh must know.
  bool subdivideWhereParticlesLanded(StepReport& step);
  /// On the mesh as it is now.
  void placeParticles(const particles::ParticleUpdate& newPaths, engine::LightChanges&, StepReport& step);
  void spreadParticlesAnew(engine::LightChanges&);
  /// Elements for what the edits brought into the light.
  engine::Growth grow(const engine::SceneUpdate& edits, const particles::ParticleUpdate& newPaths, StepReport& step);
  /// Paths that were traced anew leave gaps.
  bool gapsAreMany(double most = engine::kMostGaps) const;
  void closeGaps();
  /// Makes the textures anew whose light has changed.
  void followWithTextures(StepReport& step);
  Restore apply(const Edit& edit);
  /// While the scene is still what the particles and textures are of.
  void prepareToFollow();
  /// Emission and reflectance of what stays where it was. Returns what was black and reflects now: links took it for no
  /// sender.
  std::vector<hierarchy::ElementId> relight(const engine::SceneUpdate& edits);
  /// What moves leaves its place: the links that it touches there, and the shapes of its elements.
  Motion leave(const engine::SceneUpdate& edits, StepReport& step);
  /// It comes to its new place, and what has grown in the light with it: links follow. Returns what rows have to do.
  engine::RowWork arrive(Motion& motion, const engine::Growth& growth, StepReport& step);
  /// Makes rows of these leaves anew. Returns the leaves whose rows are others.
  std::vector<hierarchy::ElementId> renewRows(const engine::RowWork& work, const radiosity::ConcernedLeaves& leaves,
                                              StepReport& step);
  /// Rows that wait from before follow all at once.
  std::vector<hierarchy::ElementId> renewWaitingRows(StepReport& step);
  /// Hands on what has changed, where light was settled before; all light otherwise.
  void settleAfter(const engine::LightChanges&, Progress* progress);
  /// What leaves fail to reflect then [W, gray].
  double settleOver(const engine::LightChanges&);
  /// Nobody traces now, and who holds the solution holds the engine's tracer.
  tracing::RayTracer& tracer() { return *std::const_pointer_cast<tracing::RayTracer>(solution->tracer); }

  // Frames of motion.
  using SecondsLeft = std::function<double()>;
  /// What fits of motion over lines.
  void frameOverLines(const SecondsLeft& left, StepReport& step);
  /// As much of an update as fits. [GD01 4.3]
  StepReport frame(double seconds);
  void countWaiting(StepReport& step) const;
  /// Links, to where things are now, and particles onto the mesh that there is then; rows wait.
  void followWithLinks(StepReport& step);
  /// Rows that wait, as many as there is time for.
  void followWithRows(const SecondsLeft& left, StepReport& step);
  /// Traces those that deposit the most anew, as many as there is time for, and carries their light along.
  void followInPart(const SecondsLeft& left, StepReport& step);
  void carryTextures(engine::TextureFlux& textures, const particles::ParticleUpdate& newPaths);
  /// Brings the particles' light to the elements, and hands on light as often as there is time for.
  void iterate(const SecondsLeft& left, StepReport& step);
  /// Gives an object a place of its own in the tracer, and makes ready what updates need to know.
  void select(const std::string& object);
};

}  // namespace deltalux
