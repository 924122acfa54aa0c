#pragma once
// What sees nothing of that which moves, where it is and will be: then no light comes or goes between the two, and none
// between it and anything else is kept back or let through. Told by one opaque polygon that hides all of it
// (hidden_elements.hpp), or by the plane of a flat patch that all lies behind. Asked down the tree: what hides a
// cluster hides all in it. In a house, most of what is in other rooms is out of sight.
// Cost: that of what is hidden, and some nanoseconds for an element whose parent is not, once; a byte an element.
#include <atomic>
#include <memory>

#include "hierarchy/element.hpp"

namespace deltalux::paper {

class OutOfSight {
 public:
  /// `region`: of all that moves, where it is and will be. All else must stand still, and outlive this.
  OutOfSight(const hierarchy::Elements&, const Scene&, const Box& region);

  /// Whether an element is known to see nothing of what moves. From any thread.
  bool holds(hierarchy::ElementId e) const { return state(e) == kHidden; }

 private:
  static constexpr std::uint8_t kUnknown = 0, kSeen = 1, kHidden = 2;  // [sentinel]

  std::uint8_t state(hierarchy::ElementId) const;
  bool behind(hierarchy::ElementId) const;

  const hierarchy::Elements& elements_;
  Box region_;
  std::size_t size_;  // elements there were
  std::unique_ptr<std::atomic<std::uint8_t>[]> state_;
};

}  // namespace deltalux::paper
