#pragma once
#include <atomic>
#include <deltalux/engine.hpp>
#include <deltalux/light_groups.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_reader.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "edits.hpp"

namespace deltalux::python {

/// deltalux.Solution: an engine, and what is read from it. Any number of threads may call it: those that read share it,
/// those that change it have it to themselves. Calls wait for each other; make them without the interpreter's lock.
class SolutionHandle {
 public:
  explicit SolutionHandle(Engine engine, std::size_t threads = 0) : engine_(std::move(engine)), threads_(threads) {}

  std::size_t threads() const { return threads_; }
  /// Of the solution, from 1; another number, another solution.
  std::uint64_t version() const { return version_; }
  /// An update was interrupted, and the solution is that of no scene: finish() makes it one. Until then reading throws.
  bool unfinished() const { return unfinished_; }

  /// Calls `read(view)` while nobody changes the solution. Throws std::runtime_error when it is unfinished.
  template <class Read>
  auto read(const Read& read) const {
    const std::shared_lock lock(mutex_);
    requireFinished();
    return read(view_);
  }

  /// A list for edits of the solution as it is.
  std::unique_ptr<EditList> edit() const;
  /// Applies the edits that the engine has not yet, and updates. Throws Interrupted: unfinished().
  StepReport update(EditList&, Progress&);
  /// Applies them, and shows as much as fits into the time.
  StepReport frame(EditList&, double milliseconds, Progress&);
  /// Takes back what frames have applied. Throws Interrupted: unfinished().
  void takeBack(EditList&, Progress&);
  /// After an interrupted update: solves the scene as it is now from scratch. Does nothing otherwise.
  void finish(Progress&);

  /// The solution as triangles, as it is now; snapshots share what has not changed.
  SolutionMesh mesh();

 private:
  void requireFinished() const;
  void applyTo(EditList&);
  StepReport updateEngine(Progress&);
  void changed();

  mutable std::shared_mutex mutex_;
  Engine engine_;
  SolutionView view_ = engine_.solution();
  std::optional<SolutionReader> reader_;  // once a mesh is asked for
  bool readerIsStale_ = false;
  std::size_t threads_;
  std::atomic<std::uint64_t> version_{1};
  std::atomic<bool> unfinished_{false};
};

}  // namespace deltalux::python
