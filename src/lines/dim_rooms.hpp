#pragma once
// Rooms that hardly any light reaches: leaves in the dark that see each other. Where a room is lit through a slot, few
// of its lines lead out, and what light comes in is a matter of chance unless there are more.
#include "lines/lines.hpp"

namespace deltalux::lines {

/// Where a leaf lies. What is narrow neither parts rooms nor lights them.
enum Place : std::uint8_t { kLit, kDim, kNarrow };
/// `indirect`: light of leaves by way of others [W/m2, gray], without what may shine in on a few; `floor`: light that
/// matters; `inRoom`: whether a leaf sees far enough to lie in a room.
std::vector<Place> placesOf(std::span<const float> indirect, double floor, const std::vector<char>& inRoom);

/// By leaf in the dark: lines that lead to it from lit ones, of the first `counts` lines of those.
std::vector<std::uint32_t> waysInto(const Lines&, const hierarchy::LeafTable&, std::span<const std::uint32_t> counts,
                                    std::span<const Place>);

struct DimCounts {
  std::vector<std::uint32_t> lines;  // by leaf
  bool told = true;                  // no room gets more without any that lead out: those it gets may find some
};

/// By leaf: how many lines it wants in place of `counts`, so that enough of its room's lead out, as many an area all
/// over the room; 0 where it has enough, or is in no such room, or so many of its room's lines lead nowhere that it is
/// closed. `all`: lines in all of which leaves may have no more than a share; `area`: of leaves; `in`: waysInto();
/// `skies`: whether what leaves the scene meets light.
DimCounts dimCounts(const TracedLines&, const hierarchy::LeafTable&, std::span<const std::uint32_t> counts, double all,
                    std::span<const float> area, std::span<const Place>, std::span<const std::uint32_t> in, bool skies);

}  // namespace deltalux::lines
