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

void members(auto& archive, Is<lines::Lines> auto& l) {
  auto& [first, end, code, exceptions] = l;
  LargeArray<std::uint16_t> reach(code.size());  // the rest of a code follows from the line's leaf
  constexpr bool reads = std::remove_reference_t<decltype(archive)>::kReads;
  if constexpr (!reads)
    for (std::size_t i = 0; i < code.size(); ++i) reach[i] = code[i].reach;
  transferAll(archive, first, end, reach, exceptions);
  if constexpr (reads) {
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
