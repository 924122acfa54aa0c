#include "solver_work.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/solution_file.hpp>

#include "scene_state.hpp"

namespace deltalux::viewer {

namespace {

using SteadyClock = std::chrono::steady_clock;

double secondsSince(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

constexpr double kSlice = 30;            // ms of the picture at rest between two looks into the inbox
constexpr double kPictureEvery = 0.2;    // s between two pictures that are shown, while they become better
constexpr std::size_t kRayBatch = 4096;  // rays between two looks into the inbox
constexpr double kUsualRounds = 3;       // of a solve: what is shown as done is of these

/// Tells how far long work is, and ends it when the solver is stopped.
class LongWork : public Progress {
 public:
  LongWork(const SolverInbox& in, std::function<void(double)> tell) : in_(in), tell_(std::move(tell)) {}
  void report(std::string_view, double fraction) override {
    constexpr double kEvery = 0.1;  // s
    if (!tell_ || secondsSince(told_) < kEvery) return;
    told_ = SteadyClock::now();
    tell_(fraction);
  }
  bool stopRequested() const override { return in_.stopped(); }

 private:
  const SolverInbox& in_;
  std::function<void(double)> tell_;
  SteadyClock::time_point told_ = SteadyClock::now();
};

/// Ends a slice of work as soon as there is something more urgent.
class Interruptible : public Progress {
 public:
  explicit Interruptible(const SolverInbox& in) : in_(in) {}
  void report(std::string_view, double) override {}
  bool stopRequested() const override { return in_.filled() || in_.stopped(); }

 private:
  const SolverInbox& in_;
};

/// Whether solving has come to its end: the ledger is drawn up then.
bool isSolved(const SolveReport& report) { return report.converged || report.energy.emittedW; }

bool sameLook(const std::optional<Look>& a, const std::optional<Look>& b) {
  if (!a || !b) return !a && !b;
  const View &v = a->view, &w = b->view;
  return a->width == b->width && a->height == b->height && v.kind == w.kind && v.position == w.position &&
         v.direction == w.direction && v.up == w.up && v.horizontal == w.horizontal && v.vertical == w.vertical;
}

}  // namespace

void SolverWork::run(const Solver::Open& open) {
  try {
    openAndSolve(open);
    serve();
  } catch (const Interrupted&) {
  } catch (const std::exception& error) {
    fail(error.what());
  }
  // Nobody waits for what will not come.
  for (;;) {
    picture_.reset();
    for (Orders::Measurement& m : measurements_)
      m.results.set_exception(std::make_exception_ptr(std::runtime_error("the solver has stopped")));
    for (const Orders::Save& s : saves_) s.written("the solver has stopped");
    measurements_.clear(), saves_.clear();
    if (in_.stopped() && !in_.filled()) return;
    receive(true);
  }
}

void SolverWork::fail(const std::string& message) {
  status_.phase = Phase::Failed;
  status_.message = message;
  out_.publish([&](Findings& f) { f.status = status_; });
}

// Before there is anything to edit.

void SolverWork::openAndSolve(const Solver::Open& open) {
  LongWork opening(in_, [&](double fraction) {
    status_.fraction = fraction;
    out_.publish([&](Findings& f) { f.status = status_; });
  });
  engine_ = open(opening);
  status_.fraction = 0;
  const SolveReport first = engine_->solution().report();
  bool solved = isSolved(first);
  if (first.counts.elements > 0 || solved) reader_.emplace(engine_->solution());
  int rounds = 0;
  LongWork solving(in_, [&](double fraction) {
    status_.fraction = std::min(0.99, (rounds + 0.5 * fraction) / kUsualRounds);
    out_.publish([&](Findings& f) { f.status = status_; });
  });
  while (!solved) {
    status_.phase = Phase::Solving;
    out_.publish([&](Findings& f) { f.status = status_; });
    solved = isSolved(engine_->step(&solving));
    ++rounds;
    if (!solved) {
      receive(false);
      if (!edits_.empty()) status_.message = fmt::format("{} edits wait until the scene is solved", edits_.size());
      publish();
    }
  }
  if (!edits_.empty()) status_.message.clear();
  status_.phase = Phase::Settled;
  status_.fraction = 1;
  publish();
  emitted_ = engine_->solution().report().energy.emittedW.value_or(0);
}

// The loop.

void SolverWork::serve() {
  while (!in_.stopped()) {
    const bool busy =
        !edits_.empty() || (unsettled_ && !moving_) || movesOn() || !rays_.empty() || question_ ||
        (!lightIsOld() && (!metersAreExact_ || pictureWaits() || !saves_.empty() || !measurements_.empty()));
    receive(!busy);
    takeEdits();
    if (unsettled_) moving_ ? frame() : settle();
    if (!rays_.empty()) trace();
    if (question_) {
      answer();
    } else if (!lightIsOld()) {
      if (!measurements_.empty())
        measure();
      else if (!metersAreExact_)
        readMeters(true);
      else if (!saves_.empty())
        save();
      else if (pictureWaits())
        improvePicture();
    }
  }
}

void SolverWork::receive(bool wait) {
  Orders orders = in_.take(wait);
  edits_.insert(edits_.end(), std::make_move_iterator(orders.edits.begin()),
                std::make_move_iterator(orders.edits.end()));
  editCount_ = orders.editCount;
  if (orders.moving) moving_ = *orders.moving;
  if (orders.settings) settings_ = *orders.settings, picture_.reset(), pictureDone_ = false;
  if (orders.select && engine_ && status_.phase != Phase::Solving && status_.phase != Phase::Failed)
    engine_->select(*orders.select);
  if (orders.rays) rays_ = std::move(*orders.rays);
  if (orders.meters) {
    meters_ = std::move(*orders.meters), pinned_ = orders.pinned;
    if (reader_) readMeters(false);
  }
  if (orders.question) question_ = orders.question;
  if (orders.look) {
    if (!sameLook(*orders.look, look_)) picture_.reset(), pictureDone_ = false;
    look_ = std::move(*orders.look);
  }
  std::move(orders.saves.begin(), orders.saves.end(), std::back_inserter(saves_));
  std::move(orders.measurements.begin(), orders.measurements.end(), std::back_inserter(measurements_));
}

// Light that follows edits.

/// A drag held still: frames go on until they have nothing left to do.
bool SolverWork::movesOn() const { return moving_ && unsettled_ && deferred_; }

void SolverWork::takeEdits() {
  if (edits_.empty()) return;
  picture_.reset(), pictureDone_ = false;
  status_.message.clear();
  for (std::size_t i = 0; i < edits_.size(); ++i) {
    // Of positions of a drag that wait together the last one counts.
    const auto *now = std::get_if<Restore>(&edits_[i]),
               *next = i + 1 < edits_.size() ? std::get_if<Restore>(&edits_[i + 1]) : nullptr;
    if (now && next && covers(*next, *now)) continue;
    try {
      engine_->apply(edits_[i]);
      unsettled_ = deferred_ = true;
    } catch (const InputError& error) {
      status_.message = error.what();
    }
  }
  edits_.clear();
  status_.edits = editCount_;
  if (!unsettled_) out_.publish([&](Findings& f) { f.status = status_; });
}

void SolverWork::frame() {
  if (!deferred_) return;
  picture_.reset(), pictureDone_ = false;
  status_.phase = Phase::Moving;
  status_.step = engine_->frame(settings_.frameMs * settings_.motionShare);
  deferred_ = status_.step.deferred > 0;
  status_.staleShare = emitted_ > 0 ? std::clamp(status_.step.staleW.value_or(0) / emitted_, 0.0, 1.0) : 0;
  publish();
}

void SolverWork::settle() {
  picture_.reset(), pictureDone_ = false;
  status_.phase = Phase::Settling;
  out_.publish([&](Findings& f) { f.status = status_; });
  const auto start = SteadyClock::now();
  LongWork work(in_, {});
  status_.step = engine_->update(&work);
  status_.settleSeconds = secondsSince(start);
  status_.phase = Phase::Settled;
  status_.staleShare = 0;
  unsettled_ = deferred_ = false;
  publish();
  emitted_ = engine_->solution().report().energy.emittedW.value_or(0);
}

void SolverWork::publish() {
  picture_.reset(), pictureDone_ = false;
  if (reader_)
    reader_->refresh();
  else
    reader_.emplace(engine_->solution());
  auto mesh = std::make_shared<const SolutionMesh>(reader_->mesh());
  out_.publish([&](Findings& f) {
    f.status = status_;
    f.mesh = std::move(mesh);
    f.changes = reader_->changes();
  });
  readMeters(false);
}

// Questions about it.

void SolverWork::trace() {
  const auto start = SteadyClock::now();
  do {
    const std::size_t count = std::min(kRayBatch, rays_.size());
    const std::vector<PixelSample> found = reader_->trace(std::span(rays_).first(count));
    rays_.erase(rays_.begin(), rays_.begin() + static_cast<std::ptrdiff_t>(count));
    out_.publish([&](Findings& f) { f.samples.insert(f.samples.end(), found.begin(), found.end()); });
  } while (!rays_.empty() && !in_.filled() && 1e3 * secondsSince(start) < settings_.frameMs);
}

void SolverWork::answer() {
  const Orders::Question asked = *std::exchange(question_, std::nullopt);
  Answer answer{asked.number, reader_->version(), {}, {}, {}};
  answer.reading = reader_->probe(std::vector{asked.point}).front();
  if (asked.eye) {
    const PixelRay ray{Vec3f(*asked.eye), Vec3f(glm::normalize(asked.point.position - *asked.eye)), 0, 0};
    answer.radiance = reader_->trace(std::span(&ray, 1)).front().radiance;
  }
  answer.contributions = reader_->contributions(asked.point);
  out_.publish([&](Findings& f) { f.answer = std::make_shared<const Answer>(std::move(answer)); });
}

void SolverWork::readMeters(bool exact) {
  metersAreExact_ = exact || meters_.empty();
  if (meters_.empty()) return;
  ProbeSettings settings;
  settings.mesh = !exact;
  auto readings =
      std::make_shared<const Readings>(Readings{reader_->version(), pinned_, exact, reader_->probe(meters_, settings)});
  out_.publish([&](Findings& f) { f.readings = std::move(readings); });
}

void SolverWork::measure() {
  Orders::Measurement m = std::move(measurements_.front());
  measurements_.erase(measurements_.begin());
  m.results.set_value(reader_->probe(m.points));
}

void SolverWork::save() {
  const Orders::Save order = std::move(saves_.front());
  saves_.erase(saves_.begin());
  std::string problem;
  try {
    saveSolution(order.file, engine_->solution());
  } catch (const OutputError& error) {
    problem = error.what();
  }
  order.written(problem);
}

// The picture at rest.

bool SolverWork::pictureWaits() const {
  return look_ && look_->width > 0 && look_->height > 0 && !lightIsOld() && !pictureDone_;
}

void SolverWork::improvePicture() {
  if (!picture_) {
    RenderSettings settings = settings_.picture;
    settings.width = look_->width, settings.height = look_->height;
    picture_.emplace(*reader_, look_->view, settings, look_->first);
    pictureShown_ = SteadyClock::now();
  }
  const Interruptible until(in_);
  pictureDone_ = picture_->step(kSlice, &until);
  if (!pictureDone_ && secondsSince(pictureShown_) < kPictureEvery) return;
  pictureShown_ = SteadyClock::now();
  auto shown = std::make_shared<Picture>();
  shown->view = look_->view;
  shown->version = reader_->version();
  shown->image = picture_->image();
  shown->rays.assign(picture_->rays().begin(), picture_->rays().end());
  shown->done = pictureDone_;
  if (pictureDone_) picture_.reset();
  out_.publish([&](Findings& f) { f.picture = std::move(shown); });
}

}  // namespace deltalux::viewer
