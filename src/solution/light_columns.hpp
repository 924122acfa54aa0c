#pragma once
// The light of a solution by groups of lights, each a column: irradiance is their sum, each times what its lights are
// dimmed to. Suns are lights like others; skies, which shadow rays do not tell apart, are one group.
#include <deltalux/light_groups.hpp>

#include <memory>
#include <optional>
#include <span>

#include "caustics/caustics.hpp"

namespace deltalux {

/// Of a group's lights at these scales, all others being off. By receiving leaf, in order [W/m2].
struct LightColumn {
  std::vector<Rgb> scales;  // by light of the group: 1, or what they were when they were not dimmed alike
  std::vector<Rgb> direct, indirect, particle;
  std::vector<float> deviation;  // standard error, gray
  caustics::Caustics caustics;
};

struct LightColumns {
  std::vector<LightGroup> groups;
  std::vector<LightColumn> of;  // by group

  bool empty() const { return of.empty(); }
  std::size_t memoryBytes() const;
};

struct Solution;

/// The groups of a scene's lights: one a light, the skies together, and those that patterns name.
std::vector<LightGroup> groupsOf(const Scene&, const std::vector<LightPattern>&);

/// What columns are to be multiplied by for the scales that the scene's lights have; nullopt where lights of a group
/// are dimmed otherwise than in its column.
std::optional<std::vector<Rgb>> weightsOf(const LightColumns&, const Scene&);

/// Light of the leaves, and above them, as the sum of columns by weight; the scene's scales and the textures are left
/// as they are.
void addUp(Solution&, std::span<const Rgb> weights);

/// Shows one group of lights after the other in one copy of a solution, each as lightOf() has it.
class GroupLight {
 public:
  explicit GroupLight(const SolutionView&);
  /// Changes what view() holds: who reads it has to be told (SolutionReader::refresh()).
  void show(std::size_t group);
  const SolutionView& view() const { return view_; }

 private:
  SolutionView whole_;
  std::shared_ptr<Solution> alone_;  // null: solved without columns, and shown as it is
  SolutionView view_;
};

/// Recounts: as many values as leaves, finite and not negative. Throws std::logic_error.
void validate(const LightColumns&, const Scene&, std::size_t leaves);

}  // namespace deltalux
