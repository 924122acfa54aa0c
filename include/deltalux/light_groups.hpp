#pragma once
// Light is linear in the lamps: a solution can hold the light of each group of lights by itself (SolveSettings::
// byLight), and what lights as they are dimmed make together is a weighted sum.
#include <deltalux/solution.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux {

/// Lights that are dimmed together.
struct LightGroup {
  std::string name;
  std::vector<LightId> lights;  // ascending; no light is in two groups

  bool operator==(const LightGroup&) const = default;
};

/// Lights that a pattern names (LightPattern).
std::vector<LightId> lightsMatching(const Scene&, std::string_view pattern);

/// The groups that a solution holds apart, in the scene's order of their first lights; all lights together as "all"
/// where it was not solved by light.
std::vector<LightGroup> lightGroups(const SolutionView&);

/// The solution as a group's lights alone make it, at scale 1: white, undimmed, all others off. (Lights of one group
/// that were not dimmed alike when it was solved keep the scales that they had then.) Where the solution was
/// not solved by light, the only group is all of it as it is. To be read like any other solution (SolutionReader,
/// probe, render); its mesh, and the vertices of its SolutionMesh, are those of the whole. Cost: a copy of the
/// solution. Precondition: group < lightGroups().size().
SolutionView lightOf(const SolutionView&, std::size_t group);

}  // namespace deltalux
