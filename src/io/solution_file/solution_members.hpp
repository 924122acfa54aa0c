#pragma once
// The members of a solution besides its scene, for archives. What the hierarchy's arrays hold are records: their fields
// may change without a word here.
#include "io/solution_file/scene_members.hpp"
#include "solution/solution.hpp"

namespace deltalux::io {

template <>
struct EnumRange<SolveMethod> {
  static constexpr SolveMethod first = SolveMethod::Lines, last = SolveMethod::Paper;
};

void members(auto& archive, Is<LightPattern> auto& p) {
  auto& [group, pattern] = p;
  transferAll(archive, group, pattern);
}
void members(auto& archive, Is<SolveSettings> auto& s) {
  auto& [error, particles, seconds, diffuseOnly, causticTextures, seed, method, byLight, groups, reemittedShare] = s;
  transferAll(archive, error, particles, seconds, diffuseOnly, causticTextures, seed, method, byLight, groups,
              reemittedShare);
}

void members(auto& archive, Is<EnergyLedger> auto& e) {
  auto& [emitted, absorbed, escaped, residual] = e;
  transferAll(archive, emitted, absorbed, escaped, residual);
}
void members(auto& archive, Is<ErrorEstimate> auto& e) {
  auto& [asked, median, p95] = e;
  transferAll(archive, asked, median, p95);
}
void members(auto& archive, Is<SolveReport> auto& r) {
  auto& [times, counts, memory, error, energy, cutParticles, converged] = r;
  transferAll(archive, times, counts, memory, error, energy, cutParticles, converged);
}

void members(auto& archive, Is<hierarchy::Elements> auto& e) {
  auto& [topology, geometry, nodes, domain, moments, light, radiometry, slot, clusters, key, outlines, frames,
         faceOrders, sceneRoot, grown, lightRoot, distant, inactive, sceneBox, inputs, sides, contacts, folded] =
      e;  // orders, inputs, sides and contacts follow from the others; nothing is folded
  transferAll(archive, topology, geometry, nodes, domain, moments, light, radiometry, slot, clusters, key, outlines,
              frames, sceneRoot, grown, lightRoot, distant, inactive, sceneBox);
}
void members(auto& archive, Is<hierarchy::Links> auto& l) {
  auto& [all, roots, free] = l;  // the last follows from the first
  transferAll(archive, all, roots);
}

/// Of leaves one after the other.
void members(auto& archive, Is<lines::Lines> auto& l) {
  auto& [of, end, code, exceptions] = l;
  std::vector<std::uint32_t> counts(of.size()), listed(of.size());
  LargeArray<std::uint16_t> reach(code.size());  // the rest of a code follows from the line's leaf
  constexpr bool reads = std::remove_reference_t<decltype(archive)>::kReads;
  if constexpr (!reads) {
    for (std::size_t i = 0; i < of.size(); ++i) counts[i] = of[i].count, listed[i] = exceptions.of[i].count;
    for (std::size_t i = 0; i < code.size(); ++i) reach[i] = code[i].reach;
  }
  transferAll(archive, counts, end, reach, listed, exceptions.all);
  if constexpr (reads) {
    archive.require(listed.size() == counts.size());
    of.resize(counts.size()), exceptions.of.resize(counts.size());
    std::uint64_t first = 0, firstException = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      of[i] = {first, counts[i], 0}, exceptions.of[i] = {static_cast<std::uint32_t>(firstException), listed[i]};
      first += counts[i], firstException += listed[i];
    }
    archive.require(first == end.size() && firstException == exceptions.all.size());
    for (auto& r : of)
      for (const std::uint32_t e : l.endsOf(r)) r.covered += e == lines::kCovered;
    code.resize(reach.size());
    for (std::size_t i = 0; i < code.size(); ++i) code[i].reach = reach[i];
  }
}

void members(auto& archive, Is<particles::Particles> auto& p) {
  auto& [senderCells, nominal, links, link, sender, originTriangle, range, account, termination, vertices, met,
         primitive, triangleAndSide, uv, throughput, quantum, rays, pilots] = p;
  transferAll(archive, senderCells, nominal, links, link, sender, originTriangle, range, account, termination, vertices,
              met, primitive, triangleAndSide, uv, throughput, quantum, rays, pilots);
}

}  // namespace deltalux::io
