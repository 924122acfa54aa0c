#pragma once
// Form factors of a row sum to no more than one; by chance a row may exceed it. Where that would send back more than
// comes, light between such leaves would grow without end: so the row is scaled down, and what it gathered beyond, its
// surplus, goes to leaves around it that miss as much by the same chance: those below the lowest element that has room
// for it, each in proportion to what its factors lack. So no light is lost, but for the little that finds no room in a
// small part of the scene: handed on to all of it, a surplus that comes or goes with an edit would change light
// everywhere.
//
//   factors   F = sum of T over a row, that is of the whole leaf: in a closed cavity the exposed share of it
//   limit     what F may be for each unit of exposed area: 1, or 0.98 / rho where that is more
//   surplus   A (F - limit exposed), where positive
//   room      A (exposed - F), where positive, but no more than A F: what sees little is not lit by its neighbours'
//   chance
//
// Both are summed upwards until there is room.
//
// Cost: 32 bytes an element; a pass over leaves with a surplus before light is gathered.
#include <span>
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::radiosity {

class RowSurplus {
 public:
  /// Light that waits for the leaves below each group, by slot: irradiance of the room that there is.
  using Pools = std::vector<Rgb>;

  /// Makes room for all elements.
  void resize(const hierarchy::Elements&);
  /// Takes note of the factors (largest channel) of a leaf's row; of a leaf without one: 0. By several threads at once
  /// for different leaves.
  void set(hierarchy::ElementId leaf, float factors) { nodes_[leaf.index()].factors = factors; }
  /// Shares out anew what is above these leaves, whose rows, exposure or reflectance are others. Adds to `concerned`
  /// the leaves that get another share of the same light.
  void follow(const hierarchy::Elements&, std::span<const hierarchy::ElementId> leaves,
              std::vector<hierarchy::ElementId>& concerned);
  /// By which what a row sums up is irradiance of the exposed part, the surplus taken off.
  float scale(hierarchy::ElementId leaf) const { return nodes_[leaf.index()].scale; }
  /// What there is to share out when leaves have this indirect light (that of others does not matter).
  Pools pools(const hierarchy::Elements&) const;
  /// What a leaf gets of it.
  Rgb share(const hierarchy::Elements&, hierarchy::ElementId leaf, const Pools&) const;
  /// The leaves with room below groups whose pools differ by more than the part `same`; those take the value of `now`.
  void listen(const hierarchy::Elements&, const Pools& now, float same, Pools& heard,
              std::vector<hierarchy::ElementId>& leaves) const;
  std::size_t memoryBytes() const;
  /// Checks that sums hold, and that nobody gets more than there is room for. Throws std::logic_error.
  void validate(const hierarchy::Elements&) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Node {
    float factors = 0, scale = 1;  // leaves
    float surplus = 0, room = 0;   // that go on upwards
    float taken = 0, perRoom = 0;  // of a group: share of the room below that it takes, and 1 / that room
    std::uint32_t slot = kNone;    // of a group
    std::uint8_t height = 0;       // levels below it
  };
  void takeLeaf(const hierarchy::Elements&, std::size_t e);
  bool takeParts(const hierarchy::Elements&, std::size_t e);
  void addWithRoom(const hierarchy::Elements&, hierarchy::ElementId group,
                   std::vector<hierarchy::ElementId>& leaves) const;

  std::vector<Node> nodes_;                   // by element
  std::vector<hierarchy::ElementId> groups_;  // by slot
  std::vector<std::uint32_t> free_;           // slots
  std::vector<hierarchy::ElementId> full_;    // leaves with a surplus, ascending
};

}  // namespace deltalux::radiosity
