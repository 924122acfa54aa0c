#pragma once
// A binary tree over lamps, of which a patch asks those one by one that may bring much, and draws from the others in
// proportion to the most that they may bring: no lamp is left out, few are looked at. [WFABDG05 (light tree, cut by
// bounds); CK18 (cones of emission, importance down the tree)]
// Departures: the cut is of what a patch may get at all, before any ray; below it lamps are drawn, not represented, so
// that what a ray finds belongs to one lamp and the sum is right in the mean. Nodes are split by power times the
// square of the box's diagonal, without regard to cones.
// Cost: O(n log^2 n) to build; a bound is some thirty operations, a cut two of them a lamp that is asked, a draw two a
// level.
#include <optional>
#include <span>
#include <vector>

#include "direct/lamp.hpp"

namespace deltalux::direct {

class LampTree {
 public:
  LampTree() = default;
  /// Of these of the lamps; none may be a sun.
  LampTree(std::span<const Lamp> lamps, std::vector<std::uint32_t> which);

  /// A lamp, by its index among all, and what it may bring to a patch [W/m2, gray].
  struct Reaching {
    std::uint32_t lamp;
    double potential;

    bool operator==(const Reaching&) const = default;
  };
  /// Lamps below a node, and no less than what all of them together may bring [W/m2, gray].
  struct Branch {
    std::uint32_t node;
    double most;
    double rank;  // by which it is looked into
  };
  struct Cut {
    std::vector<Reaching> lamps;  // descending by potential
    std::vector<Branch> rest;
    double restMost = 0;  // sum over the rest

    void clear() { lamps.clear(), rest.clear(), restMost = 0; }
  };
  /// Those lamps, `most` of them, that may bring more than `share` of what all may bring, or much less than that where
  /// they are among `seen` (lampBits); the others as branches.
  void cut(const hierarchy::ElementGeometry&, double share, std::size_t most, std::uint64_t seen, Cut&) const;

  struct Drawn {
    std::uint32_t lamp;
    double chance;
  };
  /// One lamp of the rest by a number in [0,1); nullopt where it came to such as bring nothing.
  std::optional<Drawn> draw(const Cut&, const hierarchy::ElementGeometry&, double u) const;

  /// visit(lamp, potential) of all that may bring anything, in an order that depends on the tree alone.
  template <class Visit>
  void reaching(const hierarchy::ElementGeometry& g, const Visit& visit) const {
    if (!nodes_.empty()) reaching(0, g, visit);
  }

 private:
  struct Node {
    LampSphere sphere;
    float smallest = 0;        // radius of the smallest lamp
    double most = 0;           // summed
    std::uint64_t lamps = 0;   // their bits
    std::uint32_t second = 0;  // child; the first is the next node. 0: a lamp
    std::uint32_t lamp = 0;    // of lamps_ and index_
  };
  void build(std::span<std::uint32_t> which, std::span<const Lamp> lamps);
  std::size_t splitAt(std::span<std::uint32_t> which, std::span<const Lamp> lamps) const;
  double bound(std::uint32_t node, const hierarchy::ElementGeometry&) const;

  template <class Visit>
  void reaching(std::uint32_t node, const hierarchy::ElementGeometry& g, const Visit& visit) const {
    const Node& n = nodes_[node];
    const double most = bound(node, g);
    if (!(most > 0)) return;
    if (n.second == 0) return visit(index_[n.lamp], most);
    reaching(node + 1, g, visit), reaching(n.second, g, visit);
  }

  std::vector<Node> nodes_;
  std::vector<Lamp> lamps_;  // in the order of the tree
  std::vector<std::uint32_t> index_;
};

}  // namespace deltalux::direct
