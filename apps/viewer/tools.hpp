#pragma once
// What hands hold at the moment, as hands and panels share it: what the next click is for, how one walks, what is shown
// beside the picture.
#include <deltalux/error.hpp>

#include "controller.hpp"

namespace deltalux::viewer {

enum class ClickFor { Selection, Aim, FieldCorner, FieldOpposite };

struct Tools {
  bool panels = true;      // beside the picture
  bool keys = false;       // the list of them
  bool level = true;       // walking keeps its height; flying goes where one looks
  bool localAxes = false;  // of the gizmo: the object's own
  ClickFor click = ClickFor::Selection;
  std::string lamp;                              // that the next click aims
  SurfaceHit fieldCorner;                        // of the rectangle whose opposite corner the next click gives
  int compared = -1;                             // state beside what is now: 0 A, 1 B; -1: none
  double wipe = 1;                               // share of the width that shows what is now
  Quantity falseColour = Quantity::Illuminance;  // that the key switches on
};

/// Does what a hand asks for; what is refused is told where panels show it.
template <class Action>
void attempt(Controller& controller, Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    controller.lastError = error.message() + (error.hint().empty() ? "" : " (" + error.hint() + ")");
  } catch (const OutputError& error) {
    controller.lastError = error.what();
  }
}

inline ProbePoint probePoint(const SurfaceHit& hit) { return {hit.position, hit.normal}; }

/// Shows a stored state beside what is now; -1: none.
inline void compareWith(Controller& controller, Tools& tools, int slot, double wipe) {
  tools.compared = slot, tools.wipe = slot < 0 ? 1 : wipe;
  controller.compare(std::max(slot, 0), tools.wipe);
}

}  // namespace deltalux::viewer
