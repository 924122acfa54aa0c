#pragma once
// Particles as one more sparse transfer: E(receiver) = sum of T B(sender), senders being leaf patches and lights. Made
// once a mesh; every iteration then costs a multiplication per pair of sender and receiver that particles connect, and
// no ray. The one writer of ElementLight::particle. [GD01 2.1, "placed at an appropriate level in the hierarchy"]
//
// The level at which the particles of a leaf are spread is chosen per input-level surface by the least estimated error:
// the tree of patches is cut where the sum of
//
//   J = (2 sum w^2 - (sum w)^2) / A
//
// over the cut is least, w being the particles' fluxes and A a patch's area: the cross-validated squared error of a
// histogram [Rudemo82]. No threshold, and much light on few particles is not mistaken for detail. A patch that would
// receive more than surfaces of radiosity 1 all around could give it is too small for its particles, too: light sent
// round between such patches would grow without end. Energy is kept, except where a whole surface is that small.
// Cost: to build, about 0.3 microseconds an impact.
#include "hierarchy/side_locator.hpp"
#include "particles/particles.hpp"

namespace deltalux {

class ParticleTransfer {
 public:
  /// Finds where the particles start and land on today's mesh.
  ParticleTransfer(const Particles&, const Elements&, const Scene&);

  /// Writes E of particles at every leaf from today's radiosities and the scale of lights.
  void apply(Elements&, const Scene&) const;

  std::size_t pairs() const { return entries_.size(); }
  /// Gray throughput (by the particles' nominal senders) that landed where there is no element [W].
  double lost() const { return lost_; }
  std::size_t memoryBytes() const;

 private:
  struct Entry {
    std::uint32_t sender;  // of senders_
    Rgb T;                 // [1], or of lights [W/m2 per scale]
  };
  struct Landing {
    std::uint32_t row = RadixNode::kNone;  // element
    std::uint32_t sender = RadixNode::kNone;
    Rgb flux{0.0f};
  };

  std::vector<ElementId> chooseLevels(const Elements&, const std::vector<Landing>&,
                                      const std::vector<float>& weights) const;
  void build(const Elements&, std::vector<Landing>&);

  std::size_t lights_ = 0;
  double lost_ = 0;
  std::vector<std::uint32_t> rowOf_;  // by element: row that a leaf reads, or none
  std::vector<std::uint32_t> begin_;  // per row, one more
  std::vector<Entry> entries_;
};

}  // namespace deltalux
