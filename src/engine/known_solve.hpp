#pragma once
// What a solve over lines has found, kept for the next: an update is a solve of the edited scene that asks here first.
// What is found here is what it would find itself, so that both end at the same bits. What is known of patches stays
// where it is, by element; the elements are those there were, wherever they can be.
#include <functional>

#include "change/known_samples.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

/// What edits have left of a scene.
struct EditedScene {
  change::MovedSpace space;
  std::vector<PrimitiveId> moved;
  std::vector<MaterialId> painted;
  std::vector<LightId> relit;     // lights that are elsewhere, or send another power
  bool stands = true;             // surfaces and lights are elsewhere, at most: none has come or gone
  bool lightsStay = true;         // all lights are where they were, and none has come or gone
  bool sameLights = true;         // none has come or gone, wherever they are
  std::vector<char> movedLights;  // by light: those that are not where they were
  bool lightsSame = true;         // they count for what they did, wherever they are
  const particles::ParticleUpdate* retraced = nullptr;  // particles that have followed; null: all may be others
};

class KnownSolve {
 public:
  /// Of the solution that there was, out of which elements and lines are taken. The transfer is of its particles.
  KnownSolve(SolveMemory, Solution&, EditedScene, std::optional<particles::ParticleTransfer>);

  /// The elements there were, folded, and brought to the scene as it is now; or such as `build` makes, with what of
  /// those they have in common, where surfaces have come or gone. Nothing is known where the extent of the scene is
  /// another, by which its scales are measured.
  hierarchy::Elements takeMesh(const Scene&, const std::function<hierarchy::Elements()>& build);
  /// By element of that: samples from before, walks for light, and whether no light came there.
  PatchSamples takeSamples() { return std::move(memory_.samples); }
  std::vector<lines::LightWalks> takeWalks() { return std::move(memory_.walks); }
  particles::Details takeDetails(const hierarchy::Elements&, const particles::Particles&);
  /// Where particles lay on the elements and on their input level, to be followed to where they are; nothing where all
  /// may be others.
  std::optional<particles::ParticleTransfer> takeTransfer() { return std::exchange(transfer_, {}); }
  std::optional<particles::ParticleTransfer> takeCoarseTransfer() { return std::move(memory_.coarseTransfer); }
  const particles::ParticleUpdate& retraced() const { return *followed_; }

  /// Whether walks for light from a side run where they would now.
  bool holdsWalks(const hierarchy::Elements&, hierarchy::ElementId side, const lines::LightWalks&) const;
  /// By light, those that are elsewhere than they knew; empty for none.
  std::span<const char> movedLights() const { return edits_.lightsStay ? std::span<const char>() : edits_.movedLights; }
  /// Takes sides of hollows that have opened or closed for moved: lines into them count otherwise.
  void moveOpened(const hierarchy::Elements&, const std::vector<char>& enclosed);
  /// The same of what is known of a patch's surroundings.
  bool holdsScale(const hierarchy::Elements&, const Scene&, hierarchy::ElementId, const lines::FirstLines&) const;
  /// Of its direct light, found by rays that came to `light`, and knew of lamps what is above. Adds the rays that tell.
  bool holdsLight(const hierarchy::Elements&, const direct::DirectSampler&, hierarchy::ElementId,
                  const lines::LeafScale&, const direct::LampSight& before, const direct::LampSight& above,
                  const direct::LeafDirect& light, std::uint64_t& rays);
  /// Which of its shadow rays are, however its light may differ; empty where none is known to be.
  std::function<bool(const direct::Lamp&, const tracing::Ray&)> shadowsThatHold(const hierarchy::Elements&,
                                                                                const direct::Lamps&,
                                                                                hierarchy::ElementId);
  /// Direct light from those points of a leaf, likewise; nullptr.
  const direct::DimDirect* dim(const hierarchy::Elements&, const Scene&, const direct::Lamps&,
                               hierarchy::ElementId leaf, std::uint64_t key, std::span<const std::uint32_t> points);
  /// Light of a leaf by way of others as it was; nullopt where it was none [W/m2].
  std::optional<Rgb> indirect(const hierarchy::Elements&, hierarchy::ElementId leaf) const;
  /// The lines there were, and what they are worth; once. The same of the input level.
  std::optional<lines::KnownLines> takeLines(const hierarchy::Elements&, lines::TracedLines&);
  std::optional<lines::KnownLines> takeCoarseLines(const hierarchy::Elements&, lines::TracedLines&);
  /// Sky light by element; of leaves whose number before is known it is what it was.
  KnownSky takeSky() { return std::move(memory_.sky); }
  KnownSky takeCoarseSky() { return std::move(memory_.coarse.sky); }
  /// Tells what of a leaf's shadow rays to the sky is as it was. Returns whether all are.
  bool holdSkyRays(const hierarchy::Elements&, hierarchy::ElementId leaf, const LeafSky&,
                   std::span<direct::SkyRay>) const;
  /// What was exchanged over the lines; once.
  std::unique_ptr<lines::Exchange> takeExchange() { return std::move(memory_.exchange); }

 private:
  /// Whether a patch was there, and is where it was.
  bool known(const hierarchy::Elements&, hierarchy::ElementId) const;
  /// By element: whether it is a leaf that was one, as `wasLeaf` says, where it stands.
  std::vector<char> standing(const hierarchy::Elements&, const std::vector<char>& wasLeaf) const;
  /// What is kept by element, by where elements are now. `was`: which each was before, or kNone.
  void renumber(const std::vector<std::uint32_t>& was);
  /// change::lampsThrough() of a patch: out of those of the patch that it is a part of.
  std::uint64_t through(const hierarchy::Elements&, const direct::Lamps&, hierarchy::ElementId);

  static constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
  SolveMemory memory_;
  hierarchy::Elements elements_;  // until they are taken
  std::vector<char> there_;       // by element: whether it was there
  std::vector<char> wasLeaf_;     // by element: whether it was a receiving leaf
  std::vector<Rgb> indirect_;     // by element
  lines::TracedLines lines_;
  EditedScene edits_;
  const particles::ParticleUpdate* followed_;  // null: nothing is known of particles
  std::optional<particles::ParticleTransfer> transfer_;
  bool holds_ = true;
  std::vector<std::uint64_t> through_;  // by element: through(), where it was asked; kUnasked
};

}  // namespace deltalux::engine
