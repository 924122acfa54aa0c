#pragma once
// Rows that have to follow a move of geometry, in slices: links follow in one step, the rows of leaves below them wait
// here, those with the most light near what moved first, and are made anew as many at a time as there is time for.
// [GD01 4.3] Links may follow again while rows wait: these then look for what any of the moves did.
//
// Leaves that moved, or have no row yet, do not wait: they would be dark, or trace rays from where they no longer are.
#include <algorithm>

#include "radiosity/leaf_transfers.hpp"

namespace deltalux::engine {

/// What a move of geometry asks of rows, once links have followed it.
struct RowWork {
  paper::LinkMarks marks;
  std::vector<hierarchy::LinkId> changed;  // topmost
  paper::SpaceChange space;
  radiosity::ConcernedLeaves leaves;
};

class RowQueue {
 public:
  /// Adds the work of a move, of links as they are now. `stale`: light that is another when all rows have followed,
  /// gray [W, with the scene's unit squared as area].
  void add(RowWork, const radiosity::LeafTransfers&, const hierarchy::Elements&, const hierarchy::Links&, double stale);

  bool empty() const { return waiting_.empty(); }
  /// Moves whose rows wait.
  int moves() const { return moves_; }
  std::size_t size() const { return waiting_.size(); }
  /// Of the light that is another, what still waits.
  double stale() const { return light_ > 0 ? stale_ * std::max(waitingLight_, 0.0) / light_ : 0.0; }

  /// The leaves that cannot wait.
  const radiosity::ConcernedLeaves& urgent() const { return urgent_; }
  /// Takes `count` of those that wait out, the brightest ones. Patches that are leaves no more are passed over.
  radiosity::ConcernedLeaves take(std::size_t count, const hierarchy::Elements&);
  /// Of all moves whose rows wait.
  const RowWork& work() const { return work_; }

 private:
  struct Waiting {
    hierarchy::ElementId leaf;
    bool byLights = false, byLeaves = false;
    double light = 0;
  };

  void addWork(RowWork, const hierarchy::Links&);
  void add(const radiosity::ConcernedLeaves&, const std::vector<char>& urgent, const hierarchy::Elements&);

  RowWork work_;
  radiosity::ConcernedLeaves urgent_;
  std::vector<Waiting> waiting_;  // the brightest last
  int moves_ = 0;
  double stale_ = 0, light_ = 0, waitingLight_ = 0;
};

}  // namespace deltalux::engine
