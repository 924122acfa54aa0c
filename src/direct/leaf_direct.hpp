#pragma once
// Direct light of suns and lamps at a patch, by keyed shadow rays from the points of its sequence: a few at first, more
// where a light matters, more again where they disagree. What a light brings is the share of it that passes, times what
// it would bring unshadowed, which takes points but no rays: a ratio, whose error is that of the shadow alone.
// The same samples tell whether the patch is to be split.
// Lamps that may bring much, or were seen from the patch above, are asked one by one; the others are drawn from their
// tree, one a ray, and those that pilot rays find there are asked one by one as well. What the patch above has seen
// nothing of gets few rays, but never none: each lamp's light is right in the mean. Cost: 10 to 20 rays a leaf, however
// many lamps there are.
#include <functional>

#include "direct/lamp_light.hpp"
#include "direct/lamps.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::direct {

/// What is known of the points of a patch's sequence.
struct KnownPoints {
  std::uint64_t covered = 0;  // bit i: point i lies under something, and takes no light
  std::uint32_t known = 0;    // of how many that is known; those beyond count as open
};

/// Lamps that shadow rays of a patch have been shot at, and that some of them have seen: by a bit for several of them,
/// so that it takes no room. What it says may save rays, and must not decide about light.
struct LampSight {
  std::uint64_t asked = 0, seen = 0;           // lampBit, lampBits
  bool drawnAsked = false, drawnSeen = false;  // those that were drawn

  bool none() const { return asked == 0 && !drawnAsked; }
  bool missed(LightId id) const { return (asked & lampBit(id)) != 0 && (lampBits(id) & ~seen) != 0; }
};

/// All at the nominal scales of lights.
struct LeafDirect {
  Rgb E{0.0f};                  // mean over what is not covered [W/m2]
  float deviation = 0;          // standard error of it, gray [W/m2]
  float variation = 0;          // standard deviation over quadrants, gray [W/m2]
  bool tooWideForBeam = false;  // a narrow beam would fall between samples
  std::uint32_t rays = 0;
  LampSight sight;
  std::uint32_t drawn = 0;       // points, the first ones, that have asked a lamp that was drawn
  float found = 0;               // by the first rays to those that were asked, gray [W/m2]
  std::vector<LampLight> lamps;  // that were asked, or found; of what is not split: what E comes from
};

class DirectSampler {
 public:
  /// All must outlive this. `error`: relative, that shadow rays are as many as it needs.
  DirectSampler(const hierarchy::Elements&, const Scene&, const tracing::RayTracer&, const Lamps&, double error);

  /// What becomes of a patch: this will be told of its parts; it is kept as what its rays have found wants no parts; it
  /// would be kept whatever they find.
  enum class Choice : std::uint8_t { Split, Keep, Whole };
  /// By what shadow rays have found, of E their mean alone.
  using Splits = std::function<Choice(const LeafDirect&)>;
  /// Shadow rays of the same points that were traced before: those that `holds` have met what they would meet now.
  struct KnownShadows {
    std::span<const LampLight> lamps;
    std::function<bool(const Lamp&, const tracing::Ray&)> holds;
  };
  /// The light of a patch by all the samples that it is worth, unless it is split. `above`: what the patch has found
  /// that it is a part of.
  LeafDirect at(hierarchy::ElementId patch, const KnownPoints&, const LampSight& above = {}, const Splits& splits = {},
                const KnownShadows* before = nullptr) const;

  /// Whether the light of a patch is what it was when some lamps were elsewhere, by the tree of lamps of then, if the
  /// rays to those that were asked hold: none of those that moved was asked, or would be, and of such as are drawn none
  /// was found, nor is now. `moved`: by light. Adds the rays that tell.
  bool stands(hierarchy::ElementId patch, const KnownPoints&, const LampSight& above, const LeafDirect& before,
              const LampTree& treeBefore, std::span<const char> moved, std::uint64_t& rays) const;

  const Lamps& lamps() const { return lamps_; }
  using Stops = std::function<bool(const tracing::Ray&)>;
  using StopsAny = std::function<bool(const Vec3f& from)>;
  /// Whether something stops one of the shadow rays that such points of a patch shoot at a lamp. `any`: whether it may
  /// stop any ray from there to the lamp, which is soon told.
  bool anyRay(hierarchy::ElementId patch, const KnownPoints&, const LampLight& asked, const StopsAny& any,
              const Stops&) const;
  /// The same of those at lamps that are drawn.
  bool anyDrawnRay(hierarchy::ElementId patch, const KnownPoints&, const LampSight& above, std::uint32_t points,
                   const Stops&) const;

 private:
  struct Points;
  struct Tally;
  struct Asked;
  struct Drawn;
  void shoot(const Lamp&, Points&, int upTo, LampShadows&, Tally&) const;
  void shootDrawn(Points&, int upTo, Drawn&, Tally&) const;
  void ask(const Lamp&, double potential, const LampSight& above, Points&, std::vector<Asked>&) const;
  void finish(double found, Points&, Asked&) const;
  std::uint32_t askAgain(double all, Points&, Asked&) const;
  void askDrawn(const LampSight& above, double& found, Points&, Drawn&, std::vector<Asked>&) const;
  void finishDrawn(Points&, Drawn&) const;
  Rgb unshadowed(const Lamp&, Points&, int wanted) const;
  Rgb refined(const Asked&, const hierarchy::ElementGeometry&, Points&) const;

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const Lamps& lamps_;
  int lampRays_, mixedRays_, mixedSunRays_;  // mixed: where others disagree
  int openDrawn_, mixedDrawn_;
};

/// Whether direct light varies over a patch by more than its surroundings can stand, where there is about as much light
/// as `level` [W/m2, gray]; Whole: it is too small for that to matter. `meanDistance`: of its lines.
DirectSampler::Choice choiceOf(const LeafDirect&, const hierarchy::ElementGeometry&, double meanDistance, double level,
                               double error);

}  // namespace deltalux::direct
