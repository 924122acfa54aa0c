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
  // Both ascend by leaf: merged.
  const auto merge = [&](const auto& a, const auto& b, const auto& sink) {
    std::size_t k = 0;
    for (const auto& x : a) {
      for (; k < b.size() && b[k].leaf < x.leaf; ++k) sink(b[k], more);
      if (more.lines.countOf(x.leaf) == 0) sink(x, traced);
    }
    for (; k < b.size(); ++k) sink(b[k], more);
  };
  const auto addException = [&](ExceptionalLine e, const TracedLines& from) {
    e.line = e.line - from.lines.first[e.leaf] + out.lines.first[e.leaf];
    out.lines.exceptions.push_back(e);
  };
  const auto addEscaped = [&](const EscapedLine& e, const TracedLines&) { out.escaped.push_back(e); };
  merge(traced.lines.exceptions, more.lines.exceptions, addException);
  merge(traced.escaped, more.escaped, addEscaped);
  merge(traced.bends, more.bends, [&](const Bend& b, const TracedLines&) { out.bends.push_back(b); });
  return out;
}

}  // namespace deltalux::lines
