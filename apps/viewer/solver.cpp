#include "solver.hpp"

#include <thread>

#include "solver_mail.hpp"
#include "solver_work.hpp"

namespace deltalux::viewer {

struct Solver::State {
  SolverInbox in;
  SolverOutbox out;
  std::uint64_t questions = 0;
  std::thread thread;
};

Solver::Solver(Open open, Settings settings) : state_(std::make_unique<State>()) {
  state_->thread = std::thread([state = state_.get(), open = std::move(open), settings = std::move(settings)] {
    SolverWork(state->in, state->out, settings).run(open);
  });
}

Solver::~Solver() {
  state_->out.onChange({});
  state_->in.stop();
  state_->thread.join();
}

std::uint64_t Solver::apply(std::vector<Edit> edits, bool moving) {
  return state_->in.put([&](Orders& o) {
    o.editCount += edits.size();
    o.edits.insert(o.edits.end(), std::make_move_iterator(edits.begin()), std::make_move_iterator(edits.end()));
    o.moving = moving;
    return o.editCount;
  });
}

void Solver::rest() {
  state_->in.put([](Orders& o) { o.moving = false; });
}

void Solver::select(const std::string& object) {
  state_->in.put([&](Orders& o) { o.select = object; });
}

void Solver::look(std::optional<View> view, int width, int height, std::vector<char> first) {
  state_->in.put([&](Orders& o) {
    o.look.emplace();
    if (view) o.look->emplace(Look{std::move(*view), width, height, std::move(first)});
  });
}

void Solver::want(std::vector<PixelRay> rays) {
  state_->in.put([&](Orders& o) { o.rays = std::move(rays); });
}

std::uint64_t Solver::pin(std::vector<ProbePoint> points) {
  return state_->in.put([&](Orders& o) {
    o.meters = std::move(points);
    return ++o.pinned;
  });
}

std::uint64_t Solver::ask(const ProbePoint& point, std::optional<Vec3> eye) {
  const std::uint64_t number = ++state_->questions;
  state_->in.put([&](Orders& o) { o.question = Orders::Question{number, point, eye}; });
  return number;
}

void Solver::save(const std::string& file, std::function<void(std::string)> written) {
  state_->in.put([&](Orders& o) { o.saves.push_back({file, std::move(written)}); });
}

std::vector<ProbeResult> Solver::measure(std::vector<ProbePoint> points) {
  std::promise<std::vector<ProbeResult>> promise;
  std::future<std::vector<ProbeResult>> results = promise.get_future();
  state_->in.put([&](Orders& o) { o.measurements.push_back({std::move(points), std::move(promise)}); });
  return results.get();
}

Status Solver::status() const {
  return state_->out.read([](const Findings& f) { return f.status; });
}
std::shared_ptr<const SolutionMesh> Solver::mesh() const {
  return state_->out.read([](const Findings& f) { return f.mesh; });
}
std::shared_ptr<const Picture> Solver::picture() const {
  return state_->out.read([](const Findings& f) { return f.picture; });
}
std::shared_ptr<const Readings> Solver::readings() const {
  return state_->out.read([](const Findings& f) { return f.readings; });
}
std::shared_ptr<const Answer> Solver::answer() const {
  return state_->out.read([](const Findings& f) { return f.answer; });
}
std::shared_ptr<const SampleChanges> Solver::changes() const {
  return state_->out.read([](const Findings& f) { return f.changes; });
}
std::vector<PixelSample> Solver::takeSamples() { return state_->out.takeSamples(); }
void Solver::onChange(std::function<void()> tell) { state_->out.onChange(std::move(tell)); }

}  // namespace deltalux::viewer
