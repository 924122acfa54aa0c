#pragma once
// The mixer: every lamp with its level, colour and switch; aiming, and looking through one.
#include "panels/widgets.hpp"
#include "tools.hpp"

namespace deltalux::viewer {

/// Lights that edits take by one name: those below a first part of names, or one alone.
struct LampGroup {
  std::string name;
  std::vector<LightId> lights;
};
/// All lights, in the order of the scene.
std::vector<LampGroup> lampGroups(const Scene&);

/// Scale of a light, switched on or not: brightest channel, and colour with that as 1.
struct LampLevel {
  float level = 1;
  Rgb colour{1.0f};
  bool on = true;
};
LampLevel lampLevel(const Scene&, LightId);

void lampPanel(Controller&, Tools&, Pending&);
/// Level, colour, switch, aim and look through, of all lights that a name means.
void lampControls(Controller&, Tools&, Pending&, const std::string& name, LightId first);

}  // namespace deltalux::viewer
