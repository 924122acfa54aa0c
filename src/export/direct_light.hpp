#pragma once
// Direct light of suns and lamps by group of lights, measured at points by shadow rays, where a solution's mesh has the
// mean of each patch. Groups with a sky in them keep what the mesh has: rays into a sky are many.
#include <deltalux/light_groups.hpp>
#include <memory>
#include <span>
#include <vector>

#include "direct/lamp_meter.hpp"

namespace deltalux::exporting {

class DirectLight {
 public:
  /// Of the groups' lights as lightOf() has them: at scale 1 where the solution was solved by light. It must outlive
  /// this.
  explicit DirectLight(const SolutionView&);
  /// All suns and lamps as they are now, as one group, skies left out.
  static DirectLight together(const SolutionView&);

  std::size_t groups() const { return meters_.size(); }
  /// Whether the group is measured.
  bool measures(std::size_t group) const { return meters_[group] != nullptr; }
  bool any() const;
  /// `other`: the group's other light there, and a share of that of all groups [W/m2, gray]. `error`: relative to all
  /// of it.
  direct::LampMeter::Reading read(std::size_t group, const Vec3& position, const Vec3& normal, float other,
                                  double error, direct::LampMeter::Doubt doubt = direct::LampMeter::Doubt::Much) const {
    return meters_[group]->read(position, normal, other, error, doubt);
  }
  Rgb at(std::size_t group, const Vec3& position, const Vec3& normal, float other, double error) const {
    return read(group, position, normal, other, error).E;
  }

 private:
  DirectLight() = default;

  std::vector<std::unique_ptr<const direct::LampMeter>> meters_;  // by group; null: not measured
};

}  // namespace deltalux::exporting
