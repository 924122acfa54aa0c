#include "lines/own_light.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kOwnLeaves = 1024;  // of a task [task]

}  // namespace

std::vector<float> ownIndirect(const TracedLines& traced, std::span<const float> rho, std::span<const float> source) {
  const Lines& lines = traced.lines;
  const std::size_t n = lines.leaves();
  std::vector<float> indirect(n, 0), brightest(n, 0), B(n);
  for (int bounce = 0; bounce < tuning::kDimBounces; ++bounce) {
    parallelFor(n, kOwnLeaves, [&](std::size_t i) {
      B[i] = rho[i] * (source[i] + indirect[i]);
      indirect[i] = brightest[i] = 0;
    });
    for (const ExceptionalLine& e : lines.exceptions) {
      const float light = gray(e.weight) * B[e.end];
      indirect[e.leaf] += light, brightest[e.leaf] = std::max(brightest[e.leaf], light);
    }
    parallelFor(n, kOwnLeaves, [&](std::size_t i) {
      const auto count = static_cast<float>(lines.countOf(i) - traced.covered[i]);
      if (!(count > 0)) return;
      float sum = indirect[i], most = brightest[i];
      for (std::uint64_t k = lines.first[i]; k < lines.first[i + 1]; ++k) {
        const float light = lines.end[k] < kFirstMark ? B[lines.end[k]] : 0.0f;
        sum += light, most = std::max(most, light);
      }
      indirect[i] = sum / count, brightest[i] = most / count;
    });
  }
  for (std::size_t i = 0; i < n; ++i) indirect[i] -= brightest[i];
  return indirect;
}

namespace {

/// Of what ascends by leaf: those of the leaves that have lines in `more` from there, all others from the first.
template <class Listed>
std::vector<Listed> merged(const std::vector<Listed>& first, const std::vector<Listed>& second, const Lines& more) {
  std::vector<Listed> all;
  all.reserve(first.size() + second.size());
  auto a = first.begin();
  auto b = second.begin();
  const auto upTo = [&](std::uint32_t leaf) {
    return std::ranges::lower_bound(a, first.end(), leaf, {}, &Listed::leaf);
  };
  for (std::uint32_t i = 0; i < more.leaves(); ++i) {
    if (more.countOf(i) == 0) continue;
    const auto here = upTo(i);
    all.insert(all.end(), a, here);
    for (a = here; a != first.end() && a->leaf == i;) ++a;
    for (; b != second.end() && b->leaf == i; ++b) all.push_back(*b);
  }
  all.insert(all.end(), a, first.end());
  return all;
}

}  // namespace

TracedLines replaced(const TracedLines& traced, const TracedLines& more) {
  TracedLines out;
  const std::size_t n = traced.lines.leaves();
  out.lines.first.resize(n + 1);
  out.covered.resize(n);
  out.rays = traced.rays + more.rays;
  out.lines.first[0] = 0;
  const auto of = [&](std::size_t i) -> const TracedLines& { return more.lines.countOf(i) > 0 ? more : traced; };
  for (std::size_t i = 0; i < n; ++i) out.lines.first[i + 1] = out.lines.first[i] + of(i).lines.countOf(i);
  out.lines.end.resize(out.lines.size()), out.lines.code.resize(out.lines.size());
  parallelFor(n, kOwnLeaves, [&](std::size_t i) {
    const Lines& l = of(i).lines;
    const auto begin = static_cast<std::ptrdiff_t>(l.first[i]), end = static_cast<std::ptrdiff_t>(l.first[i + 1]),
               at = static_cast<std::ptrdiff_t>(out.lines.first[i]);
    std::copy(l.end.begin() + begin, l.end.begin() + end, out.lines.end.begin() + at);
    std::copy(l.code.begin() + begin, l.code.begin() + end, out.lines.code.begin() + at);
    out.covered[i] = of(i).covered[i];
  });
  out.lines.exceptions = merged(traced.lines.exceptions, more.lines.exceptions, more.lines);
  for (ExceptionalLine& e : out.lines.exceptions)
    e.line = e.line - of(e.leaf).lines.first[e.leaf] + out.lines.first[e.leaf];
  out.escaped = merged(traced.escaped, more.escaped, more.lines);
  out.bends = merged(traced.bends, more.bends, more.lines);
  return out;
}

}  // namespace deltalux::lines
