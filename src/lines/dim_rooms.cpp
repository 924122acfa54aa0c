#include "lines/dim_rooms.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "base/usual_error.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kRoomLeaves = 1024;  // of a task [task]

/// So many of the first lines of each leaf, and where those are that they end on.
struct FirstOfLeaves {
  const Lines& lines;
  const hierarchy::LeafTable& leaves;
  std::span<const std::uint32_t> counts;

  /// visit(leaf, end) of the straight lines of a leaf, and exceptional ones.
  template <class Visit>
  void forEachLine(std::uint32_t leaf, const Visit& visit) const {
    for (const std::uint32_t end : lines.endsOf(leaves[leaf]).first(counts[leaf]))
      if (end < kFirstMark) visit(leaf, leaves.indexOf[end]);
    for (const ExceptionalLine& e : lines.exceptions.at(leaves[leaf]))
      if (e.number < counts[leaf]) visit(leaf, leaves.indexOf[e.end]);
  }
};

/// Lines that lead out of the dark, by the leaf in the dark; those that lead in among them.
std::vector<std::uint32_t> waysOut(const FirstOfLeaves& first, std::span<const Place> place,
                                   std::span<const std::uint32_t> in, bool skies) {
  std::vector<std::uint32_t> ways(in.begin(), in.end());
  parallelFor(place.size(), kRoomLeaves, [&](std::size_t i) {
    if (place[i] != kDim) return;
    first.forEachLine(static_cast<std::uint32_t>(i),
                      [&](std::uint32_t, std::uint32_t j) { ways[i] += place[j] == kLit; });
    if (!skies) return;
    const std::span<const std::uint32_t> ends = first.lines.endsOf(first.leaves[i]).first(first.counts[i]);
    ways[i] += static_cast<std::uint32_t>(std::ranges::count(ends, kEscaped));
  });
  return ways;
}

DisjointSets roomsOf(const FirstOfLeaves& first, std::span<const Place> place) {
  DisjointSets rooms(place.size());
  for (std::uint32_t i = 0; i < place.size(); ++i)
    if (place[i] == kDim)
      first.forEachLine(i, [&](std::uint32_t, std::uint32_t j) {
        if (place[j] == kDim) rooms.join(i, j);
      });
  return rooms;
}

/// Lines of a room that hardly any light reaches by which it counts as closed where none leads out, and as many as all
/// such rooms may have in scenes of few: what next to nothing of next to nothing would come by is not found.
constexpr double kClosedLines = 1.0 / deltalux::tuning::kNegligible / deltalux::tuning::kNegligible;  // [defined]

/// Of a room.
struct Room {
  double area = 0, lines = 0, ways = 0;

  double wanted() const {
    return ways > 0 ? lines * std::max(1.0, kSamplesOfUsualError / ways) : std::max(lines, kClosedLines);
  }
};

}  // namespace

std::vector<Place> placesOf(std::span<const float> indirect, double floor, const std::vector<char>& inRoom) {
  std::vector<Place> place(indirect.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = !(indirect[i] < floor) ? kLit : inRoom[i] ? kDim : kNarrow;
  return place;
}

std::vector<std::uint32_t> waysInto(const Lines& lines, const hierarchy::LeafTable& leaves,
                                    std::span<const std::uint32_t> counts, std::span<const Place> place) {
  std::vector<std::atomic<std::uint32_t>> ways(place.size());
  std::vector<char> dim(leaves.indexOf.size(), false);  // by element
  for (std::size_t i = 0; i < place.size(); ++i) dim[leaves[i].index()] = place[i] == kDim;
  const auto countEnd = [&](std::uint32_t end) {
    if (dim[end]) ways[leaves.indexOf[end]].fetch_add(1, std::memory_order_relaxed);
  };
  parallelFor(place.size(), kRoomLeaves, [&](std::size_t i) {
    if (place[i] != kLit) return;
    for (const std::uint32_t end : lines.endsOf(leaves[i]).first(counts[i]))
      if (end < kFirstMark) countEnd(end);
    for (const ExceptionalLine& e : lines.exceptions.at(leaves[i]))
      if (e.number < counts[i]) countEnd(e.end);
  });
  return {ways.begin(), ways.end()};
}

DimCounts dimCounts(const TracedLines& traced, const hierarchy::LeafTable& leaves, std::span<const std::uint32_t> had,
                    double lines, std::span<const float> area, std::span<const Place> place,
                    std::span<const std::uint32_t> in, bool skies) {
  const FirstOfLeaves first{traced.lines, leaves, had};
  const std::size_t n = place.size();
  const std::vector<std::uint32_t> out = waysOut(first, place, in, skies);
  DisjointSets rooms = roomsOf(first, place);
  std::vector<Room> all(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (place[i] != kDim) continue;
    Room& room = all[rooms.of(i)];
    room.area += area[i], room.lines += had[i], room.ways += out[i];
  }
  // In octaves, so that small changes leave nearly all leaves' lines as they are; by so many less, all of them, that
  // they are not too many.
  const double most = std::max(deltalux::tuning::kDefensive * lines, kClosedLines - lines);
  DimCounts counts{std::vector<std::uint32_t>(n, 0)};
  for (double share = 1, added = kInfinity; added > most; share /= 2) {
    added = 0, counts.told = true;
    for (std::uint32_t i = 0; i < n; ++i) {
      counts.lines[i] = 0;
      if (place[i] != kDim) continue;
      const Room& room = all[rooms.of(i)];
      const double wanted = std::min(share * room.wanted() * area[i] / room.area, most);
      if (!(wanted > 2.0 * had[i])) continue;
      counts.lines[i] = std::bit_floor(static_cast<std::uint32_t>(wanted)), added += counts.lines[i];
      counts.told = counts.told && room.ways > 0;
    }
  }
  return counts;
}

}  // namespace deltalux::lines
