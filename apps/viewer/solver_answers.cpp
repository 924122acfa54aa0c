// What the solver's thread answers between edits: rays, questions, meters, and the picture that is looked at.
#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/solution_file.hpp>
#include <utility>

#include "solver_work.hpp"

namespace deltalux::viewer {

namespace {

constexpr double kSlice = 30;            // ms of the picture at rest between two looks into the inbox
constexpr double kPictureEvery = 0.2;    // s between two pictures that are shown, while they become better
constexpr std::size_t kRayBatch = 4096;  // rays between two looks into the inbox

/// Ends a slice of work as soon as there is something more urgent.
class Interruptible : public Progress {
 public:
  explicit Interruptible(const SolverInbox& in) : in_(in) {}
  void report(std::string_view, double) override {}
  bool stopRequested() const override { return in_.filled() || in_.stopped(); }

 private:
  const SolverInbox& in_;
};

}  // namespace

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
