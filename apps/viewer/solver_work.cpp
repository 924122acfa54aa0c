#include "solver_work.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <limits>

#include "camera.hpp"
#include "scene_state.hpp"

namespace deltalux::viewer {

namespace {

constexpr double kUsualRounds = 3;  // of a solve: what is shown as done is of these
constexpr double kRest = 0.3;       // after which work begins that would keep the next edit waiting [s]

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

/// Gives this thread, and those that it starts for its work, what the window leaves of the processor: on two cores
/// pictures would come when the light has time for them. It is a courtesy: refused, it does without.
void yieldToTheWindow() {
  constexpr int kNice = 15;
  static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice));
}

/// Whether solving has come to its end: the ledger is drawn up then.
bool isSolved(const SolveReport& report) { return report.converged || report.energy.emittedW; }

bool sameLook(const std::optional<Look>& a, const std::optional<Look>& b) {
  if (!a || !b) return !a && !b;
  return a->width == b->width && a->height == b->height && sameView(a->view, b->view);
}

}  // namespace

void SolverWork::run(const Solver::Open& open) {
  yieldToTheWindow();
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
    receive(std::numeric_limits<double>::infinity());
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
    const bool nothingYet = rounds == 0 && !reader_;
    solved = isSolved(nothingYet ? engine_->preview(&solving) : engine_->step(&solving));
    ++rounds;
    if (!solved) {
      receive(0);
      if (!edits_.empty()) status_.message = fmt::format("{} edits wait until the scene is solved", edits_.size());
      publish(Reading::Exact);
    }
  }
  if (!edits_.empty()) status_.message.clear();
  status_.phase = Phase::Settled;
  status_.fraction = 1;
  publish(Reading::Exact);
  emitted_ = engine_->solution().report().energy.emittedW.value_or(0);
}

// The loop.

void SolverWork::serve() {
  while (!in_.stopped()) {
    receive(patience());
    prepareSelected();
    takeEdits();
    if (unsettled_) moving_ ? frame() : settle();
    if (!rays_.empty()) trace();
    if (question_) {
      answer();
    } else if (!lightIsOld()) {
      if (!status_.exact && (rests() || !measurements_.empty()))
        publish(Reading::Exact);
      else if (!measurements_.empty())
        measure();
      else if (!saves_.empty())
        save();
      else if (status_.exact && !metersAreExact_)
        readMeters(true);
      else if (status_.exact && pictureWaits())
        improvePicture();
    }
  }
}

double SolverWork::patience() const {
  constexpr double kForEver = std::numeric_limits<double>::infinity();
  if (!edits_.empty() || select_ || (unsettled_ && !moving_) || movesOn() || !rays_.empty() || question_) return 0;
  if (lightIsOld()) return kForEver;
  if (!saves_.empty() || !measurements_.empty()) return 0;
  if (!status_.exact) return std::max(kRest - secondsSince(published_), 0.0);
  return !metersAreExact_ || pictureWaits() ? 0 : kForEver;
}

bool SolverWork::rests() const { return secondsSince(published_) >= kRest; }

void SolverWork::receive(double patience) {
  Orders orders = in_.take(patience);
  edits_.insert(edits_.end(), std::make_move_iterator(orders.edits.begin()),
                std::make_move_iterator(orders.edits.end()));
  editCount_ = orders.editCount;
  if (orders.moving) moving_ = *orders.moving;
  if (orders.select) select_ = std::move(orders.select);
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

void SolverWork::prepareSelected() {
  if (select_) engine_->select(*std::exchange(select_, std::nullopt));
}

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
  publish(Reading::Shown);
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
  publish(Reading::Shown);
  emitted_ = engine_->solution().report().energy.emittedW.value_or(0);
}

void SolverWork::publish(Reading reading) {
  picture_.reset(), pictureDone_ = false;
  status_.exact = reading == Reading::Exact;
  if (reader_)
    reader_->refresh(status_.exact ? 0.0f : SolutionReader::kVisibleStep);
  else
    reader_.emplace(engine_->solution());
  auto mesh = std::make_shared<const SolutionMesh>(reader_->mesh());
  out_.publish([&](Findings& f) {
    f.status = status_;
    f.mesh = std::move(mesh);
    f.changes = reader_->changes();
  });
  published_ = SteadyClock::now();
  readMeters(false);
}

}  // namespace deltalux::viewer
