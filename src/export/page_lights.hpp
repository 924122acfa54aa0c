#pragma once
// The groups of lights as a page dims them.
#include <deltalux/light_groups.hpp>
#include <string>
#include <vector>

namespace deltalux::exporting {

struct PageLight {
  std::string name;
  Rgb base{1.0f};  // scale of the light where its group's weight is 1
  bool switchedOff = false;
};

struct PageGroup {
  enum class Kind { Lamp, Sun, Sky };  // lamp: also where they are mixed
  std::string name;
  Kind kind = Kind::Lamp;
  Rgb weight{1.0f};               // at the scene's present scales; a group's first light counts
  Rgb colour{1.0f};               // of its light at weight 1, up to a factor
  std::vector<PageLight> lights;  // each name once
};

/// `present`: a weight of 1 is the scene's present state (not solved by light); else scale 1 of every light.
std::vector<PageGroup> pageGroups(const Scene&, const std::vector<LightGroup>&, bool present);

}  // namespace deltalux::exporting
