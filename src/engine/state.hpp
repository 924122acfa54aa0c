#pragma once
// What an engine holds between calls, and its three ways to get on: it solves (solving.cpp), takes edits in whole
// (updating.cpp), or shows them frame by frame, as far as time goes (frames.cpp).
#include <deltalux/engine.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/freed_memory.hpp"
#include "caustics/texture_update.hpp"
#include "engine/clock.hpp"
#include "engine/growth.hpp"
#include "engine/line_motion.hpp"
#include "engine/line_solve.hpp"
#include "engine/moving_groups.hpp"
#include "engine/scene_update.hpp"
#include "engine/time_budget.hpp"
#include "paper/incremental_particles.hpp"
#include "paper/refine.hpp"
#include "paper/update.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/transfer.hpp"
#include "solution/solution.hpp"

namespace deltalux {

struct Engine::State {
  std::shared_ptr<Solution> solution = std::make_shared<Solution>();
  bool finished = false;   // the last round has run
  bool previewed = false;  // over lines, the coarse solution is to be shown first
  engine::Clock clock;
  engine::TimeBudget budget{0};
  engine::SceneUpdate pending;                           // edits since the last update or frame
  engine::SceneUpdate waiting;                           // edits that frames have seen, and no update yet
  std::optional<particles::ParticleTracing> tracing;     // knows the scene that the particles are of
  std::optional<particles::ParticleTransfer> transfer;   // of the particles, on the mesh
  std::optional<caustics::TextureUpdate> textureUpdate;  // of the textures, once there are edits
  std::optional<particles::ParticleUpdate> newPaths;     // paths that the last edits have led elsewhere
  engine::MovingGroups groups;                           // of the tracer
  bool counted = true;                                   // the report is of the solution as it is
  bool updated = false;                                  // since it was solved: its balance waits until it is asked for
  // Over lines.
  std::unique_ptr<engine::LineSolve> lineSolve;  // between rounds of a solve
  std::optional<engine::LineMotion> lineMotion;  // since the last solve
  std::optional<engine::KnownSolve> known;       // of the solution before, while the next is found
  StepReport counts;                             // of the update that runs
  FreedMemory freed;                             // by updates
  // Over links.
  std::optional<paper::IncrementalParticles> incremental;  // of the particles, once there are edits
  std::optional<paper::IrradianceLists> lists;             // of light that has converged, once there are edits
  double nextError = 0;                                    // of the next round
  bool curtailed = false;                                  // fewer particles than the error asks for: there was no time
  RgbSum residual{0.0};                                    // power that the last iteration changed

  /// Whether light is exchanged by lines: an update is then a solve of the edited scene.
  bool byLines() const { return solution->settings.method == SolveMethod::Lines; }

  // Solving.
  SolveReport step(Progress* progress);
  void lineRound(Progress* progress);
  void countParticles();
  /// Of the light in the end, as updates evaluate it.
  void makeTextures();
  /// Those there were, where edits have left nearly all of their particles.
  void followTextures(StepReport& step);
  void countTextures();
  /// There is no place in the trees for what was not there.
  void solveAfresh(Progress* progress);
  /// Sums that take a walk over everything, for who looks at the report.
  void count();
  EnergyLedger balance();

  // Solving over links: paper_solve.cpp.
  void paperRound(Progress* progress);
  void prepare(Progress* progress);
  /// Once a geometry: what particles carry follows the light by itself.
  void trace();
  paper::RefineReport refineLinks(const paper::OracleSettings& oracle, Progress* progress);
  /// Sides whose particles textures would show by the light there is: their mesh need not. [GD01 3]
  caustics::SurfaceSides chooseTextures();
  /// Returns whether light has converged; `well`: it is to be the last time.
  bool iterateOverLinks(bool well, Progress* progress);
  /// The same over what edits have changed [GD01 5]; `changed`: elements that are others.
  void iterateOverLists(std::span<const hierarchy::ElementId> changed);
  /// How links are evaluated when they are as fine as the error asks for.
  paper::OracleSettings linkSettings() const { return paper::oracleSettingsFor(solution->settings.error); }

  // Updating.
  Restore apply(const Edit& edit);
  /// Lights that are to be switched on without a ray are sampled as if they were on.
  void standBy();
  /// While the scene is still what the particles and textures are of.
  void prepareToFollow();
  /// What a fresh solve would make of the edited scene, from the solution there is. [GD01 5]
  StepReport update(Progress* progress);
  /// Edits wait for the next update from now on.
  void takeIn(StepReport& step);
  /// What the solve before knows that edits leave as it was, for the next.
  void recall(const engine::SceneUpdate& edits);
  /// Of edits that have but dimmed lights, where the light of each group is kept apart: what each is multiplied by.
  std::optional<std::vector<Rgb>> weightsAlone(const engine::SceneUpdate& edits) const;
  /// Of edits that have but dimmed lights, by less than would change what they count for; nullopt of others.
  std::optional<engine::Dimming> dimmingAlone(const engine::SceneUpdate& edits) const;
  /// Takes such edits in: `light` writes the light of the elements, and no ray is traced.
  void dim(const engine::SceneUpdate& edits, const std::function<void()>& light);
  /// The light over the lines there are.
  void relightOverLines(const engine::Dimming&);
  /// Retraces particles that edits have touched. [GD01 4]
  particles::ParticleUpdate followWithParticles(const SceneChange&, StepReport& step);
  /// Paths that were traced anew leave gaps.
  bool gapsAreMany() const;
  void closeGaps();

  // Updating over links: paper_update.cpp.
  /// `share`: of the particle links that edits affect, which is emitted again; 1 ends what frames have left.
  void paperUpdate(const engine::SceneUpdate& edits, double share, StepReport& step, Progress* progress);
  /// Re-emits links of particles as wholes. [GD01 4.2]
  particles::ParticleUpdate reemitParticles(const SceneChange& change, double share, StepReport& step);
  /// Whether a light is so much brighter than when links were refined that they, and particles, are too few for it.
  bool outshines(const engine::SceneUpdate& edits) const;
  /// Emission and reflectance of what stays where it was. What is painted is appended to `painted`; what was black and
  /// reflects now to `reflecting`: links took it for no sender.
  void relight(const engine::SceneUpdate& edits, std::vector<hierarchy::ElementId>& painted,
               std::vector<hierarchy::ElementId>& reflecting);
  /// Where light of particles is new. It is sent on from where it lies, so the mesh must know.
  void subdivideForDeposits(const particles::ParticleUpdate& deposited);
  /// Elements for what the edits brought into the light.
  engine::Growth grow(const engine::SceneUpdate& edits, const particles::ParticleUpdate& newPaths, StepReport& step);
  /// Links of what has moved, grown or been reactivated.
  void evaluateAgain(paper::LinkMarks marks, const engine::Growth& growth, StepReport& step);
  /// On the mesh as it is now, of which these patches reflect otherwise, or are others.
  void placeParticles(const particles::ParticleUpdate& newPaths, std::span<const hierarchy::ElementId> changed);
  /// Of surfaces whose particles have changed. [GD01 4]
  void followPaperTextures(const particles::ParticleUpdate& newPaths, StepReport& step);
  /// Links that err by more than they may where more light has come; returns whether there are more now.
  bool refineByNewLight(Progress* progress);

  /// Nobody traces now, and who holds the solution holds the engine's tracer.
  tracing::RayTracer& tracer() { return *std::const_pointer_cast<tracing::RayTracer>(solution->tracer); }

  // Frames of motion.
  using SecondsLeft = std::function<double()>;
  /// A part of an update: over lines shadows, as far as time goes; over links all but the particles of most affected
  /// links. [GD01 4.3]
  StepReport frame(double seconds);
  void followWithShareOfLinks(const engine::SceneUpdate& now, StepReport& step);
  void followWithShadows(const engine::SceneUpdate& now, const SecondsLeft& left, StepReport& step);
  /// Gives an object a place of its own in the tracer, and makes ready what updates need to know.
  void select(const std::string& object);
};

}  // namespace deltalux
