#include <deltalux/error.hpp>
#include <mutex>
#include <ranges>
#include <stdexcept>

#include "solution.hpp"

namespace deltalux::python {

namespace {
const char* const kUnfinished =
    "an update of this solution was interrupted: call finish(), which solves its scene again";
const char* const kOverlap =
    "the solution has changed since this edit block began: blocks of one solution cannot overlap";
}  // namespace

void SolutionHandle::requireFinished() const {
  if (unfinished_) throw std::runtime_error(kUnfinished);
}

std::unique_ptr<EditList> SolutionHandle::edit() const {
  return read([this](const SolutionView& view) { return std::make_unique<EditList>(view.scene(), version_); });
}

void SolutionHandle::applyTo(EditList& list) {
  requireFinished();
  if (list.version() != version_) throw std::runtime_error(kOverlap);
  const std::size_t before = list.applied.size();
  try {
    while (list.applied.size() < list.edits().size())
      list.applied.push_back(engine_.apply(list.edits()[list.applied.size()]));
  } catch (...) {
    for (; list.applied.size() > before; list.applied.pop_back()) engine_.apply(list.applied.back());
    throw;
  }
}

void SolutionHandle::changed() {
  view_ = engine_.solution();
  readerIsStale_ = true;
  ++version_;
}

StepReport SolutionHandle::updateEngine(Progress& progress) {
  unfinished_ = true;
  const StepReport report = engine_.update(&progress);
  unfinished_ = false;
  changed();
  return report;
}

StepReport SolutionHandle::update(EditList& list, Progress& progress) {
  const std::unique_lock lock(mutex_);
  applyTo(list);
  return updateEngine(progress);
}

StepReport SolutionHandle::frame(EditList& list, double milliseconds, Progress& progress) {
  const std::unique_lock lock(mutex_);
  for (std::size_t i = list.applied.size(); i < list.edits().size(); ++i)
    if (const auto* move = std::get_if<TransformObject>(&list.edits()[i]);
        move && list.selected.insert(move->object).second)
      engine_.select(move->object);
  applyTo(list);
  const StepReport report = engine_.frame(milliseconds, &progress);
  changed();
  list.follow(version_);
  return report;
}

void SolutionHandle::takeBack(EditList& list, Progress& progress) {
  const std::unique_lock lock(mutex_);
  if (unfinished_ || list.applied.empty()) return;
  for (const Restore& restore : std::views::reverse(list.applied)) engine_.apply(restore);
  updateEngine(progress);
}

void SolutionHandle::finish(Progress& progress) {
  const std::unique_lock lock(mutex_);
  if (!unfinished_) return;
  Engine fresh(view_.scene(), view_.settings());
  fresh.solve(&progress);
  const std::uint64_t meshes = reader_ ? reader_->version() : 0;
  reader_.reset();
  engine_ = std::move(fresh);
  unfinished_ = false;
  changed();
  if (meshes == 0) return;
  reader_.emplace(view_);
  while (reader_->version() < meshes) reader_->refresh();  // their numbers go on
}

SolutionMesh SolutionHandle::mesh() {
  const std::unique_lock lock(mutex_);
  requireFinished();
  if (!reader_)
    reader_.emplace(view_);
  else if (readerIsStale_)
    reader_->refresh();
  readerIsStale_ = false;
  return reader_->mesh();
}

}  // namespace deltalux::python
