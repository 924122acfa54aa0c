#pragma once
// What a solve over lines has found, kept for the next: an update is a solve of the edited scene that asks here first.
// What is found here is what it would find itself, so that both end at the same bits.
#include "change/known_samples.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

class KnownSolve {
 public:
  /// What edits have left of the lights.
  struct Lights {
    bool stay = true;  // all of them are where they were, and none has come or gone
    bool same = true;  // they count for what they did as well: where lamps are drawn, one decides about rays to all
  };
  /// Of the solution that there was, out of which elements and lines are taken.
  KnownSolve(SolveMemory, Solution&, change::MovedSpace, Lights);

  /// Nothing is known where the extent of the scene is another, by which its scales are measured.
  void holdTo(const hierarchy::Elements&);
  /// Walks for light from a side that are what they would be now, or nothing.
  lines::LightWalks* walks(const hierarchy::Elements&, hierarchy::ElementId side);
  /// Takes sides of hollows that have opened or closed for moved: lines into them count otherwise.
  void moveOpened(const hierarchy::Elements&, const std::vector<char>& enclosed);

  /// The parts of patches that were split before, which are what they were where they do not move.
  hierarchy::KnownParts* parts(const hierarchy::Elements&, std::span<const hierarchy::ElementId> patches);
  /// Takes what is known of a patch's surroundings; false where that may have changed.
  bool takeScale(const hierarchy::Elements&, const Scene&, hierarchy::ElementId, PatchSamples& to);
  /// Direct light without a choice, likewise, to be taken; nullptr.
  std::unique_ptr<WholeLight> takeWhole(const hierarchy::Elements&, const direct::DirectSampler&, hierarchy::ElementId,
                                        const lines::LeafScale&, const direct::LampSight& above);
  /// What the memory has of it, so that whoever stays with the choice takes it.
  struct Evaluated {
    std::unique_ptr<EvaluatedLight>* how = nullptr;
    direct::LeafDirect* light = nullptr;
  };
  /// With one.
  Evaluated evaluated(const hierarchy::Elements&, const direct::DirectSampler&, hierarchy::ElementId,
                      const lines::LeafScale&, const direct::LampSight& above);
  /// Direct light from those points of a leaf, likewise; nullptr.
  const direct::DimDirect* dim(const hierarchy::Elements&, const direct::Lamps&, hierarchy::ElementId leaf,
                               std::uint64_t points);
  /// Light of a leaf by way of others as it was; nullopt where it was none [W/m2].
  std::optional<Rgb> indirect(const hierarchy::Elements&, hierarchy::ElementId leaf) const;
  /// The lines, as they are now; once.
  std::optional<lines::KnownLines> takeLines(const hierarchy::Elements&, const hierarchy::LeafTable&);
  /// Sky light of a leaf, that had that number, if it follows from what has that key; nullptr, and what is known of its
  /// rays.
  const direct::SkyAtLeaf* sky(const hierarchy::Elements&, hierarchy::ElementId leaf, std::uint32_t before,
                               const direct::SkyKey&, std::span<direct::SkyRay>) const;
  std::span<const lines::LineCode> skyRays(std::uint32_t before) const;
  const lines::Exchange* exchange() const { return memory_.exchange.get(); }

 private:
  /// The element there was for a patch that is where it was, by index; kNone. Found by its key where nobody has
  /// followed it from the patch above.
  std::uint32_t find(const hierarchy::Elements&, hierarchy::ElementId) const;
  /// By leaf: the number that it had where it stands, or kNone.
  std::vector<std::uint32_t> leavesBefore(const hierarchy::Elements&, const hierarchy::LeafTable&) const;
  std::uint32_t findPart(const hierarchy::Elements&, hierarchy::ElementId) const;
  /// The same where its light was asked for from the same points.
  std::uint32_t findLit(const hierarchy::Elements&, hierarchy::ElementId, const lines::LeafScale&) const;

  /// change::lampsThrough() of a patch: out of those of the patch that it is a part of.
  std::uint64_t through(const hierarchy::Elements&, const direct::Lamps&, hierarchy::ElementId);

  static constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
  SolveMemory memory_;
  hierarchy::Elements elements_;
  hierarchy::LeafTable leaves_;
  lines::Lines lines_;
  change::MovedSpace space_;
  Lights lights_;
  bool holds_ = true;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> byKey_;  // ascending
  hierarchy::KnownParts parts_;                                 // followed from patch to patch
  std::vector<std::uint64_t> through_;                          // by element: through(), where it was asked; kUnasked
};

}  // namespace deltalux::engine
