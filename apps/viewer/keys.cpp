#include "keys.hpp"

#include <GLFW/glfw3.h>

namespace deltalux::viewer {

namespace {
constexpr double kExposureStep = 1.0 / 3;  // of the keys [stops]

void cancel(KeyContext& c) {
  if (c.tools.click != ClickFor::Selection)
    c.tools.click = ClickFor::Selection;
  else
    c.controller.select("");
}

void removeSelection(KeyContext& c) {
  if (c.controller.selection().empty()) return;
  attempt(c.controller, [&] {
    c.controller.edit(RemoveObject{c.controller.selection()});
    c.controller.select("");
  });
}

/// The first name "probe N" that no pinned probe has.
std::string freeProbeName(const std::vector<Probe>& probes) {
  for (std::size_t n = 1;; ++n) {
    const std::string name = fmt::format("probe {}", n);
    if (std::none_of(probes.begin(), probes.end(), [&](const Probe& p) { return p.name == name; })) return name;
  }
}

void pinUnderCursor(KeyContext& c) {
  if (!c.onPicture) return;
  if (const auto hit = c.controller.hitAt(c.x, c.y))
    c.controller.pinProbe(freeProbeName(c.controller.probes()), probePoint(*hit));
}

void explainUnderCursor(KeyContext& c) {
  if (!c.onPicture) return;
  if (const auto hit = c.controller.hitAt(c.x, c.y)) c.controller.explain(probePoint(*hit));
}

void switchFalseColour(KeyContext& c) {
  FalseColour& f = c.controller.draw().falseColour;
  if (f.quantity != Quantity::Radiance) c.tools.falseColour = f.quantity;
  f.quantity = f.quantity == Quantity::Radiance ? c.tools.falseColour : Quantity::Radiance;
}

/// Half of the picture, then all of it, then what is now again.
void switchComparison(KeyContext& c) {
  const auto& stored = c.controller.session().stored();
  const auto has = [&](std::size_t slot) { return slot < stored.size() && stored[slot].has_value(); };
  const int slot = c.tools.compared >= 0 ? c.tools.compared : has(0) ? 0 : has(1) ? 1 : -1;
  if (slot < 0)
    c.controller.lastError = "nothing is stored to compare with (States: Store A)";
  else if (c.tools.compared < 0)
    compareWith(c.controller, c.tools, slot, 0.5);
  else if (c.tools.wipe > 0)
    compareWith(c.controller, c.tools, slot, 0);
  else
    compareWith(c.controller, c.tools, -1, 1);
}

constexpr KeyBinding kBindings[] = {
    {GLFW_KEY_F, false, "F", "Look at what is selected", [](KeyContext& c) { c.controller.focusOnSelection(); }},
    {GLFW_KEY_SPACE, false, "Space", "Walk level, or fly where you look",
     [](KeyContext& c) { c.tools.level = !c.tools.level; }},
    {GLFW_KEY_ESCAPE, false, "Esc", "Select nothing; leave off aiming or measuring out", cancel},
    {GLFW_KEY_DELETE, false, "Delete", "Remove what is selected", removeSelection},
    {GLFW_KEY_L, false, "L", "Handles along the object's own axes, or the scene's",
     [](KeyContext& c) { c.tools.localAxes = !c.tools.localAxes; }},
    {GLFW_KEY_Z, true, "Ctrl Z", "Undo",
     [](KeyContext& c) {
       if (c.controller.session().canUndo()) c.controller.undo();
     }},
    {GLFW_KEY_Y, true, "Ctrl Y", "Redo",
     [](KeyContext& c) {
       if (c.controller.session().canRedo()) c.controller.redo();
     }},
    {GLFW_KEY_P, false, "P", "Pin a probe under the cursor", pinUnderCursor},
    {GLFW_KEY_X, false, "X", "Explain the light under the cursor", explainUnderCursor},
    {GLFW_KEY_T, false, "T", "Find the exposure, once", [](KeyContext& c) { c.controller.automaticExposure(); }},
    {GLFW_KEY_LEFT_BRACKET, false, "[", "Darker by a third of a stop",
     [](KeyContext& c) { c.controller.draw().tone.ev -= kExposureStep; }},
    {GLFW_KEY_RIGHT_BRACKET, false, "]", "Brighter by a third of a stop",
     [](KeyContext& c) { c.controller.draw().tone.ev += kExposureStep; }},
    {GLFW_KEY_V, false, "V", "False colour on or off", switchFalseColour},
    {GLFW_KEY_M, false, "M", "Show the mesh",
     [](KeyContext& c) { c.controller.draw().overlays.mesh = !c.controller.draw().overlays.mesh; }},
    {GLFW_KEY_B, false, "B", "Beside a stored state: half, all, off", switchComparison},
    {GLFW_KEY_TAB, false, "Tab", "Panels on or off", [](KeyContext& c) { c.tools.panels = !c.tools.panels; }},
    {GLFW_KEY_F1, false, "F1", "This list", [](KeyContext& c) { c.tools.keys = !c.tools.keys; }},
};

constexpr std::pair<const char*, const char*> kHandMoves[] = {
    {"W A S D, arrows", "Walk; Q and E down and up, Shift fast"},
    {"Right drag", "Look round"},
    {"Middle drag, Alt left drag", "Orbit about what is under the cursor"},
    {"Wheel", "Towards what is under the cursor"},
    {"Click", "Select; again: the part itself"},
    {"Drag a handle", "Move or turn; Ctrl in steps of 0.1 m or 5\xc2\xb0"},
    {"G and drag", "Slide the object over what is under the cursor"},
    {"1 to 9", "Go to a bookmark; with Ctrl set it"},
};
}  // namespace

std::span<const KeyBinding> keyBindings() { return kBindings; }

std::span<const std::pair<const char*, const char*>> handMoves() { return kHandMoves; }

bool press(const KeyPress& pressed, KeyContext& context) {
  const bool control = (pressed.modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER)) != 0;
  if (pressed.key >= GLFW_KEY_1 && pressed.key <= GLFW_KEY_9) {
    const int slot = pressed.key - GLFW_KEY_0;
    if (control)
      context.controller.bookmark(slot);
    else
      context.controller.goToBookmark(slot);
    return true;
  }
  for (const KeyBinding& binding : kBindings)
    if (binding.key == pressed.key && binding.control == control) {
      attempt(context.controller, [&] { binding.act(context); });
      return true;
    }
  return false;
}

}  // namespace deltalux::viewer
