#include "lines/lines.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "base/parallel.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kLineElements = 1024;  // of a task [task]
constexpr double kMostGone = 0.2;            // lines that are no more, of those that are [task]
constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;

/// By element that there are, which each was; kNone.
std::vector<std::uint32_t> inverse(std::span<const std::uint32_t> now, std::size_t elements) {
  std::vector<std::uint32_t> was(elements, kNone);
  for (std::uint32_t old = 0; old < now.size(); ++old)
    if (now[old] != kNone) was[now[old]] = old;
  return was;
}

template <class T>
ListsOfLeaves<T> reordered(const ListsOfLeaves<T>& lists, std::span<const std::uint32_t> was) {
  ListsOfLeaves<T> all;
  all.of.resize(was.size());
  std::uint32_t next = 0;
  for (std::size_t e = 0; e < was.size(); ++e) {
    if (was[e] == kNone) continue;
    all.of[e] = {next, lists.of[was[e]].count};
    next += all.of[e].count;
  }
  all.all.resize(next);
  parallelFor(was.size(), kLineElements, [&](std::size_t e) {
    if (was[e] != kNone) std::ranges::copy(lists.at(hierarchy::ElementId(was[e])), all.all.begin() + all.of[e].first);
  });
  return all;
}

/// `now`: what ends become.
Lines reordered(const Lines& lines, std::span<const std::uint32_t> was, std::span<const std::uint32_t> now) {
  Lines all;
  all.of.resize(was.size());
  std::uint64_t next = 0;
  for (std::size_t e = 0; e < was.size(); ++e) {
    if (was[e] == kNone) continue;
    all.of[e] = lines.of[was[e]], all.of[e].first = next;
    next += all.of[e].count;
  }
  all.end.resize(next), all.code.resize(next);
  const auto endNow = [&](std::uint32_t end) { return now[end] == kNone ? KnownLines::kAgain : now[end]; };
  parallelFor(was.size(), kLineElements, [&](std::size_t e) {
    if (was[e] == kNone) return;
    const hierarchy::ElementId old(was[e]);
    const auto first = static_cast<std::ptrdiff_t>(all.of[e].first);
    std::ranges::copy(lines.codesOf(old), all.code.begin() + first);
    std::ranges::transform(lines.endsOf(old), all.end.begin() + first,
                           [&](std::uint32_t end) { return end < kFirstMark ? endNow(end) : end; });
  });
  all.exceptions = reordered(lines.exceptions, was);
  for (ExceptionalLine& e : all.exceptions.all) e.end = endNow(e.end);
  return all;
}

template <class T>
std::size_t bytesOf(const ListsOfLeaves<T>& lists) {
  return lists.all.capacity() * sizeof(T) + lists.of.capacity() * sizeof(lists.of[0]);
}

}  // namespace

std::uint64_t Lines::size() const {
  std::uint64_t all = 0;
  for (const LineRange& r : of) all += r.count;
  return all;
}

std::size_t Lines::memoryBytes() const {
  return of.capacity() * sizeof(LineRange) + end.capacity() * sizeof(std::uint32_t) +
         code.capacity() * sizeof(LineCode) + bytesOf(exceptions);
}

std::uint64_t Lines::hash(std::span<const std::uint64_t> keys) const {
  const auto nameOf = [&](std::uint32_t e) { return e < kFirstMark ? keys[e] : std::uint64_t(e); };
  // In any order of the leaves.
  return parallelSum<std::uint64_t>(of.size(), kLineElements, [&](std::size_t i) {
    const hierarchy::ElementId leaf(i);
    if (countOf(leaf) == 0) return std::uint64_t(0);
    std::uint64_t all = combineKeys(keys[i], countOf(leaf));
    for (const std::uint32_t e : endsOf(leaf)) all = combineKeys(all, nameOf(e));
    for (const ExceptionalLine& e : exceptions.at(leaf)) {
      std::uint64_t own = combineKeys(combineKeys(keys[i], e.number), nameOf(e.end));
      for (int c = 0; c < 3; ++c) own = combineKeys(own, std::bit_cast<std::uint32_t>(e.weight[c]));
      all += own;
    }
    return all;
  });
}

void validate(const Lines& lines) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::logic_error(std::string("lines: ") + what);
  };
  const std::size_t elements = lines.of.size();
  require(lines.exceptions.of.size() == elements, "as many elements with exceptions as with lines");
  require(lines.end.size() == lines.code.size(), "as many ends and codes as lines");
  for (std::size_t i = 0; i < elements; ++i) {
    const hierarchy::ElementId leaf(i);
    const LineRange& r = lines.at(leaf);
    require(r.first <= lines.end.size() && r.count <= lines.end.size() - r.first, "as many ends and codes as lines");
    const auto& listed = lines.exceptions.of[i];
    require(listed.first <= lines.exceptions.all.size() && listed.count <= lines.exceptions.all.size() - listed.first,
            "exceptions that there are");
    const std::span<const std::uint32_t> ends = lines.endsOf(leaf);
    std::size_t exceptions = 0, covered = 0;
    for (const std::uint32_t e : ends) {
      require(e >= kFirstMark ? e >= kException : e < elements, "end on leaves that there are");
      exceptions += e == kException, covered += e == kCovered;
    }
    require(exceptions == listed.count, "as many exceptions as are marked");
    require(covered == r.covered, "as many that are covered as are marked");
    std::uint32_t next = 0;
    for (const ExceptionalLine& e : lines.exceptions.at(leaf)) {
      require(e.number >= next && e.number < r.count && ends[e.number] == kException, "exceptions in order");
      require(e.end < elements && std::isfinite(gray(e.weight)) && !(gray(e.weight) < 0), "exceptions that end");
      next = e.number + 1;
    }
  }
}

Lines renumbered(const Lines& lines, std::span<const std::uint32_t> now, std::size_t elements) {
  return reordered(lines, inverse(now.first(std::min(now.size(), lines.of.size())), elements), now);
}

TracedLines renumbered(const TracedLines& traced, std::span<const std::uint32_t> now, std::size_t elements) {
  const std::vector<std::uint32_t> was = inverse(now.first(std::min(now.size(), traced.lines.of.size())), elements);
  return {reordered(traced.lines, was, now), reordered(traced.escaped, was), reordered(traced.bends, was), 0};
}

namespace {

/// Moves what is of elements to the front of `stored`, in the order in which it lies there, where more than kMostGone
/// of it is no element's. move(from, to, count) of each.
template <class Range, class Move>
void tidyStored(std::vector<Range>& of, std::size_t& stored, const Move& move) {
  std::size_t used = 0;
  for (const Range& r : of) used += r.count;
  if (static_cast<double>(stored) <= (1 + kMostGone) * static_cast<double>(used) + kLineElements) return;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // where, of which element
  for (std::uint32_t e = 0; e < of.size(); ++e)
    if (of[e].count > 0)
      order.emplace_back(of[e].first, e);
    else
      of[e] = {};
  std::ranges::sort(order);
  stored = 0;
  for (const auto& [first, e] : order) {
    if (first != stored) move(first, stored, of[e].count);
    of[e].first = static_cast<decltype(of[e].first)>(stored);
    stored += of[e].count;
  }
}

template <class Stored>
void moveDown(Stored& all, std::uint64_t from, std::uint64_t to, std::uint32_t count) {
  std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(from), count, all.begin() + static_cast<std::ptrdiff_t>(to));
}

template <class T>
void tidyList(ListsOfLeaves<T>& lists) {
  std::size_t stored = lists.all.size();
  tidyStored(lists.of, stored, [&](auto from, auto to, auto count) { moveDown(lists.all, from, to, count); });
  lists.all.resize(stored);
}

}  // namespace

void tidy(TracedLines& all) {
  std::size_t stored = all.lines.end.size();
  tidyStored(all.lines.of, stored, [&](auto from, auto to, auto count) {
    moveDown(all.lines.end, from, to, count), moveDown(all.lines.code, from, to, count);
  });
  all.lines.end.resize(stored), all.lines.code.resize(stored);
  tidyList(all.lines.exceptions), tidyList(all.escaped), tidyList(all.bends);
}

}  // namespace deltalux::lines
