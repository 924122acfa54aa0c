#pragma once
// The population of edits that updates are judged by: every thing in a scene that a person could move, lamp and wall,
// in a text file (bench/edits/*.txt) of lines
//
//   step METRES                    how far things move
//   room NAME X0 Y0 X1 Y1          in plan, in units of the scene
//   move | lamp | fixed NAME...    objects; NAME.* stands for all directly below NAME
//   paint MATERIAL R G B           what it reflects then
//
// and # comments. Every object at the top of the scene's tree is in it, or one below it is: what a scene gains later
// cannot be forgotten. Things move horizontally, away from the nearest wall of their room: along the axis on which the
// middle of their bounds lies farthest from the room's middle, relative to the room's size, towards that.
#include <deltalux/edit.hpp>
#include <filesystem>
#include <string_view>

namespace deltalux::bench {

/// One edit, and what kind of edit its time is counted among.
struct NamedEdit {
  std::string kind;     // "move", "dim", "off", "on", "move lamp", "paint"
  std::string subject;  // object, light or material
  Edit edit;
};

/// Edits that are done in one go, after which the solution is held against a fresh one.
struct EditPhase {
  std::string name;  // "move", "lamp", "paint"
  std::vector<NamedEdit> edits;
};

/// The list's edits in its order, phase after phase. Moved things and lamps stay where they were moved to. A lamp is
/// dimmed to half, switched off, on, and moved with all that belongs to it. The scene needs its area lights. Throws
/// InputError: what is no line of a list, names that the scene has not got, objects that the list has not got.
std::vector<EditPhase> parseEditList(std::string_view text, const std::string& file, const Scene&);
std::vector<EditPhase> loadEditList(const std::filesystem::path&, const Scene&);

/// So many of the moves in them, evenly from the list; all where there are no more.
EditPhase movesSpread(const std::vector<EditPhase>&, std::size_t count);

}  // namespace deltalux::bench
