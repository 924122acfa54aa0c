#pragma once
// A viewer driven without hands: one action a line, read whole before anything happens. What a script does goes through
// the same functions as what hands do (controller.hpp). docs/viewer.md lists the actions.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "controller.hpp"

namespace deltalux::viewer {

namespace action {

enum class Until { Ready, Settled, Finished };

struct Wait {
  Until until = Until::Settled;
  double seconds = 600;  // then the script fails
};
struct Frames {  // draws so many, whatever changes
  int count = 1;
};
struct Look {  // through a view of the scene, or of a file
  std::string view;
};
struct Camera {
  Vec3 position{0}, direction{0, 1, 0};
  std::optional<Vec3> up;
  std::optional<double> angle;  // horizontal [degrees]
};
struct Walk {
  Vec3 rightForwardUp{0};
};
struct Turn {
  double yaw = 0, pitch = 0;  // [degrees]
};
struct Orbit {
  double x = 0, y = 0;  // about what is seen at this pixel
  double yaw = 0, pitch = 0;
};
struct Select {
  std::string name;
};
struct SelectAt {
  double x = 0, y = 0;
};
/// Of the selection, along a straight line in so many frames of the window, or turned about its centre; then let go.
struct Drag {
  Vec3 offset{0};
  std::optional<Vec3> axis;
  double degrees = 0;
  int frames = 1;
};
/// A light's dimmer under the hand: in so many frames from its present scale to that times `factor`.
struct Dim {
  std::string light;
  double factor = 1;
  int frames = 1;
};
/// One line of an edits file.
struct Apply {
  EditStep step;
};
struct Aim {
  std::string light;
  Vec3 at{0};
};
struct LookThrough {
  std::string light;
};
struct Store {
  int slot = 0;
};
struct Compare {
  int slot = 0;
  double wipe = 1;
};
struct RestoreState {
  int slot = 0;
};
struct Pin {
  std::string name;
  ProbePoint point;
};
/// Prints what a pinned meter reads; with `lux`, the script fails when it is further from it than `tolerance` (of it).
struct Read {
  std::string name;
  std::optional<double> lux;
  double tolerance = 0;
};
struct Field {
  std::optional<MeterField> field;
};
struct ReadField {};
struct PointAt {
  double x = 0, y = 0;
};
struct Explain {
  ProbePoint point;
};
struct Exposure {
  std::optional<double> ev;  // nullopt: from the picture, once
};
struct Tone {
  ToneOperator tone = ToneOperator::Reinhard;
};
struct False {
  FalseColour falseColour;
};
struct Overlay {
  std::string name;
  bool on = true;
};
struct Section {
  std::optional<Box> box;
};
struct Bookmark {
  int slot = 1;
  bool go = false;
};
struct Layer {  // "cache", "picture": what may be drawn over the mesh
  std::string name;
  bool on = true;
};
struct Screenshot {
  std::filesystem::path file;
  bool window = false;  // with the panels
};
struct SaveRadiance {
  std::filesystem::path file;
};
struct SaveSolution {
  std::filesystem::path file;
};
struct Quit {};

}  // namespace action

using Action =
    std::variant<action::Wait, action::Frames, action::Look, action::Camera, action::Walk, action::Turn, action::Orbit,
                 action::Select, action::SelectAt, action::Drag, action::Dim, action::Apply, action::Aim,
                 action::LookThrough, action::Store, action::Compare, action::RestoreState, action::Pin, action::Read,
                 action::Field, action::ReadField, action::PointAt, action::Explain, action::Exposure, action::Tone,
                 action::False, action::Overlay, action::Section, action::Bookmark, action::Layer, action::Screenshot,
                 action::SaveRadiance, action::SaveSolution, action::Quit>;

struct ScriptLine {
  int line = 0;
  std::string text;
  Action action;
};

struct Script {
  std::string file;
  int width = 640, height = 480;  // of the window: "size W H [panels]", the first line
  bool panels = false;            // beside the picture, which fills the window otherwise
  std::vector<ScriptLine> lines;
};

/// Throws InputError (file, line, what the action wants). Files that it names are from `folder`; screenshots and other
/// outputs from where the program runs.
Script parseScript(std::string_view text, const std::string& file, const std::filesystem::path& folder);
Script loadScript(const std::filesystem::path&);

}  // namespace deltalux::viewer
