#pragma once
// What is selected: its name, where it is, numbers to move and turn it by, what it is made of.
#include "panels/widgets.hpp"
#include "tools.hpp"

namespace deltalux::viewer {

/// A turn that is being typed.
struct TypedTurn {
  int axis = 2;
  float degrees = 90;
};

void selectionPanel(Controller&, Tools&, Pending&, TypedTurn&);

}  // namespace deltalux::viewer
