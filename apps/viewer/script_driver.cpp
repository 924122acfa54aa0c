#include "script_driver.hpp"

#include <atomic>
#include <deltalux/error.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <mutex>
#include <nlohmann/json.hpp>

#include "window.hpp"

namespace deltalux::viewer {

namespace {

using Json = nlohmann::ordered_json;

/// Median, 95th percentile and worst of some times [ms].
Json spreadOf(std::vector<double> values) {
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * double(values.size())))];
  };
  const auto rounded = [](double v) { return std::round(100 * v) / 100; };
  return {{"median", rounded(at(0.5))}, {"p95", rounded(at(0.95))}, {"worst", rounded(values.back())}};
}

Json jsonOf(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// What the window shows in this turn.
struct Turn {
  const gl::Renderer& renderer;
  const DrawReport& drawing;
  const Window* window;
};

double radians(double degrees) { return degrees * kPi / 180; }

}  // namespace

struct ScriptDriver::State {
  Script script;
  const Window* window = nullptr;
  Clock::time_point start;
  std::function<void(const std::string&)> print;

  std::size_t at = 0;
  bool begun = false;           // the present line has had a turn
  Clock::time_point lineBegan;  // its first turn
  int turns = 0;                // of the present line
  Clock::time_point released;   // what was done last that has to settle
  bool fieldFresh = false;

  // Of a drag.
  int frame = 0;
  Vec3 centre{0};
  Clock::time_point moved;
  std::vector<double> latency, drawing;

  struct Saving {
    std::mutex lock;
    bool done = false;
    std::string error;
  };
  std::shared_ptr<Saving> saving;

  State(Script s, Clock::time_point t, std::function<void(const std::string&)> p)
      : script(std::move(s)), start(t), print(std::move(p)), released(t) {}

  static double since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }
  const ScriptLine& line() const { return script.lines[at]; }
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const {
    throw InputError(script.file, line().line, what, hint);
  }
  void tell(Json entry) const {
    Json all = {{"line", line().line}};
    all.update(entry);
    print(all.dump());
  }

  // Each returns whether the line is done.
  bool play(const action::Wait& a, Controller& c, const Turn&) {
    if (c.status().phase == Phase::Failed) fail("the scene could not be solved: " + c.status().message, "");
    const bool reached = a.until == action::Until::Ready     ? c.ready()
                         : a.until == action::Until::Settled ? c.ready() && c.settled()
                                                             : c.ready() && c.finished();
    if (!reached && since(lineBegan) > a.seconds)
      fail(fmt::format("waited {:g} s", a.seconds), "a longer time at the end of the line, if it really takes so long");
    if (!reached || turns == 0) return false;
    const char* const until[] = {"ready", "settled", "finished"};
    tell({{"action", "wait"},
          {"for", until[static_cast<int>(a.until)]},
          {"since_start_s", since(start)},
          {"since_edit_s", since(released)},
          {"settle_s", c.status().settleSeconds}});
    return true;
  }
  bool play(const action::Frames& a, Controller&, const Turn&) { return turns >= a.count; }
  bool play(const action::Look& a, Controller& c, const Turn&) {
    for (const View& view : c.scene().views)
      if (view.name == a.view) return c.setCamera(view), true;
    if (!std::filesystem::is_regular_file(a.view)) {
      std::vector<std::string> names;
      for (const View& view : c.scene().views) names.push_back(view.name);
      fail(fmt::format("there is no view or view file '{}'", a.view),
           fmt::format("nearest: {}", fmt::join(nearMisses(a.view, names), ", ")));
    }
    c.setCamera(inScene(c.scene(), loadView(a.view)));
    return true;
  }
  bool play(const action::Camera& a, Controller& c, const Turn&) {
    View view = c.camera();
    view.position = a.position - c.scene().origin;
    view.direction = a.direction;
    if (a.up) view.up = *a.up;
    if (a.angle) view.horizontal = *a.angle;
    c.setCamera(view);
    return true;
  }
  bool play(const action::Walk& a, Controller& c, const Turn&) {
    View view = c.camera();
    move(view, a.rightForwardUp, true);
    c.setCamera(view);
    return true;
  }
  bool play(const action::Turn& a, Controller& c, const Turn&) {
    View view = c.camera();
    turn(view, radians(a.yaw), radians(a.pitch));
    c.setCamera(view);
    return true;
  }
  bool play(const action::Orbit& a, Controller& c, const Turn&) {
    const auto hit = c.hitAt(a.x, a.y);
    if (!hit) fail("nothing is seen at that pixel", "a pixel over a surface");
    View view = c.camera();
    orbit(view, hit->position, radians(a.yaw), radians(a.pitch));
    c.setCamera(view);
    return true;
  }
  bool play(const action::Select& a, Controller& c, const Turn&) { return c.select(a.name), true; }
  bool play(const action::SelectAt& a, Controller& c, const Turn&) {
    c.select(c.nameAt(a.x, a.y));
    tell({{"action", "select"}, {"name", c.selection()}});
    return true;
  }
  Vec3 centreOfSelection(Controller& c) const {
    Box box;
    for (const ObjectId id : findObjects(c.scene(), c.selection()))
      for (const PrimitiveId p : primitivesOf(c.scene(), id)) {
        const Box b = bounds(c.scene()[p].shape);
        if (!b.empty()) box.extend(b);
      }
    return box.center() + c.scene().origin;
  }
  Mat4 dragged(const action::Drag& a, double share) const {
    if (!a.axis) return glm::translate(Mat4(1.0), share * a.offset);
    const Mat4 there = glm::translate(Mat4(1.0), centre);
    return there * glm::rotate(Mat4(1.0), radians(share * a.degrees), *a.axis) * glm::translate(Mat4(1.0), -centre);
  }
  void noteTurn(const Turn& v) {
    latency.push_back(1e3 * since(moved));
    drawing.push_back(v.drawing.milliseconds);
  }
  /// Of each turn, what drawing did not take.
  std::vector<double> besides() const {
    std::vector<double> rest;
    for (std::size_t i = 0; i < latency.size(); ++i) rest.push_back(std::max(0.0, latency[i] - drawing[i]));
    return rest;
  }
  void tellGesture(const char* action, const std::string& of, int frames, const Turn& v) {
    released = Clock::now();
    tell({{"action", action},
          {"object", of},
          {"frames", frames},
          {"latency_ms", spreadOf(latency)},
          {"draw_ms", spreadOf(drawing)},
          {"besides_ms", spreadOf(besides())},
          {"triangles", v.drawing.triangles},
          {"uploaded_bytes", v.drawing.uploadedBytes}});
  }
  bool play(const action::Dim& a, Controller& c, const Turn& v) {
    if (turns == 0)
      frame = 0, latency.clear(), drawing.clear();
    else
      noteTurn(v);
    if (frame < a.frames) {
      ++frame;
      moved = Clock::now();
      c.adjust(ScaleLight{a.light, static_cast<float>(1 + (a.factor - 1) * frame / a.frames)});
      return false;
    }
    c.endAdjust();
    tellGesture("dim", a.light, a.frames, v);
    return true;
  }
  bool play(const action::Drag& a, Controller& c, const Turn& v) {
    if (turns == 0) {
      if (c.selection().empty()) fail("nothing is selected", "select NAME, before it is dragged");
      frame = 0;
      latency.clear(), drawing.clear();
      centre = centreOfSelection(c);
      c.beginDrag();
    } else {
      noteTurn(v);
    }
    if (frame < a.frames) {
      ++frame;
      moved = Clock::now();
      c.dragTo(dragged(a, double(frame) / a.frames));
      return false;
    }
    c.endDrag();
    tellGesture("drag", c.selection(), a.frames, v);
    return true;
  }
  bool play(const action::Apply& a, Controller& c, const Turn&) {
    released = Clock::now();
    if (const auto* edit = std::get_if<Edit>(&a.step))
      c.edit(*edit);
    else if (std::holds_alternative<Undo>(a.step))
      c.session().canUndo() ? c.undo() : fail("there is nothing to undo", "an edit before it");
    else
      c.session().canRedo() ? c.redo() : fail("there is nothing to redo", "an undo before it");
    return true;
  }
  bool play(const action::Aim& a, Controller& c, const Turn&) {
    released = Clock::now();
    return c.aim(a.light, a.at - c.scene().origin), true;
  }
  bool play(const action::LookThrough& a, Controller& c, const Turn&) { return c.lookThrough(a.light), true; }
  bool play(const action::Store& a, Controller& c, const Turn&) { return c.store(a.slot), true; }
  bool play(const action::Compare& a, Controller& c, const Turn&) { return c.compare(a.slot, a.wipe), true; }
  bool play(const action::RestoreState& a, Controller& c, const Turn&) {
    released = Clock::now();
    return c.restore(a.slot), true;
  }
  bool play(const action::Pin& a, Controller& c, const Turn&) {
    ProbePoint point = a.point;
    point.position -= c.scene().origin;
    return c.pinProbe(a.name, point), true;
  }
  bool play(const action::Read& a, Controller& c, const Turn&) {
    const auto& probes = c.probes();
    const auto probe = std::find_if(probes.begin(), probes.end(), [&](const Probe& p) { return p.name == a.name; });
    if (probe == probes.end()) fail(fmt::format("there is no probe '{}'", a.name), "probe NAME x y z nx ny nz");
    if (probe->history.empty() || (c.settled() && !probe->exact)) return waitForReading(c);
    tell({{"action", "read"}, {"probe", a.name}, {"lux", probe->lux}, {"exact", probe->exact}});
    if (a.lux && !(std::abs(probe->lux - *a.lux) <= a.tolerance * std::abs(*a.lux)))
      fail(fmt::format("probe '{}' reads {:.4g} lx", a.name, probe->lux),
           fmt::format("the script says {:g} lx within {:g} %", *a.lux, 100 * a.tolerance));
    return true;
  }
  bool waitForReading(Controller&) const {
    if (since(lineBegan) > 120) fail("no reading came", "is the scene solved by then?");
    return false;
  }
  bool play(const action::Field& a, Controller& c, const Turn&) {
    std::optional<MeterField> field = a.field;
    if (field) field->corner -= c.scene().origin;
    return c.setField(field), true;
  }
  bool play(const action::ReadField&, Controller& c, const Turn&) {
    if (!c.field()) fail("there is no field of meters", "field, with a corner and its sides");
    if (c.field()->mean == 0 || (c.settled() && !c.field()->exact)) return waitForReading(c);
    const MeterField& f = *c.field();
    tell(
        {{"action", "read"}, {"field", {{"Em", f.mean}, {"Emin", f.least}, {"U0", f.uniformity}}}, {"exact", f.exact}});
    return true;
  }
  bool play(const action::PointAt& a, Controller& c, const Turn& v) {
    if (turns == 0) c.pointAt(a.x, a.y);
    const UnderCursor& under = c.underCursor();
    if (!under.known) {
      if (turns > 0 && !c.hitAt(a.x, a.y)) fail("nothing is seen at that pixel", "a pixel over a surface");
      return false;
    }
    if (!under.contributions || turns < 2) return waitForReading(c);
    const DisplayImage seen = v.renderer.screenshot();
    const auto& colour = seen.at(std::clamp(static_cast<int>(a.x), 0, seen.width - 1),
                                 std::clamp(static_cast<int>(a.y), 0, seen.height - 1));
    Json lamps = Json::object();
    for (const auto& lamp : under.contributions->lamps)
      lamps[c.scene()[lamp.light].name] = photometric(lamp.E, c.scene().luminousEfficacy);
    tell({{"action", "point"},
          {"position", jsonOf(under.point.position + c.scene().origin)},
          {"normal", jsonOf(under.point.normal)},
          {"object", under.object.valid() ? c.scene()[under.object].name : ""},
          {"lux", under.lux},
          {"cd_m2", under.candelaPerSquareMetre},
          {"colour", colour},
          {"lamps_lux", lamps}});
    return true;
  }
  bool play(const action::Explain& a, Controller& c, const Turn&) {
    if (turns == 0) {
      ProbePoint point = a.point;
      point.position -= c.scene().origin;
      c.explain(point);
      return false;
    }
    if (!c.explanation()) return waitForReading(c);
    const Contributions& all = *c.explanation();
    const double k = c.scene().luminousEfficacy;
    Json lamps = Json::object(), surfaces = Json::object(), paths = Json::array();
    for (const auto& lamp : all.lamps) lamps[c.scene()[lamp.light].name] = photometric(lamp.E, k);
    for (const auto& s : all.surfaces) surfaces[s.object.valid() ? c.scene()[s.object].name : ""] = photometric(s.E, k);
    for (const auto& path : all.paths)
      paths.push_back(
          {{"lux", photometric(path.E, k)}, {"corners", path.corners.size()}, {"particles", path.particles}});
    tell({{"action", "explain"},
          {"direct_lux", photometric(all.direct, k)},
          {"indirect_lux", photometric(all.indirect, k)},
          {"particle_lux", photometric(all.particle, k)},
          {"lamps_lux", lamps},
          {"surfaces_lux", surfaces},
          {"paths", paths}});
    return true;
  }
  bool play(const action::Exposure& a, Controller& c, const Turn& v) {
    if (a.ev)
      c.draw().tone.ev = *a.ev;
    else if (turns == 0)
      return false;
    else
      c.wantExposureFrom(v.renderer.radiance());
    return true;
  }
  bool play(const action::Tone& a, Controller& c, const Turn&) {
    c.draw().tone.toneOperator = a.tone;
    return true;
  }
  bool play(const action::False& a, Controller& c, const Turn&) {
    c.draw().falseColour = a.falseColour;
    return true;
  }
  bool play(const action::Overlay& a, Controller& c, const Turn&) {
    Overlays& o = c.draw().overlays;
    (a.name == "mesh"        ? o.mesh
     : a.name == "particles" ? o.particles
     : a.name == "textures"  ? o.textureRegions
                             : o.statistics) = a.on;
    return true;
  }
  bool play(const action::Section& a, Controller& c, const Turn&) {
    c.draw().section = a.box;
    if (a.box) {
      c.draw().section->lower -= c.scene().origin;
      c.draw().section->upper -= c.scene().origin;
    }
    return true;
  }
  bool play(const action::Bookmark& a, Controller& c, const Turn&) {
    if (!a.go) return c.bookmark(a.slot), true;
    if (!c.goToBookmark(a.slot)) fail(fmt::format("bookmark {} is empty", a.slot), "bookmark N keeps a view");
    return true;
  }
  bool play(const action::Layer& a, Controller& c, const Turn&) {
    (a.name == "cache" ? c.draw().cache : c.draw().picture) = a.on;
    return true;
  }
  bool play(const action::Screenshot& a, Controller&, const Turn& v) {
    if (turns < 2) return false;  // what was done before is drawn then
    saveImage(a.file, a.window && v.window ? v.window->capture() : v.renderer.screenshot());
    tell({{"action", "screenshot"}, {"file", a.file.string()}});
    return true;
  }
  bool play(const action::SaveRadiance& a, Controller&, const Turn& v) {
    if (turns < 2) return false;
    saveImage(a.file, v.renderer.radiance());
    return true;
  }
  bool play(const action::SaveSolution& a, Controller& c, const Turn&) {
    if (!saving) {
      saving = std::make_shared<Saving>();
      c.solver().save(a.file.string(), [to = saving](const std::string& error) {
        const std::lock_guard guard(to->lock);
        to->done = true, to->error = error;
      });
      return false;
    }
    const std::shared_ptr<Saving> now = saving;
    const std::lock_guard guard(now->lock);
    if (!now->done) return false;
    saving.reset();
    if (!now->error.empty()) throw OutputError(now->error);
    return true;
  }
  bool play(const action::Quit&, Controller&, const Turn&) {
    at = script.lines.size() - 1;
    return true;
  }
};

ScriptDriver::ScriptDriver(Script script, Clock::time_point start, std::function<void(const std::string&)> print)
    : state_(std::make_unique<State>(std::move(script), start, std::move(print))) {}
ScriptDriver::~ScriptDriver() = default;

void ScriptDriver::attach(Window& window) { state_->window = &window; }

bool ScriptDriver::wantsFrame() const {
  const State& s = *state_;
  return s.at >= s.script.lines.size() || s.turns < 3 || !std::holds_alternative<action::Wait>(s.line().action);
}

bool ScriptDriver::tick(Controller& controller, gl::Renderer& renderer, const DrawReport& drawing) {
  State& s = *state_;
  const Turn view{renderer, drawing, s.window};
  while (s.at < s.script.lines.size()) {
    const ScriptLine& line = s.line();
    // There is nothing to look at, or to edit, before there is a scene.
    if (!std::holds_alternative<action::Wait>(line.action) && !controller.ready()) {
      if (controller.status().phase == Phase::Failed) s.fail(controller.status().message, "");
      return true;
    }
    if (!s.begun) s.begun = true, s.turns = 0, s.lineBegan = Clock::now();
    bool done = false;
    try {
      done = std::visit([&](const auto& a) { return s.play(a, controller, view); }, line.action);
    } catch (const InputError& error) {
      if (error.file() == s.script.file) throw;
      throw InputError(s.script.file, line.line, error.what(), error.file().empty() ? "" : error.hint());
    }
    ++s.turns;
    if (!done) return true;
    s.begun = false;
    ++s.at;
  }
  return false;
}

}  // namespace deltalux::viewer
