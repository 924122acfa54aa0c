#pragma once
// Particles as one more sparse transfer: E(receiver) = sum of T B(sender), senders being leaf patches and lights. Made
// once a mesh; every iteration then costs a multiplication per pair of sender and receiver that particles connect, and
// no ray. The one writer of ElementLight::particle. [GD01 2.1, "placed at an appropriate level in the hierarchy"]; at
// which: spread_levels.hpp
//
// Retraced paths, and those whose ends lie on patches that were split, are taken out and put in one by one; levels are
// chosen anew surface by surface.
// Cost: to build, about 0.3 microseconds an impact; to follow, that for what is retraced, and some nanoseconds a path
// where elements were split.
#include "particles/particle_tracing.hpp"
#include "particles/spread_levels.hpp"

namespace deltalux::hierarchy {

class SideLocator;

}  // namespace deltalux::hierarchy

namespace deltalux::particles {

class ParticleTransfer {
 public:
  /// Finds where the particles start and land on today's mesh.
  ParticleTransfer(const Particles&, const hierarchy::Elements&, const Scene&);

  /// Takes in what was traced again, and that elements were split, reactivated, made inactive or added. Not for updates
  /// of all particles, or compacted ones: then make a new one.
  void follow(const Particles&, const ParticleUpdate&, const hierarchy::Elements&, const Scene&);

  /// Takes in that any patch may reflect otherwise or be covered otherwise.
  void followAllPatches(const hierarchy::Elements&);
  /// Takes in that these patches reflect otherwise or are covered otherwise: particles on them may lie otherwise.
  void followPatches(const hierarchy::Elements&, std::span<const hierarchy::ElementId> patches);

  /// Writes E of particles at every leaf from today's radiosities and the scale of lights.
  void apply(hierarchy::Elements&, std::span<const Rgb> scales) const;

  /// Radiosity of the element, or scale of the light, that sends a path; black when it has no element. [W/m2, or 1]
  Rgb power(std::size_t path, const hierarchy::Elements&, const Scene&) const;

  /// Whether an impact of a path that arrived lies on an element.
  bool placed(std::size_t impact) const { return elementOf_[impact] != kNone; }

  std::size_t pairs() const;
  /// Gray throughput (by the particles' nominal senders) deposited where there is no element [W].
  double lost() const { return lost_; }
  std::size_t memoryBytes() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]

  struct Entry {
    std::uint32_t sender = 0;  // a light, or behind all lights an element
    std::uint32_t count = 0;   // of impacts
    RgbSum flux{0.0};          // per radiosity [unit^2], of lights per scale [W]
  };
  struct Deposit {
    std::uint32_t element, sender;
    Rgb flux;
    float weight;
    float albedo;  // of its link
  };

  std::uint32_t locateSender(const Particles&, std::size_t path, const hierarchy::SideLocator&, const Scene&) const;
  void locate(const Particles&, std::size_t path, const hierarchy::SideLocator&, const Scene&);
  template <class Visit>
  void visit(const Particles&, std::size_t path, std::uint32_t sender, std::uint32_t cell, const PathRange&,
             const Visit&) const;
  void add(const Deposit&);
  void remove(const Deposit&);
  std::vector<RetracedPath> misplaced(const Particles&, const ParticleUpdate&) const;
  void apply(const PatchTree&, const std::vector<Rgb>& B, hierarchy::Elements&, std::span<const Rgb> scales) const;

  std::size_t lights_ = 0;
  double lost_ = 0;
  LargeArray<std::uint32_t> senderOf_;          // by path
  LargeArray<std::uint32_t> elementOf_;         // by slot of impact
  std::vector<std::vector<Entry>> entries_;     // by element: ascending by sender
  std::vector<DepositSums> sums_;               // by element
  std::vector<char> places_;                    // by element: whether particles can start and land there
  std::vector<hierarchy::ElementId> surfaces_;  // input-level patches that particles land on, or did, ascending
  SpreadLevels levels_;
};

}  // namespace deltalux::particles
