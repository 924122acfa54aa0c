#include "script.hpp"

#include <charconv>
#include <deltalux/error.hpp>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

namespace deltalux::viewer {

namespace {

/// The words of one line, taken from the left.
class LineReader {
 public:
  LineReader(const std::string& file, int line, const std::filesystem::path& folder, std::string_view text)
      : file_(file), line_(line), folder_(folder), text_(text) {
    std::istringstream in{std::string(text)};
    std::string word;
    while (in >> word && word[0] != '#') words_.push_back(word);
    if (!words_.empty()) at_ = 1;
  }

  bool empty() const { return words_.empty(); }
  const std::string& command() const { return words_[0]; }
  bool more() const { return at_ < words_.size(); }
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const {
    throw InputError(file_, line_, what, hint);
  }
  const std::string& word(const char* what) {
    if (!more()) fail(fmt::format("'{}' wants {}", command(), what), "see docs/viewer.md");
    return words_[at_++];
  }
  /// Takes the next word when it is this one.
  bool take(std::string_view w) {
    if (!more() || words_[at_] != w) return false;
    ++at_;
    return true;
  }
  double number(const char* what) {
    const std::string& w = word(what);
    double value = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || end != w.data() + w.size() || !std::isfinite(value))
      fail(fmt::format("'{}' is no number", w), fmt::format("'{}' wants {}", command(), what));
    return value;
  }
  int count(const char* what, int least, int most) {
    const double value = number(what);
    if (value != std::floor(value) || value < least || value > most)
      fail(fmt::format("'{}' wants {}", command(), what), fmt::format("a whole number from {} to {}", least, most));
    return static_cast<int>(value);
  }
  Vec3 vector(const char* what) {
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = number(what);
    return v;
  }
  Vec3 direction(const char* what) {
    const Vec3 v = vector(what);
    if (!(glm::length(v) > 0)) fail(fmt::format("'{}': a direction without length", command()), what);
    return glm::normalize(v);
  }
  bool onOff() {
    if (take("on")) return true;
    if (take("off")) return false;
    fail(fmt::format("'{}' wants on or off", command()), "one of the two, at the end of the line");
  }
  /// One of the stored states.
  int slot() {
    if (take("A")) return 0;
    if (take("B")) return 1;
    fail(fmt::format("'{}' wants A or B", command()), "the state that is meant");
  }
  /// All of the line from here on.
  std::string rest() {
    at_ = words_.size();
    const std::size_t begin = text_.find(words_[0]) + words_[0].size();
    return std::string(text_.substr(begin));
  }
  std::filesystem::path folder() const { return folder_; }
  const std::string& file() const { return file_; }
  void end() const {
    if (more()) fail(fmt::format("'{}' has a word too many: '{}'", command(), words_[at_]), "one action a line");
  }

 private:
  const std::string& file_;
  int line_;
  const std::filesystem::path& folder_;
  std::string_view text_;
  std::vector<std::string> words_;
  std::size_t at_ = 0;
};

ProbePoint readPoint(LineReader& in) {
  ProbePoint point;
  point.position = in.vector("a point: x y z");
  point.normal = in.direction("a normal: nx ny nz");
  return point;
}

Action readWait(LineReader& in) {
  action::Wait wait;
  if (in.take("ready"))
    wait.until = action::Until::Ready;
  else if (in.take("finished"))
    wait.until = action::Until::Finished;
  else if (!in.take("settled"))
    in.fail("'wait' wants ready, settled or finished", "and seconds after which to give up");
  if (in.more()) wait.seconds = in.number("seconds");
  return wait;
}

Action readCamera(LineReader& in) {
  action::Camera camera;
  camera.position = in.vector("a position: x y z");
  camera.direction = in.direction("a direction: x y z");
  if (in.take("up")) camera.up = in.direction("up: x y z");
  if (in.take("angle")) {
    camera.angle = in.number("degrees");
    if (!(*camera.angle > 0 && *camera.angle < 180))
      in.fail("an angle is between 0 and 180 degrees", "full, horizontal");
  }
  return camera;
}

Action readDrag(LineReader& in) {
  action::Drag drag;
  if (in.command() == "rotate") {
    drag.axis = in.direction("an axis: x y z");
    drag.degrees = in.number("degrees");
  } else {
    drag.offset = in.vector("an offset: x y z");
  }
  if (in.take("frames")) drag.frames = in.count("a number of frames", 1, 100000);
  return drag;
}

Action readEdit(LineReader& in) {
  const std::vector<EditStep> steps = parseEdits(fmt::format("{{\"edits\": [{}]}}", in.rest()), in.file(), in.folder());
  if (steps.size() != 1) in.fail("'edit' wants one edit", "{\"op\": ...}, as in edits files");
  return action::Apply{steps.front()};
}

Action readRead(LineReader& in) {
  if (in.take("field")) return action::ReadField{};
  action::Read read;
  read.name = in.word("a probe's name, or field");
  if (in.take("near")) {
    read.lux = in.number("lux");
    read.tolerance = in.number("a tolerance, relative");
  }
  return read;
}

Action readField(LineReader& in) {
  if (in.take("off")) return action::Field{};
  MeterField field;
  field.corner = in.vector("a corner: x y z");
  field.across = in.vector("across: x y z");
  field.along = in.vector("along: x y z");
  const Vec3 normal = glm::cross(field.across, field.along);
  if (!(glm::length(normal) > 0))
    in.fail("'field': its sides span no area", "corner, across and along, three numbers each");
  field.normal = glm::normalize(normal);
  if (in.more()) {
    field.columns = in.count("columns", 1, 256);
    field.rows = in.count("rows", 1, 256);
  }
  return action::Field{field};
}

Action readFalse(LineReader& in) {
  FalseColour f;
  if (in.take("off")) return action::False{f};
  if (in.take("luminance"))
    f.quantity = Quantity::Luminance;
  else if (in.take("illuminance"))
    f.quantity = Quantity::Illuminance;
  else
    in.fail("'falsecolour' wants illuminance, luminance or off", "then the top of the scale, in lux or cd/m2");
  f.top = in.number("the top of the scale");
  if (!(f.top > 0)) in.fail("the top of a scale is above 0", "in lux or cd/m2");
  f.logarithmic = !in.take("linear");
  if (in.take("log")) f.decades = in.number("decades");
  f.isolines = in.take("isolines");
  if (in.take("bands")) {
    f.useBands = true, f.bands.clear();
    do f.bands.push_back(in.number("bands"));
    while (in.more());
  }
  return action::False{f};
}

Action readSection(LineReader& in) {
  if (in.take("off")) return action::Section{};
  Box box;
  box.extend(in.vector("a corner: x y z"));
  box.extend(in.vector("the other corner: x y z"));
  return action::Section{box};
}

Action readTone(LineReader& in) {
  const std::string& name = in.word("linear or reinhard");
  const auto tone = toneOperatorByName(name);
  if (!tone) in.fail(fmt::format("there is no tone operator '{}'", name), "linear or reinhard");
  return action::Tone{*tone};
}

Action readExposure(LineReader& in) {
  if (in.take("auto")) return action::Exposure{};
  return action::Exposure{in.number("stops, or auto")};
}

using ReadAction = std::function<Action(LineReader&)>;

const std::map<std::string, ReadAction, std::less<>>& actionReaders() {
  static const std::map<std::string, ReadAction, std::less<>> readers = {
      {"wait", readWait},
      {"frames", [](LineReader& in) { return action::Frames{in.count("a number of frames", 1, 1000000)}; }},
      {"view", [](LineReader& in) { return action::Look{in.word("a view of the scene, or a .vf file")}; }},
      {"camera", readCamera},
      {"walk", [](LineReader& in) { return action::Walk{in.vector("right, forward, up")}; }},
      {"turn",
       [](LineReader& in) {
         const double yaw = in.number("degrees to the left");
         return action::Turn{yaw, in.number("degrees upwards")};
       }},
      {"orbit",
       [](LineReader& in) {
         action::Orbit orbit;
         orbit.x = in.number("a pixel: x y"), orbit.y = in.number("a pixel: x y");
         orbit.yaw = in.number("degrees to the left"), orbit.pitch = in.number("degrees upwards");
         return orbit;
       }},
      {"select",
       [](LineReader& in) -> Action {
         if (in.take("at")) {
           const double x = in.number("a pixel: x y");
           return action::SelectAt{x, in.number("a pixel: x y")};
         }
         return action::Select{in.take("nothing") ? "" : in.word("an object or light, nothing, or at x y")};
       }},
      {"drag", readDrag},
      {"rotate", readDrag},
      {"dim",
       [](LineReader& in) {
         action::Dim dim;
         dim.light = in.word("a light");
         dim.factor = in.number("a factor");
         if (dim.factor < 0) in.fail("a light cannot be dimmed below 0", "a factor of its present scale");
         if (in.take("frames")) dim.frames = in.count("a number of frames", 1, 100000);
         return dim;
       }},
      {"edit", readEdit},
      {"undo", [](LineReader&) { return action::Apply{Undo{}}; }},
      {"redo", [](LineReader&) { return action::Apply{Redo{}}; }},
      {"aim",
       [](LineReader& in) {
         const std::string light = in.word("a light");
         return action::Aim{light, in.vector("a point: x y z")};
       }},
      {"look-through", [](LineReader& in) { return action::LookThrough{in.word("a light")}; }},
      {"store", [](LineReader& in) { return action::Store{in.slot()}; }},
      {"compare",
       [](LineReader& in) {
         if (in.take("off")) return action::Compare{-1, 1};
         const int slot = in.slot();
         return action::Compare{slot, in.number("the share of the width that shows what is now")};
       }},
      {"restore", [](LineReader& in) { return action::RestoreState{in.slot()}; }},
      {"probe",
       [](LineReader& in) {
         const std::string name = in.word("a name");
         return action::Pin{name, readPoint(in)};
       }},
      {"read", readRead},
      {"field", readField},
      {"point",
       [](LineReader& in) {
         const double x = in.number("a pixel: x y");
         return action::PointAt{x, in.number("a pixel: x y")};
       }},
      {"explain", [](LineReader& in) { return action::Explain{readPoint(in)}; }},
      {"ev", readExposure},
      {"tone", readTone},
      {"falsecolour", readFalse},
      {"overlay",
       [](LineReader& in) {
         const std::string name = in.word("mesh, particles, textures or statistics");
         if (name != "mesh" && name != "particles" && name != "textures" && name != "statistics")
           in.fail(fmt::format("there is no overlay '{}'", name), "mesh, particles, textures or statistics");
         return action::Overlay{name, in.onOff()};
       }},
      {"section", readSection},
      {"bookmark",
       [](LineReader& in) {
         return action::Bookmark{in.count("a number", 1, 9), false};
       }},
      {"goto",
       [](LineReader& in) {
         return action::Bookmark{in.count("a bookmark's number", 1, 9), true};
       }},
      {"layer",
       [](LineReader& in) {
         const std::string name = in.word("cache or picture");
         if (name != "cache" && name != "picture")
           in.fail(fmt::format("there is no layer '{}'", name), "cache or picture");
         return action::Layer{name, in.onOff()};
       }},
      {"screenshot",
       [](LineReader& in) {
         const bool window = in.take("window");
         return action::Screenshot{in.word("a .png file"), window};
       }},
      {"radiance", [](LineReader& in) { return action::SaveRadiance{in.word("an .exr or .hdr file")}; }},
      {"save", [](LineReader& in) { return action::SaveSolution{in.word("a .dlx file")}; }},
      {"quit", [](LineReader&) { return action::Quit{}; }},
  };
  return readers;
}

Action readAction(LineReader& in) {
  const auto reader = actionReaders().find(in.command());
  if (reader == actionReaders().end()) {
    std::vector<std::string> names;
    for (const auto& [name, read] : actionReaders()) names.push_back(name);
    in.fail(fmt::format("there is no action '{}'", in.command()),
            fmt::format("nearest: {}", fmt::join(nearMisses(in.command(), names), ", ")));
  }
  Action action = reader->second(in);
  in.end();
  return action;
}

}  // namespace

Script parseScript(std::string_view text, const std::string& file, const std::filesystem::path& folder) {
  Script script;
  script.file = file;
  int number = 0;
  bool begun = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    LineReader in(file, ++number, folder, line);
    if (in.empty()) continue;
    if (in.command() == "size") {
      if (begun) in.fail("'size' comes first", "the picture keeps its size");
      script.width = in.count("width and height", 16, 8192);
      script.height = in.count("width and height", 16, 8192);
      script.panels = in.take("panels");
      in.end();
    } else {
      script.lines.push_back({number, std::string(line), readAction(in)});
    }
    begun = true;
  }
  return script;
}

Script loadScript(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || std::filesystem::is_directory(path) || !(text << in.rdbuf()))
    throw InputError(path.string(), 0, "cannot be read", "a script of the viewer, one action a line");
  return parseScript(text.str(), path.string(), path.parent_path());
}

}  // namespace deltalux::viewer
