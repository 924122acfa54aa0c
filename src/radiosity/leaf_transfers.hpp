#pragma once
// The last round: the links' transfers resolved to leaf patches. Every leaf gets a row: what each light brings it
// (direct_sampler.hpp) and what it receives from other leaves
// (indirect_sampler.hpp). Rows are linear in lights and reflectances, so gathering over them, however often, needs no
// ray.
//
// Where direct light varies over a leaf by more than the error allows, the leaf is split first: its own samples tell,
// so shadow edges and the scallops of lamps are found where they are, not where links might have them.
// Cost: about 64 + 128 rays a leaf, more where there are few leaves; 16 bytes a transfer. Rows of a moved scene:
// row_update.cpp.
#include <span>

#include "hierarchy/link.hpp"
#include "paper/line_space.hpp"
#include "radiosity/direct_rows.hpp"
#include "radiosity/gather_rays.hpp"
#include "radiosity/leaf_row.hpp"
#include "radiosity/row_surplus.hpp"
#include "radiosity/surface_reaches.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::io {
struct StoredTransfers;
}

namespace deltalux::radiosity {

struct LeafTransferReport {
  std::uint64_t rays = 0, split = 0;
};

struct LeafUpdateReport {
  std::uint64_t rays = 0, split = 0;
  std::vector<hierarchy::ElementId> leaves;  // whose rows are others, by id; direct light and all above is up to date
};

/// Leaves whose rows may have to be made anew.
struct ConcernedLeaves {
  std::vector<hierarchy::ElementId> byLights, byLeaves;  // whose direct row, whose indirect row, in the order of ids
};

/// What one leaf receives from lights, and from leaves.
struct LeafRow {
  hierarchy::ElementId leaf;
  TransferRow direct, indirect;
};

class LeafTransfers {
 public:
  /// Samples the rows of all receiving leaves; splits leaves of `elements` where direct light varies. The links' state
  /// and the present radiosities say where light comes from.
  LeafTransferReport build(hierarchy::Elements& elements, const hierarchy::Links&, const Scene&,
                           const tracing::RayTracer&, const LeafTransferSettings&);

  /// Which rows a move of geometry can have changed: of leaves that moved or are new, of those below receivers of
  /// changed links, and those whose rays meet what moved, or lead to it. Rows of patches that are leaves no more are
  /// dropped. `changed`: topmost changed links.
  ConcernedLeaves concerned(const hierarchy::Elements&, const hierarchy::Links&,
                            std::span<const hierarchy::LinkId> changed, const paper::SpaceChange&);
  /// Makes the rows of these leaves anew, or the terms of them over links that have changed or whose rays meet what
  /// moved. Other rows stand as they are; their turn may come in a later call, also after further moves, when `marks`,
  /// `changed` and `space` are those of all moves since.
  LeafUpdateReport update(hierarchy::Elements&, const hierarchy::Links&, const Scene&, const tracing::RayTracer&,
                          const LeafTransferSettings&, const paper::LinkMarks&,
                          std::span<const hierarchy::LinkId> changed, const paper::SpaceChange&,
                          const ConcernedLeaves&);

  bool empty() const { return rows_.empty(); }
  std::span<const LeafRow> rows() const { return rows_; }
  /// Those that have rows, in their order.
  std::vector<hierarchy::ElementId> leaves() const;
  /// The row of a leaf; null when it has none.
  const LeafRow* find(hierarchy::ElementId leaf) const {
    return leaf.index() < rowOf_.size() && rowOf_[leaf.index()] != kNone ? &rows_[rowOf_[leaf.index()]] : nullptr;
  }
  /// Lists which row is whose, and what they reach, anew.
  void listRows(const hierarchy::Elements&, const Scene&);
  std::size_t memoryBytes() const;

  /// Fills `direct` of the leaves from the present B of emitters.
  void gatherDirect(hierarchy::Elements&) const;
  /// Fills `indirect` of the leaves from the present B of leaves.
  void gatherIndirect(hierarchy::Elements&) const;
  /// Fills those of the leaf of one row; B by element. Indirect: without its share of what others have too much of.
  void gatherDirect(const LeafRow&, hierarchy::Elements&) const;
  void gatherIndirect(const LeafRow&, hierarchy::Elements&, const std::vector<Rgb>& B) const;
  const RowSurplus& surplus() const { return surplus_; }
  /// Takes in that surfaces below these reflect otherwise. Adds the leaves that are to be gathered anew by that.
  void followReflectance(const hierarchy::Elements&, std::span<const hierarchy::ElementId> painted,
                         std::vector<hierarchy::ElementId>& leaves);

  /// Checks that rows are those of receiving leaves, each once, from leaves and emitters that exist, by transfers that
  /// are finite and not negative. Throws std::logic_error with the first violation.
  void validate(const hierarchy::Elements&, const hierarchy::Links&) const;

 private:
  friend struct io::StoredTransfers;  // solution files

  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Change;
  void updateDirect(hierarchy::Elements&, const Change&, std::span<const hierarchy::ElementId> leaves,
                    LeafUpdateReport&);
  void updateIndirect(const hierarchy::Elements&, const Change&, std::span<const hierarchy::ElementId> leaves,
                      LeafUpdateReport&, std::vector<hierarchy::ElementId>& reaching);
  void dropNoLeaves(const hierarchy::Elements&, std::span<const hierarchy::ElementId> inputs);
  void measure(const LeafRow&, const hierarchy::Elements&, const Scene&);
  void setRow(hierarchy::ElementId leaf, std::size_t row);
  const TransferRow* inheritance(const hierarchy::Elements&, hierarchy::ElementId leaf,
                                 const paper::SpaceChange&) const;

  std::vector<LeafRow> rows_;  // one a leaf
  MeanLeaf mean_;              // when they were built
  // These follow from the rows.
  std::vector<std::uint32_t> rowOf_;  // by element: index of its row, or none
  std::size_t known_ = 0;             // elements before this one that want rows have them, or have been listed as such
  SurfaceReaches reaches_;
  RowSurplus surplus_;
  /// Of a leaf that is one no more.
  struct Dropped {
    hierarchy::ElementId leaf;
    TransferRow indirect;
  };
  std::vector<Dropped> dropped_;  // since the last update; what they were split into takes over their rays
};

}  // namespace deltalux::radiosity
