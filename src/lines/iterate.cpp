#include "lines/iterate.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kLeafBlock = 1024;

/// Leaves of the other side that lie behind a leaf, by the share of its rectangle that they take.
void addBehind(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves, std::uint32_t leaf,
               std::vector<LeafLight::Behind>& behind) {
  hierarchy::Side side = elements.sideOf(leaves[leaf]);
  side.front = !side.front;
  const hierarchy::ElementId other = elements.sides.at(side);
  if (!other.valid() || !elements.receives(other)) return;
  const hierarchy::PatchDomain& d = elements.domain[leaves[leaf].index()];
  const std::size_t first = behind.size();
  float all = 0;
  hierarchy::forEachBelow(elements, other, [&](hierarchy::ElementId e) {
    const hierarchy::PatchDomain& o = elements.domain[e.index()];
    const float u = std::min(d.u1, o.u1) - std::max(d.u0, o.u0), v = std::min(d.v1, o.v1) - std::max(d.v0, o.v0);
    if (!(u > 0 && v > 0)) return false;
    if (elements.isLeaf(e)) behind.push_back({leaf, leaves.indexOf[e.index()], u * v}), all += u * v;
    return true;
  });
  for (std::size_t i = first; i < behind.size(); ++i) behind[i].share /= all;
}

void reflect(const LeafLight& light, std::size_t i, Rgb& B) {
  B = light.rho[i] * (light.source[i] + light.indirect[i]);
}

}  // namespace

LeafLight leafLight(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves) {
  LeafLight light;
  const std::size_t n = leaves.size();
  light.rho.resize(n), light.tau.resize(n);
  light.source.assign(n, Rgb(0.0f)), light.indirect.assign(n, Rgb(0.0f)), light.B.assign(n, Rgb(0.0f));
  for (std::size_t i = 0; i < n; ++i) {
    const hierarchy::ElementLight& r = elements.radiometry[leaves[i].index()];
    light.rho[i] = r.rho, light.tau[i] = r.tau;
    if (!isBlack(r.tau)) addBehind(elements, leaves, static_cast<std::uint32_t>(i), light.behind);
  }
  return light;
}

IterationReport iterate(Exchange& exchange, LeafLight& light, double converged, int most) {
  const std::size_t n = exchange.leaves();
  IterationReport report;
  std::vector<Rgb> next(n);
  const auto reflectAll = [&](std::vector<Rgb>& B) {
    parallelFor(n, kLeafBlock, [&](std::size_t i) { reflect(light, i, B[i]); });
    for (const LeafLight::Behind& b : light.behind)
      B[b.leaf] += b.share * light.tau[b.leaf] * (light.source[b.other] + light.indirect[b.other]);
  };
  reflectAll(light.B);
  report.emitted = parallelSum<RgbSum>(n, kLeafBlock, [&](std::size_t i) {
    return double(exchange.area(i)) * RgbSum((light.rho[i] + light.tau[i]) * light.source[i]);
  });
  while (report.passes < most) {
    exchange.gather(light.B, light.indirect);
    reflectAll(next);
    ++report.passes;
    report.residual = parallelSum<RgbSum>(n, kLeafBlock, [&](std::size_t i) {
      return double(exchange.area(i)) * RgbSum(glm::abs(next[i] - light.B[i]));
    });
    light.B.swap(next);
    if (gray(report.residual) <= converged * gray(report.emitted)) break;
  }
  return report;
}

}  // namespace deltalux::lines
