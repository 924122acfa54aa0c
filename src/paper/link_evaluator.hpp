#pragma once
// What one link of the tree comes to: its kernel, its visibility, by proof or by rays, and whether an end of it is to
// be split (oracle.hpp). Links are evaluated side by side from frozen elements; nothing is changed here.
//
// Proofs need lists of blockers, which cost more than a few rays: where the ends saw each other before, or those of the
// parent do, rays come first, and lists only where none or all pass, or where links below will ask for them.
#include "hierarchy/link.hpp"
#include "paper/blockers.hpp"
#include "paper/oracle.hpp"
#include "paper/visibility.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::paper {

enum class Split : std::uint8_t { None, Receiver, Sender, Both };

/// Blockers of one link in a list of those of many.
struct BlockerRange {
  std::uint32_t begin = 0, count = 0;
};

struct Evaluation {
  hierarchy::Link link;  // as evaluated
  Split split = Split::None;
  BlockerRange blockers;  // of the link, where they were asked for
  bool refined = false;   // as the link was before, it would be refined today
  std::uint16_t rays = 0;
};

/// What may stand between the ends of a link, and where its own blockers are appended.
struct Candidates {
  const hierarchy::ElementId* parents;  // blockers of the parent
  std::size_t count;
  Blockers& own;
};

class LinkEvaluator {
 public:
  /// All must outlive this.
  LinkEvaluator(const hierarchy::Elements& elements, const Scene& scene, const tracing::RayTracer& tracer,
                const OracleSettings& settings)
      : elements_(elements), scene_(scene), tracer_(tracer), oracle_(elements, settings) {}

  /// A link as the tree has it. `parentSaw`: some ray between the parent's ends passed.
  Evaluation evaluate(const hierarchy::Link&, bool parentSaw, const Candidates&) const;
  /// One of which an end has moved, or holds what has.
  Evaluation evaluateMoved(const hierarchy::Link& before, const Candidates&) const;
  /// One between whose ends something has moved: its kernel stands, and so do its samples but for `rays`, by bits.
  Evaluation evaluateBetween(const hierarchy::Link& before, std::uint32_t rays, const Candidates&) const;
  /// One on the way to others.
  Evaluation pass(const hierarchy::Link&, const Candidates&) const;
  /// The same, whose blockers are the parent's for now.
  Evaluation passUnseen(const hierarchy::Link&, const Candidates&) const;

  /// Whether the link, as it stands, would be split.
  bool splits(hierarchy::Link) const;
  /// Whether an active link, as it stands, errs by more than its budget or wants more samples.
  bool unrefined(const hierarchy::Link&) const;

 private:
  class OwnBlockers;

  /// Gives a link its kernel; false when that is all: no light passes, or the ends overlap.
  bool couple(hierarchy::Link&, const Candidates&, Evaluation&) const;
  /// Visibility by proof and by rays, `least` at least, and what follows from it.
  void see(hierarchy::Link&, int least, bool saw, const Candidates&, Evaluation&) const;
  bool solidEnds(const hierarchy::Link&) const;
  void proveBlocked(hierarchy::Link&, OwnBlockers&) const;
  bool sends(hierarchy::ElementId sender) const;
  int wantedSamples(const hierarchy::Link&, const LinkError&) const;
  void look(hierarchy::Link&, int least, VisibilitySamples&) const;
  Split splitOverlapping(const hierarchy::Link&) const;
  Split choose(const hierarchy::Link&) const;
  bool senderDivisible(hierarchy::ElementId sender) const;
  bool worthSplitting(const hierarchy::Link&, bool divisible) const;
  Split prefer(const hierarchy::Link&) const;
  bool isSun(hierarchy::ElementId) const;

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  Oracle oracle_;
};

}  // namespace deltalux::paper
