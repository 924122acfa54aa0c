// Frames: what is new, what is drawn, what is asked for next.
#include "controller.hpp"

#include <algorithm>
#include <deltalux/error.hpp>
#include <utility>

#include "frame_lines.hpp"
#include "scene_state.hpp"

namespace deltalux::viewer {

namespace {

bool sameStatus(const Status& a, const Status& b) {
  return a.phase == b.phase && a.fraction == b.fraction && a.staleShare == b.staleShare && a.message == b.message &&
         a.edits == b.edits && a.settleSeconds == b.settleSeconds;
}

/// The pointer that `now` is, if it is another than `before`.
template <class T>
bool takeNewer(std::shared_ptr<const T>& before, std::shared_ptr<const T> now) {
  if (!now || now == before) return false;
  before = std::move(now);
  return true;
}

/// The placement of a primitive, from its rest shape to the scene.
Mat4 placementOf(const Scene& scene, PrimitiveId id) {
  Restore one;
  one.primitives.push_back({id, {}, Mat4(1.0), true});
  return presentState(scene, one).primitives.front().matrix;
}

}  // namespace

Controller::Controller(Source source, Solver::Settings settings) : source_(std::move(source)) {
  solver_ = std::make_unique<Solver>(std::exchange(source_.open, {}), settings);
}

bool Controller::takeChanges() {
  // The status first: what it says of edits is then true of the mesh that is taken next.
  const Status status = solver_->status();
  bool changed = !sameStatus(status, status_);
  if (!status.message.empty() && status.phase != Phase::Solving && status.message != status_.message)
    lastError = status.message;
  status_ = status;
  std::shared_ptr<const SolutionMesh> mesh = solver_->mesh();
  const bool otherMesh = mesh && mesh != mesh_;
  if (takeNewer(changes_, solver_->changes()) && changes_) cache_.retire(*changes_), changed = true;
  if (otherMesh) takeMesh(std::move(mesh)), changed = true;
  const std::vector<PixelSample> samples = solver_->takeSamples();
  raysOut_ -= std::min(raysOut_, samples.size());
  if (!samples.empty()) {
    std::vector<PixelSample> good;
    std::copy_if(samples.begin(), samples.end(), std::back_inserter(good),
                 [&](const PixelSample& s) { return !changes_ || !changes_->stale(s); });
    cache_.insert(good);
    changed = true;
  }
  changed |= takeNewer(picture_, solver_->picture());
  if (takeNewer(readings_, solver_->readings())) takeReadings(*readings_), changed = true;
  if (takeNewer(answer_, solver_->answer())) takeAnswer(*answer_), changed = true;
  if (settled() && status_.exact)
    for (int slot = 0; slot < 2; ++slot)
      if (std::exchange(storedEarly_[static_cast<std::size_t>(slot)], false)) store(slot);
  if (session_) askNext();
  return changed;
}

void Controller::takeMesh(std::shared_ptr<const SolutionMesh> mesh) {
  mesh_ = std::move(mesh);
  pick_.follow(mesh_);
  stillRequests_ = 0;
  if (!session_) begin();
  // What was answered is of the light before.
  cursorQuestion_.answered = explainQuestion_.answered = false;
  const bool exact =
      readings_ && readings_->pinned == pinned_ && readings_->exact && readings_->version >= mesh_->version;
  for (Probe& p : probes_) p.exact = exact;
  if (field_) field_->exact = exact;
  if (cursorAt_) lookUnderCursor();
}

void Controller::begin() {
  const Scene& scene = *mesh_->scene;
  session_ = std::make_unique<Session>(scene, source_.recording ? source_.recording() : Recording{}, source_.record);
  lastError = session_->recordProblem();
  for (std::size_t i = 0; i < scene.views.size() && i + 1 < bookmarks_.size(); ++i)
    if (!bookmarks_[i + 1]) bookmarks_[i + 1] = scene.views[i];
  View view = scene.views.empty() ? firstView(scene) : scene.views.front();
  if (source_.view) view = inScene(scene, *source_.view);
  setCamera(view);
  drawnCamera_ = camera_;
}

bool Controller::settled() const {
  return ready() && status_.phase == Phase::Settled && status_.edits == editsSent_ && resting_;
}

bool Controller::finished() const {
  const bool wanted = draw_.picture && width_ > 0 && height_ > 0;
  return settled() && (!wanted || (pictureFits() && picture_->done));
}

bool Controller::pictureFits() const {
  return picture_ && mesh_ && picture_->version == mesh_->version && sameView(picture_->view, camera_) &&
         picture_->image.width == width_ && picture_->image.height == height_;
}

// Looking.

void Controller::setCamera(const View& view) {
  const View before = std::exchange(camera_, fitted(view, width_, height_));
  if (!sameView(before, camera_)) lookUnderCursor();
}

void Controller::setSize(int width, int height) {
  width_ = width, height_ = height;
  setCamera(camera_);
}

void Controller::bookmark(int slot) { bookmarks_.at(static_cast<std::size_t>(slot)) = camera_; }

bool Controller::goToBookmark(int slot) {
  const std::optional<View>& view = bookmarks_.at(static_cast<std::size_t>(slot));
  if (view) setCamera(*view);
  return view.has_value();
}

void Controller::focusOnSelection() {
  if (!ready()) return;
  Box box;
  for (const PrimitiveId p : selectedPrimitives())
    if (const Box own = bounds(scene()[p].shape); !own.empty()) box.extend(own);
  View view = camera_;
  if (box.empty()) box = bounds(scene());
  focus(view, box);
  // Not from behind what stands between: a wall.
  const Vec3 outwards = glm::normalize(view.position - box.center());
  const double radius = 0.5 * box.diagonal(), distance = glm::length(view.position - box.center());
  constexpr double kBefore = 0.95;  // of the way to it
  if (const auto hit = pick_.first(box.center() + radius * outwards, outwards, std::nullopt))
    if (radius + hit->surface.distance < distance)
      view.position = box.center() + (radius + kBefore * hit->surface.distance) * outwards;
  setCamera(view);
}

void Controller::wantExposureFrom(const Image& radiance) {
  exposureWanted_ = false;
  draw_.tone.ev = automaticEv(radiance);
}

// Drawing.

Frame Controller::frame() const {
  Frame frame;
  frame.camera = camera_;
  frame.width = width_, frame.height = height_;
  frame.settings = draw_;
  if (!ready()) return frame;
  frame.mesh = mesh_;
  if (compared_ >= 0) {
    frame.other = storedAt(compared_)->mesh;
    frame.wipe = wipe_;
  }
  frame.ahead = ahead();
  if (draw_.picture && pictureFits() && !frame.ahead) frame.picture = picture_;
  frame.selection = selectedPrimitives();
  if (explainQuestion_.point && explanation_)
    addExplanation(frame.lines, scene(), *explainQuestion_.point, *explanation_, draw_.overlays.particles);
  constexpr double kMeterSize = 0.1;  // m
  for (const Probe& probe : probes_) addMeter(frame.lines, probe.point, kMeterSize / scene().metresPerUnit);
  if (field_) addField(frame.lines, *field_);
  return frame;
}

/// Where the session has what was moved last, as seen from where the mesh has it: the difference is what the solver has
/// not followed yet.
std::optional<Ahead> Controller::ahead() const {
  if (handMoved_.empty() || !mesh_) return std::nullopt;
  constexpr double kRounding = 1e-9;
  std::optional<Mat4> difference;
  Ahead ahead;
  for (const PrimitiveId p : handMoved_) {
    if (p.index() >= mesh_->scene->primitives.size()) return std::nullopt;
    const Mat4 now = placementOf(scene(), p), seen = placementOf(*mesh_->scene, p);
    if (now == seen) continue;
    const Mat4 matrix = now * glm::inverse(seen);
    if (!difference) difference = matrix;
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r)
        if (std::abs(matrix[c][r] - (*difference)[c][r]) > kRounding * (1 + std::abs(matrix[c][r])))
          return std::nullopt;  // no one map: they wait for the light
    ahead.primitives.push_back(p);
  }
  if (!difference) return std::nullopt;
  ahead.matrix = glm::mat4(*difference);
  return ahead;
}

/// Where the camera will be by the time rays that are asked for now are back, if it goes on as it does [WDG02].
View Controller::predicted() const {
  constexpr double kFramesAhead = 2.5;
  View next = camera_;
  next.position += kFramesAhead * (camera_.position - drawnCamera_.position);
  const Vec3 direction = glm::normalize(camera_.direction), before = glm::normalize(drawnCamera_.direction);
  const Vec3 ahead = direction + kFramesAhead * (direction - before);
  const Vec3 sideways = glm::cross(ahead, camera_.up);
  if (glm::length(sideways) > 1e-3) next.direction = ahead;
  return next;
}

void Controller::drawn(const std::vector<char>& specular) {
  if (!ready() || width_ <= 0 || height_ <= 0) return;
  const bool moves = !sameView(camera_, drawnCamera_);
  if (moves) stillRequests_ = 0;
  // Once nothing moves, the picture takes over after the cache has had its rays.
  constexpr int kStillRequests = 12;
  constexpr std::size_t kShare = 8;  // of the pixels get a ray a frame, one in so many
  const bool specularSeen = std::find(specular.begin(), specular.end(), 1) != specular.end();
  const bool mayAsk = moves || (raysOut_ == 0 && stillRequests_ < kStillRequests);
  if (draw_.cache && specularSeen && mayAsk && !(pictureFits() && picture_->done)) {
    ++stillRequests_;
    const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    std::vector<PixelRay> rays = cache_.wanted(pixels / kShare, predicted());
    raysOut_ = rays.size();
    if (!rays.empty()) solver_->want(std::move(rays));
  }
  if (draw_.picture && (!looking_ || moves || !pictureFits()))
    solver_->look(camera_, width_, height_, specular);
  else if (!draw_.picture && looking_)
    solver_->look(std::nullopt, 0, 0, {});
  looking_ = draw_.picture;
  drawnCamera_ = camera_;
}

}  // namespace deltalux::viewer
