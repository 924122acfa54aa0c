#include "lines/lines.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace deltalux::lines {

std::size_t Lines::memoryBytes() const {
  return first.capacity() * sizeof(std::uint64_t) + end.capacity() * sizeof(std::uint32_t) +
         code.capacity() * sizeof(LineCode) + exceptions.capacity() * sizeof(ExceptionalLine);
}

std::uint64_t Lines::hash(std::span<const std::uint64_t> keys) const {
  std::uint64_t all = 0;
  const auto nameOf = [&](std::uint32_t e) { return e < kFirstMark ? keys[e] : std::uint64_t(e); };
  for (std::size_t leaf = 0; leaf < leaves(); ++leaf) {
    std::uint64_t own = combineKeys(keys[leaf], countOf(leaf));
    for (std::uint64_t k = first[leaf]; k < first[leaf + 1]; ++k) own = combineKeys(own, nameOf(end[k]));
    all += own;  // in any order of the leaves
  }
  for (const ExceptionalLine& e : exceptions) {
    std::uint64_t own = combineKeys(combineKeys(keys[e.leaf], e.line - first[e.leaf]), nameOf(e.end));
    for (int c = 0; c < 3; ++c) own = combineKeys(own, std::bit_cast<std::uint32_t>(e.weight[c]));
    all += own;
  }
  return all;
}

void validate(const Lines& lines) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::logic_error(std::string("lines: ") + what);
  };
  require(std::is_sorted(lines.first.begin(), lines.first.end()), "of one leaf after the other");
  require(lines.end.size() == lines.size() && lines.code.size() == lines.size(), "as many ends and codes as lines");
  std::size_t exceptions = 0;
  for (const std::uint32_t e : lines.end) {
    require(e >= kFirstMark ? e >= kException : e < lines.leaves(), "end on leaves that there are");
    exceptions += e == kException;
  }
  require(exceptions == lines.exceptions.size(), "as many exceptions as are marked");
  std::uint64_t next = 0;
  for (const ExceptionalLine& e : lines.exceptions) {
    require(e.line >= next && e.line < lines.size() && lines.end[e.line] == kException, "exceptions in order");
    require(e.leaf < lines.leaves() && e.line >= lines.first[e.leaf] && e.line < lines.first[e.leaf + 1],
            "exceptions of their leaf");
    require(e.end < lines.leaves() && std::isfinite(gray(e.weight)) && !(gray(e.weight) < 0), "exceptions that end");
    next = e.line + 1;
  }
}

}  // namespace deltalux::lines
