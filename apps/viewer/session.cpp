#include "session.hpp"

#include <algorithm>
#include <deltalux/error.hpp>
#include <stdexcept>
#include <utility>

#include "lamps.hpp"
#include "scene_state.hpp"

namespace deltalux::viewer {

namespace {

void requireSession(bool condition, const char* message) {
  if (!condition) throw std::logic_error(message);
}

}  // namespace

Session::Session(Scene scene, Recording start, std::filesystem::path record)
    : scene_(std::move(scene)), recording_(std::move(start)), file_(std::move(record)) {
  write();
}

Edit Session::apply(const Edit& edit) {
  endGesture();
  const Edit done = takeStep(edit, ++steps_);
  recording_.steps.emplace_back(edit);
  write();
  return done;
}

Edit Session::takeStep(const Edit& edit, std::uint64_t number) {
  AppliedEdit applied = applyEdit(scene_, edit);
  undo_.push_back({number, edit, std::move(applied.inverse)});
  redo_.clear();
  return edit;
}

// Dragging.

void Session::beginDrag(const std::string& object) {
  endGesture();
  drag_ = Drag{object, Mat4(1.0), std::nullopt, 0};
  try {
    validateEdit(scene_, dragEdit(Mat4(1.0)));
  } catch (...) {
    drag_.reset();
    throw;
  }
}

Edit Session::dragEdit(const Mat4& fromStart) const {
  if (!findObjects(scene_, drag_->object).empty()) return TransformObject{drag_->object, fromStart};
  Vec3 offset(0);
  if (const auto lights = findLights(scene_, drag_->object); !lights.empty())
    if (const std::optional<Vec3> place = placeOf(scene_, lights.front())) {
      const Vec3 inFiles = *place + scene_.origin;
      offset = Vec3(fromStart * glm::dvec4(inFiles, 1)) - inFiles;
    }
  return MoveLight{drag_->object, offset};
}

std::vector<Edit> Session::dragTo(const Mat4& fromStart) {
  requireSession(drag_.has_value(), "nothing is dragged");
  if (!drag_->before) {
    drag_->materials = scene_.materials.size();
    const Edit edit = dragEdit(fromStart);
    drag_->before = applyEdit(scene_, edit).inverse;
    drag_->now = fromStart;
    return {edit};
  }
  // From where the drag began every time: where the object is does not depend on the way there, and the one step of the
  // record leads to the same numbers.
  const Restore now = presentState(scene_, *drag_->before);
  applyEdit(scene_, *drag_->before);
  try {
    std::vector<Edit> edits = moveDragged(fromStart);
    drag_->now = fromStart;
    return edits;
  } catch (const InputError&) {
    applyEdit(scene_, now);
    throw;
  }
}

std::vector<Edit> Session::moveDragged(const Mat4& fromStart) {
  if (fromStart == Mat4(1.0)) return {*drag_->before};
  const Edit edit = dragEdit(fromStart);
  const std::size_t known = scene_.materials.size();
  applyEdit(scene_, edit);
  Restore there = presentState(scene_, *drag_->before);
  // Emission with a direction turns in materials that every move makes for itself: those that the drag has made already
  // take the values of these, so that it makes no more of them than one step does.
  const std::size_t first = drag_->materials;
  if (scene_.materials.size() - known > known - first) {
    drag_->materials = known;
    return {*drag_->before, edit};
  }
  for (Restore::PrimitiveState& state : there.primitives)
    if (state.material.index() >= known) state.material = MaterialId(state.material.index() - known + first);
  for (std::size_t i = known; i < scene_.materials.size(); ++i)
    there.materials.push_back({MaterialId(i - known + first), scene_.materials[i]});
  if (!there.materials.empty()) applyEdit(scene_, there);
  scene_.materials.resize(known);
  return {there};
}

void Session::endDrag() {
  if (!drag_) return;
  const Drag drag = *drag_;
  const Edit edit = dragEdit(drag.now);
  drag_.reset();
  if (!drag.before || drag.now == Mat4(1.0)) return;
  undo_.push_back({++steps_, edit, *drag.before});
  redo_.clear();
  recording_.steps.emplace_back(edit);
  write();
}

void Session::endGesture() {
  if (drag_) endDrag();
  if (adjust_) endAdjust();
}

// Values under the hand.

std::vector<Edit> Session::adjust(const Edit& edit) {
  if (drag_) endDrag();
  if (!adjust_) {
    Restore before = applyEdit(scene_, edit).inverse;
    adjust_ = Adjust{edit, std::move(before)};
    return {edit};
  }
  const Restore now = presentState(scene_, adjust_->before);
  applyEdit(scene_, adjust_->before);
  try {
    Restore before = applyEdit(scene_, edit).inverse;
    std::vector<Edit> edits{adjust_->before, edit};
    adjust_ = Adjust{edit, std::move(before)};
    return edits;
  } catch (const InputError&) {
    applyEdit(scene_, now);
    throw;
  }
}

void Session::endAdjust() {
  if (!adjust_) return;
  undo_.push_back({++steps_, adjust_->edit, adjust_->before});
  redo_.clear();
  recording_.steps.emplace_back(adjust_->edit);
  adjust_.reset();
  write();
}

// Back and forth.

Edit Session::stepBack() {
  Step step = std::move(undo_.back());
  undo_.pop_back();
  const Edit back = step.inverse;
  Restore forth = applyEdit(scene_, back).inverse;
  redo_.push_back({std::move(step), std::move(forth)});
  recording_.steps.emplace_back(Undo{});
  return back;
}

Edit Session::stepForth() {
  Undone undone = std::move(redo_.back());
  redo_.pop_back();
  const Edit forth = std::move(undone.forth);
  applyEdit(scene_, forth);
  undo_.push_back(std::move(undone.step));
  recording_.steps.emplace_back(Redo{});
  return forth;
}

Edit Session::undo() {
  endGesture();
  requireSession(canUndo(), "there is nothing to undo");
  const Edit edit = stepBack();
  write();
  return edit;
}

Edit Session::redo() {
  endGesture();
  requireSession(canRedo(), "there is nothing to redo");
  const Edit edit = stepForth();
  write();
  return edit;
}

// Stored states.

void Session::store(std::size_t slot, std::string name, std::shared_ptr<const SolutionMesh> mesh) {
  endGesture();
  if (stored_.size() <= slot) stored_.resize(slot + 1);
  stored_[slot] = Stored{std::move(name), std::move(mesh), undo_};
}

std::vector<Edit> Session::restore(std::size_t slot) {
  requireSession(slot < stored_.size() && stored_[slot], "nothing is stored there");
  endGesture();
  const std::vector<Step>& wanted = stored_[slot]->steps;
  std::size_t common = 0;
  while (common < std::min(wanted.size(), undo_.size()) && wanted[common].number == undo_[common].number) ++common;
  std::vector<Edit> edits;
  while (undo_.size() > common) edits.push_back(stepBack());
  for (std::size_t i = common; i < wanted.size(); ++i) {
    if (!redo_.empty() && redo_.back().step.number == wanted[i].number) {
      edits.push_back(stepForth());
    } else {
      // The same step on the same state: it cannot be refused, and leads to the same numbers.
      edits.push_back(takeStep(wanted[i].edit, wanted[i].number));
      recording_.steps.emplace_back(wanted[i].edit);
    }
  }
  write();
  return edits;
}

void Session::write() {
  recordProblem_.clear();
  if (file_.empty()) return;
  try {
    saveRecording(file_, recording_);
  } catch (const OutputError& error) {
    recordProblem_ = error.what();
  }
}

}  // namespace deltalux::viewer
