#include "lines/dim_rooms.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kRoomLeaves = 1024;  // of a task [task]

/// Lines of leaves, but of those that have lines in another lot the ones from there.
struct Lots {
  const TracedLines& first;
  const TracedLines* more;

  const TracedLines& of(std::size_t leaf) const { return more && more->lines.countOf(leaf) > 0 ? *more : first; }
  /// visit(leaf, end) of the straight lines of a leaf.
  template <class Visit>
  void forEachLine(std::uint32_t leaf, const Visit& visit) const {
    const Lines& lines = of(leaf).lines;
    for (std::uint64_t k = lines.first[leaf]; k < lines.first[leaf + 1]; ++k)
      if (lines.end[k] < kFirstMark) visit(leaf, lines.end[k]);
  }
  /// visit(x) of what either lot lists, such as exceptions.
  template <class List, class Visit>
  void forEachListed(const List& list, const Visit& visit) const {
    for (const TracedLines* lot : {&first, more})
      if (lot)
        for (const auto& x : list(*lot))
          if (&of(x.leaf) == lot) visit(x);
  }
};

constexpr auto kExceptions = [](const TracedLines& t) -> const auto& { return t.lines.exceptions; };
constexpr auto kEscapedLines = [](const TracedLines& t) -> const auto& { return t.escaped; };

/// Lines that lead out of the dark, by the leaf in the dark; those that lead in among them.
std::vector<std::uint32_t> waysOut(const Lots& lots, std::span<const Place> place, std::span<const std::uint32_t> in,
                                   bool skies) {
  std::vector<std::uint32_t> ways(in.begin(), in.end());
  parallelFor(place.size(), kRoomLeaves, [&](std::size_t i) {
    if (place[i] != kDim) return;
    lots.forEachLine(static_cast<std::uint32_t>(i),
                     [&](std::uint32_t, std::uint32_t j) { ways[i] += place[j] == kLit; });
  });
  lots.forEachListed(kExceptions,
                     [&](const ExceptionalLine& e) { ways[e.leaf] += place[e.leaf] == kDim && place[e.end] == kLit; });
  if (skies) lots.forEachListed(kEscapedLines, [&](const EscapedLine& e) { ways[e.leaf] += place[e.leaf] == kDim; });
  return ways;
}

DisjointSets roomsOf(const Lots& lots, std::span<const Place> place) {
  DisjointSets rooms(place.size());
  const auto join = [&](std::uint32_t i, std::uint32_t j) {
    if (place[i] == kDim && place[j] == kDim) rooms.join(i, j);
  };
  for (std::uint32_t i = 0; i < place.size(); ++i)
    if (place[i] == kDim) lots.forEachLine(i, join);
  lots.forEachListed(kExceptions, [&](const ExceptionalLine& e) { join(e.leaf, e.end); });
  return rooms;
}

/// Of a room.
struct Room {
  double area = 0, lines = 0, ways = 0;

  double wanted() const {
    return ways > 0 ? lines * std::max(1.0, tuning::kDimWays / ways) : std::max(lines, tuning::kClosedLines);
  }
};

}  // namespace

std::vector<Place> placesOf(std::span<const float> indirect, double floor, const std::vector<char>& inRoom) {
  std::vector<Place> place(indirect.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = !(indirect[i] < floor) ? kLit : inRoom[i] ? kDim : kNarrow;
  return place;
}

std::vector<std::uint32_t> waysInto(const TracedLines& traced, std::span<const Place> place) {
  std::vector<std::atomic<std::uint32_t>> ways(place.size());
  const auto countEnd = [&](std::uint32_t, std::uint32_t j) {
    if (place[j] == kDim) ways[j].fetch_add(1, std::memory_order_relaxed);
  };
  const Lots all{traced, nullptr};
  parallelFor(place.size(), kRoomLeaves, [&](std::size_t i) {
    if (place[i] == kLit) all.forEachLine(static_cast<std::uint32_t>(i), countEnd);
  });
  for (const ExceptionalLine& e : traced.lines.exceptions)
    if (place[e.leaf] == kLit) countEnd(e.leaf, e.end);
  return {ways.begin(), ways.end()};
}

DimCounts dimCounts(const TracedLines& traced, std::span<const float> area, std::span<const Place> place,
                    std::span<const std::uint32_t> in, bool skies, const TracedLines* more) {
  const Lots lots{traced, more};
  const std::size_t n = place.size();
  const std::vector<std::uint32_t> out = waysOut(lots, place, in, skies);
  DisjointSets rooms = roomsOf(lots, place);
  std::vector<Room> all(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (place[i] != kDim) continue;
    Room& room = all[rooms.of(i)];
    room.area += area[i], room.lines += lots.of(i).lines.countOf(i), room.ways += out[i];
  }
  // In octaves, so that small changes leave nearly all leaves' lines as they are; by so many less, all of them, that
  // they are not too many.
  const auto lines = static_cast<double>(traced.lines.size());
  const double most = std::max(tuning::kDimShare * lines, tuning::kDimFree - lines);
  DimCounts counts{std::vector<std::uint32_t>(n, 0)};
  for (double share = 1, added = kInfinity; added > most; share /= 2) {
    added = 0, counts.told = true;
    for (std::uint32_t i = 0; i < n; ++i) {
      counts.lines[i] = 0;
      if (place[i] != kDim) continue;
      const Room& room = all[rooms.of(i)];
      const double wanted = std::min(share * room.wanted() * area[i] / room.area, tuning::kMostDim);
      if (!(wanted > 2.0 * lots.of(i).lines.countOf(i))) continue;
      counts.lines[i] = std::bit_floor(static_cast<std::uint32_t>(wanted)), added += counts.lines[i];
      counts.told = counts.told && room.ways > 0;
    }
  }
  return counts;
}

}  // namespace deltalux::lines
