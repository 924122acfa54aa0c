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

constexpr std::size_t kRoomLeaves = 1024;  // of a task

/// Lines that lead out of the dark, by the leaf in the dark.
std::vector<std::uint32_t> waysOut(const TracedLines& traced, std::span<const Place> place, bool skies) {
  const Lines& lines = traced.lines;
  std::vector<std::atomic<std::uint32_t>> ways(place.size());
  const auto count = [&](std::uint32_t i, std::uint32_t j) {
    if (place[i] == kDim && place[j] == kLit) ways[i].fetch_add(1, std::memory_order_relaxed);
    if (place[j] == kDim && place[i] == kLit) ways[j].fetch_add(1, std::memory_order_relaxed);
  };
  parallelFor(place.size(), kRoomLeaves, [&](std::size_t i) {
    for (std::uint64_t k = lines.first[i]; k < lines.first[i + 1]; ++k)
      if (lines.end[k] < kFirstMark) count(static_cast<std::uint32_t>(i), lines.end[k]);
  });
  for (const ExceptionalLine& e : lines.exceptions) count(e.leaf, e.end);
  if (skies)
    for (const EscapedLine& e : traced.escaped)
      if (place[e.leaf] == kDim) ways[e.leaf].fetch_add(1, std::memory_order_relaxed);
  return {ways.begin(), ways.end()};
}

DisjointSets roomsOf(const Lines& lines, std::span<const Place> place) {
  DisjointSets rooms(place.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    if (place[i] != kDim) continue;
    for (std::uint64_t k = lines.first[i]; k < lines.first[i + 1]; ++k)
      if (lines.end[k] < kFirstMark && place[lines.end[k]] == kDim) rooms.join(i, lines.end[k]);
  }
  for (const ExceptionalLine& e : lines.exceptions)
    if (place[e.leaf] == kDim && place[e.end] == kDim) rooms.join(e.leaf, e.end);
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

DimCounts dimCounts(const TracedLines& traced, std::span<const float> area, std::span<const Place> place, bool skies) {
  const std::size_t n = place.size();
  const std::vector<std::uint32_t> out = waysOut(traced, place, skies);
  DisjointSets rooms = roomsOf(traced.lines, place);
  std::vector<Room> all(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (place[i] != kDim) continue;
    Room& room = all[rooms.of(i)];
    room.area += area[i], room.lines += traced.lines.countOf(i), room.ways += out[i];
  }
  // In octaves, so that small changes leave nearly all leaves' lines as they are; by so many less, all of them, that
  // they are not too many.
  const auto lines = static_cast<double>(traced.lines.size());
  const double most = std::max(tuning::kDimShare * lines, tuning::kDimFree - lines);
  DimCounts counts{std::vector<std::uint32_t>(n, 0)};
  for (double share = 1, more = kInfinity; more > most; share /= 2) {
    more = 0, counts.told = true;
    for (std::uint32_t i = 0; i < n; ++i) {
      counts.lines[i] = 0;
      if (place[i] != kDim) continue;
      const Room& room = all[rooms.of(i)];
      const double wanted = std::min(share * room.wanted() * area[i] / room.area, tuning::kMostDim);
      if (!(wanted > 2.0 * traced.lines.countOf(i))) continue;
      counts.lines[i] = std::bit_floor(static_cast<std::uint32_t>(wanted)), more += counts.lines[i];
      counts.told = counts.told && room.ways > 0;
    }
  }
  return counts;
}

}  // namespace deltalux::lines
