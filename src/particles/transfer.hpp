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
//
// Retraced paths are taken out and put in one by one; only the cut is chosen anew.
// Cost: to build, about 0.3 microseconds an impact; an update, that for what is retraced and 10 nanoseconds an element.
#include "particles/particle_tracing.hpp"

namespace deltalux {

class SideLocator;

class ParticleTransfer {
 public:
  /// Finds where the particles start and land on today's mesh.
  ParticleTransfer(const Particles&, const Elements&, const Scene&);

  /// Takes in what was traced anew. Elements may have been split since; not removed, and no particles compacted: then
  /// make a new one.
  void follow(const Particles&, const ParticleUpdate&, const Elements&, const Scene&);

  /// Writes E of particles at every leaf from today's radiosities and the scale of lights.
  void apply(Elements&, const Scene&) const;

  /// Radiosity of the element, or scale of the light, that sends a path; black when it has no element. [W/m2, or 1]
  Rgb power(std::size_t path, const Elements&, const Scene&) const;

  std::size_t pairs() const;
  /// Gray throughput (by the particles' nominal senders) that landed where there is no element [W].
  double lost() const { return lost_; }
  std::size_t memoryBytes() const;

 private:
  struct Entry {
    std::uint32_t sender = 0;  // a light, or behind all lights an element
    std::uint32_t count = 0;   // of impacts
    RgbSum flux{0.0};          // per radiosity [unit^2], of lights per scale [W]
  };
  /// Of the impacts of an element itself.
  struct Sums {
    double weight = 0, squares = 0;  // by nominal senders
    double gain = 0;                 // flux per radiosity of surfaces, brightest channels
  };
  struct Landing {
    std::uint32_t element, sender;
    Rgb flux;
    float weight;
  };

  std::uint32_t locateSender(const Particles&, std::size_t path, const SideLocator&) const;
  void locate(const Particles&, std::size_t path, const SideLocator&);
  template <class Visit>
  void visit(const Particles&, std::size_t path, std::uint32_t sender, std::uint32_t cell, const PathRange&,
             const Visit&) const;
  void add(const Landing&);
  void remove(const Landing&);
  void chooseLevels(const Elements&);

  std::size_t lights_ = 0;
  double lost_ = 0;
  std::vector<std::uint32_t> senderOf_;      // by path
  std::vector<std::uint32_t> elementOf_;     // by slot of impact
  std::vector<std::vector<Entry>> entries_;  // by element: ascending by sender
  std::vector<Sums> sums_;                   // by element
  std::vector<std::uint32_t> level_;         // by element: the one that its particles are spread over
  std::vector<float> damping_;               // by such an element: of what surfaces send
};

}  // namespace deltalux
