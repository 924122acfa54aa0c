#pragma once
// The last round: the links' transfers resolved to leaf patches. Every leaf gets a row: what each light brings it
// (direct_sampler.hpp) and what it receives from other leaves
// (indirect_sampler.hpp). Rows are linear in lights and reflectances, so gathering over them, however often, needs no
// ray.
//
// Where direct light varies over a leaf by more than the error allows, the leaf is split first: its own samples tell,
// so shadow edges and the scallops of lamps are found where they are, not where links might have them.
// Cost: about 64 + 128 rays a leaf; 16 bytes a transfer.
#include <span>

#include "hierarchy/link.hpp"
#include "radiosity/leaf_row.hpp"
#include "radiosity/line_space.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

struct LeafTransferSettings {
  double error = 0.05;   // target relative error of irradiance
  double variation = 2;  // of direct light over a leaf that is let stand, relative to `error`
  double scale = 0.15;   // of the mean free path: side of the area that variation is weighed against, as in the oracle
  double finest = 1.0;   // least area of a leaf that is still split: finest * error * that area
  int shadowRays = 64;   // of a leaf
  int gatherRays = 128;  // of a leaf
};

struct LeafTransferReport {
  std::uint64_t rays = 0, split = 0;
};

struct LeafUpdateReport {
  std::uint64_t rays = 0, split = 0;
  std::uint64_t examined = 0, direct = 0, indirect = 0;  // leaves; whose rows were made anew, in part or whole
};

/// What one leaf receives from lights, and from leaves.
struct LeafRow {
  ElementId leaf;
  TransferRow direct, indirect;
};

class LeafTransfers {
 public:
  /// Samples the rows of all receiving leaves; splits leaves of `elements` where direct light varies. The links' state
  /// and the present radiosities say where light comes from.
  LeafTransferReport build(Elements& elements, const Links&, const Scene&, const RayTracer&,
                           const LeafTransferSettings&);

  /// Makes those rows anew, or parts of them, that a move of geometry can have changed: rows of leaves that moved or
  /// are new, terms over links that have changed, terms whose rays meet what moved. `changed`: topmost changed links.
  LeafUpdateReport update(Elements&, const Links&, const Scene&, const RayTracer&, const LeafTransferSettings&,
                          const LinkMarks&, std::span<const LinkId> changed, const SpaceChange&);

  bool empty() const { return rows_.empty(); }
  std::size_t memoryBytes() const;

  /// Fills `direct` of the leaves from the present B of emitters.
  void gatherDirect(Elements&) const;
  /// Fills `indirect` of the leaves from the present B of leaves.
  void gatherIndirect(Elements&) const;

  /// Checks that rows are those of receiving leaves, each once, from leaves and emitters that exist, by transfers that
  /// are finite and not negative. Throws std::logic_error with the first violation.
  void validate(const Elements&, const Links&) const;

 private:
  friend struct StoredTransfers;  // solution files

  /// Samples direct rows of `fresh`, splitting leaves where light varies; calls keep(leaf, row) with each that stays.
  template <class Keep>
  void sampleDirect(std::vector<ElementId> fresh, Elements&, const Links&, const Scene&, const RayTracer&,
                    const LeafTransferSettings&, LeafTransferReport&, const Keep&);

  std::vector<LeafRow> rows_;  // one a leaf
};

}  // namespace deltalux
