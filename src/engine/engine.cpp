#include <deltalux/engine.hpp>
#include <deltalux/error.hpp>
#include <utility>

#include "base/check.hpp"
#include "engine/state.hpp"
#include "hierarchy/input_level.hpp"
#include "scene/diffuse_only.hpp"

namespace deltalux {

Engine::Engine(Scene scene, SolveSettings settings) : state_(std::make_unique<State>()) {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the target error is a fraction between 0 and 1");
  DELTALUX_CHECK(settings.reemittedShare > 0 && settings.reemittedShare <= 1, "a share of links, above 0 and up to 1");
  addAreaLights(scene);
  if (settings.diffuseOnly) scene::dropSpeculars(scene);
  validate(scene);
  DELTALUX_CHECK(!settings.byLight || settings.method == SolveMethod::Lines, "light is kept apart over lines alone");
  Solution& s = *state_->solution;
  s.scene = std::move(scene);
  s.settings = std::move(settings);
  state_->standBy();
  s.tracer = tracing::makeEmbreeTracer(s.scene);
}

Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;
Engine& Engine::operator=(Engine&&) noexcept = default;

SolveReport Engine::step(Progress* progress) { return state_->step(progress); }

SolveReport Engine::preview(Progress* progress) {
  state_->previewed = true;
  return state_->step(progress);
}

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
    state_->solution->tracer = tracing::makeEmbreeTracer(state_->solution->scene);
  }
  const Solution& s = *state_->solution;
  state_->finished = !s.lines.empty() || s.links.size() > 0 || s.elements.size() == 0;
  state_->prepareToFollow();
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

void Engine::forget() {
  state_->solution->memory.reset(), state_->lineMotion.reset();
  state_->transfer.reset(), state_->textureUpdate.reset(), state_->incremental.reset(), state_->tracing.reset();
  state_->lists.reset();
}

EnergyLedger Engine::balance() const { return state_->balance(); }

SolutionView Engine::solution() const {
  if (!state_->counted) state_->count();
  return SolutionView(state_->solution);
}

}  // namespace deltalux
