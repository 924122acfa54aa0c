#pragma once
// What keys do, in one table: hands act by it, and the list of keys shows it.
#include <span>

#include "tools.hpp"
#include "window.hpp"

namespace deltalux::viewer {

/// What a key acts on.
struct KeyContext {
  Controller& controller;
  Tools& tools;
  double x = 0, y = 0;     // cursor [pixels of the picture]
  bool onPicture = false;  // it is on the picture and not on a panel
};

struct KeyBinding {
  int key = 0;
  bool control = false;
  const char* name = "";  // as it stands on the key
  const char* does = "";
  void (*act)(KeyContext&) = nullptr;  // precondition: controller.ready()
};

std::span<const KeyBinding> keyBindings();
/// Bookmarks included. True where the key has a meaning.
bool press(const KeyPress&, KeyContext&);
/// What the mouse does, and keys that are held: name and meaning.
std::span<const std::pair<const char*, const char*>> handMoves();

}  // namespace deltalux::viewer
