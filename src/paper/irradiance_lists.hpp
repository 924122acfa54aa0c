#pragma once
// Incremental diffuse solution [GD01 5]: "we maintain a list of the add and remove irradiance operations at the level
// of the link being modified. During push-pull we accumulate these lists which are pushed down the hierarchy, and the
// add/remove operations performed in place". So an update gathers over the links that it changed and over those whose
// senders send something else now, and over no others.
//
// Every link has brought its receiver what its sender sent when that was last gathered; this is kept by sender, with
// the centre that it was seen at, so that what is removed is what was added, to rounding. After each push-pull of the
// marked parts, senders whose radiosity has come to differ from that by more than a threshold propagate it: the
// difference is added over their links. The threshold is the mean residual radiosity in the end, so the power
// that is pending is no more than a full solve leaves (solve.hpp).
// Cost: some ten nanoseconds a link once, to list them by sender, and thirty for each that is gathered over; push-pull
// of what is marked. Memory: 24 bytes an element, 108 a cluster.
#include <span>
#include <vector>

#include "base/paged_array.hpp"
#include "hierarchy/link.hpp"
#include "paper/line_space.hpp"
#include "paper/solve.hpp"

namespace deltalux::paper {

class IrradianceLists {
 public:
  /// Of a solution whose light has converged over its links.
  explicit IrradianceLists(const hierarchy::Elements&);

  /// Before links are evaluated again: lists what the marked ones have brought, to be removed.
  void remove(const hierarchy::Elements&, const hierarchy::Links&, const LinkMarks&);
  /// Before an interior link collapses: the same of all links below it.
  void removeBelow(const hierarchy::Elements&, const hierarchy::Links&, hierarchy::LinkId);
  /// After: lists what those links bring, and what stands in their place, to be added.
  void add(const hierarchy::Elements&, const hierarchy::Links&);

  /// Push-pull with the lists, then gathering over the links of senders that have changed, until none has. `changed`:
  /// elements of other shape, reflectance or covers. Particles are placed in every iteration.
  IterationReport iterate(const Parts&, const particles::ParticleTransfer&,
                          std::span<const hierarchy::ElementId> changed, double converged);

  std::size_t memoryBytes() const;
  /// Recounts: every element has gathered, to rounding, what its links bring of what their senders last propagated. To
  /// be asked when nothing is listed. Throws std::logic_error.
  void validate(const hierarchy::Elements&, const hierarchy::Links&) const;

 private:
  /// Irradiance that a link brings its receiver. Removed: negative.
  struct Operation {
    hierarchy::ElementId receiver;
    bool direct = false;
    Vec3f w{0.0f};  // from the receiver to the sender, of cluster links
    Rgb E{0.0f};
  };
  class Outgoing;

  void follow(const hierarchy::Elements&);
  Rgb propagated(const hierarchy::Elements&, hierarchy::ElementId sender, const Vec3f& w) const;
  template <class Sent>
  Operation brought(const hierarchy::Elements&, const hierarchy::Link&, const Sent& sent) const;
  void list(const hierarchy::Elements&, const hierarchy::Link&, float sign);
  void takeOut(const hierarchy::Elements&, const hierarchy::Links&, hierarchy::LinkId);
  void apply(hierarchy::Elements&, std::vector<char>& marked);
  bool differs(const hierarchy::Elements&, std::size_t element, double threshold) const;
  void propagate(const hierarchy::Elements&, const hierarchy::Links&, const Outgoing&,
                 std::span<const hierarchy::ElementId> senders);
  RgbSum pendingPower(const hierarchy::Elements&) const;

  // What was last propagated: by element, and of clusters by their slot.
  std::vector<Rgb> B_;
  std::vector<Vec3f> center_;
  std::vector<hierarchy::DirectionalRgb> intensity_;

  std::vector<Operation> operations_;
  std::vector<hierarchy::LinkId> again_;  // links to be added with all below them
  PagedArray<char> removed_;              // by link: in the list already
  std::size_t placed_ = 0;                // elements that push-pull has seen
};

}  // namespace deltalux::paper
