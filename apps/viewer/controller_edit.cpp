// Choosing, editing, and states that are kept.
#include <algorithm>
#include <deltalux/error.hpp>

#include "controller.hpp"
#include "lamps.hpp"

namespace deltalux::viewer {

namespace {

[[noreturn]] void refuseAction(const std::string& message, const std::string& hint = {}) {
  throw InputError("", 0, message, hint);
}

Box boundsOfAll(const Scene& scene, const std::vector<PrimitiveId>& primitives) {
  Box box;
  for (const PrimitiveId p : primitives)
    if (const Box own = bounds(scene[p].shape); !own.empty()) box.extend(own);
  return box;
}

/// What the name stands for: the surfaces of objects, or those of lights.
std::vector<PrimitiveId> primitivesNamed(const Scene& scene, const std::string& name) {
  std::vector<PrimitiveId> found;
  for (const ObjectId object : findObjects(scene, name))
    for (const PrimitiveId p : primitivesOf(scene, object)) found.push_back(p);
  if (!found.empty()) return found;
  for (const LightId light : findLights(scene, name))
    if (const auto* area = std::get_if<AreaLight>(&scene[light].emitter)) found.push_back(area->primitive);
  return found;
}

/// What an edit moves, if it is one that moves things.
std::vector<PrimitiveId> movedBy(const Scene& scene, const Edit& edit) {
  std::vector<PrimitiveId> moved;
  if (const auto* restore = std::get_if<Restore>(&edit))
    for (const auto& state : restore->primitives) moved.push_back(state.primitive);
  else if (const auto* transform = std::get_if<TransformObject>(&edit))
    moved = primitivesNamed(scene, transform->object);
  else if (const auto* light = std::get_if<MoveLight>(&edit))
    moved = primitivesNamed(scene, light->light);
  return moved;
}

}  // namespace

// Choosing.

void Controller::select(const std::string& name) {
  if (!ready()) refuseAction("there is nothing to select yet");
  if (!name.empty() && findObjects(scene(), name).empty() && findLights(scene(), name).empty()) {
    std::vector<std::string> existing;
    for (const Object& o : scene().objects) existing.push_back(o.name);
    for (const Light& l : scene().lights) existing.push_back(l.name);
    std::string hint;
    for (const std::string& near : nearMisses(name, existing)) hint += (hint.empty() ? "nearest: " : ", ") + near;
    refuseAction("there is no object or light '" + name + "'", hint);
  }
  if (name == selection_) return;
  selection_ = name;
  if (!name.empty()) solver_->select(name);
}

std::vector<PrimitiveId> Controller::selectedPrimitives() const {
  return selection_.empty() ? std::vector<PrimitiveId>{} : primitivesNamed(scene(), selection_);
}

std::string Controller::nameAt(double x, double y, bool deep) const {
  const std::optional<SurfaceHit> hit = hitAt(x, y);
  if (!hit) return {};
  const ObjectId lowest = scene()[hit->primitive].object;
  if (!lowest.valid()) return {};
  // What is half as large as all that there is, is the building and no thing in it.
  constexpr double kBuilding = 0.5;
  ObjectId chosen = lowest;
  if (!deep)
    for (ObjectId o = lowest; o.valid(); o = scene()[o].parent)
      if (boundsOfAll(scene(), primitivesOf(scene(), o)).diagonal() < kBuilding * bounds(scene()).diagonal())
        chosen = o;
  return scene()[chosen].name;
}

// Editing.

void Controller::send(std::vector<Edit> edits, bool moving) {
  resting_ = !moving;
  if (!session_->recordProblem().empty()) lastError = session_->recordProblem();
  if (edits.empty()) return;
  handMoved_.clear();
  for (const Edit& edit : edits)
    for (const PrimitiveId p : movedBy(scene(), edit)) handMoved_.push_back(p);
  std::sort(handMoved_.begin(), handMoved_.end());
  handMoved_.erase(std::unique(handMoved_.begin(), handMoved_.end()), handMoved_.end());
  storedEarly_ = {};
  editsSent_ = solver_->apply(std::move(edits), moving);
}

void Controller::edit(const Edit& edit) {
  if (!ready()) refuseAction("there is nothing to edit yet");
  if (dragging()) endDrag();
  send({session_->apply(edit)}, false);
}

void Controller::adjust(const Edit& edit) {
  if (!ready()) refuseAction("there is nothing to edit yet");
  if (dragging()) endDrag();
  send(session_->adjust(edit), true);
}

void Controller::endAdjust() {
  if (!ready() || !session_->adjusting()) return;
  session_->endAdjust();
  send({}, false);
  solver_->rest();
}

void Controller::beginDrag() {
  if (!ready() || selection_.empty()) refuseAction("nothing is selected", "select an object or a light first");
  if (dragging()) endDrag();
  session_->beginDrag(selection_);
}

void Controller::dragTo(const Mat4& fromStart) {
  if (!dragging()) refuseAction("nothing is dragged");
  send(session_->dragTo(fromStart), true);
}

void Controller::endDrag() {
  if (!dragging()) return;
  session_->endDrag();
  send({}, false);
  solver_->rest();
}

void Controller::undo() {
  if (dragging()) endDrag();
  if (!ready() || !session_->canUndo()) refuseAction("there is nothing to undo");
  send({session_->undo()}, false);
}

void Controller::redo() {
  if (dragging()) endDrag();
  if (!ready() || !session_->canRedo()) refuseAction("there is nothing to redo");
  send({session_->redo()}, false);
}

void Controller::dim(const std::string& light, double factor) { edit(ScaleLight{light, static_cast<float>(factor)}); }
void Controller::colour(const std::string& light, const Rgb& rgb) { edit(ColourLight{light, rgb}); }
void Controller::switchLight(const std::string& light, bool on) { edit(SwitchLight{light, on}); }
void Controller::paint(const std::string& material, const Rgb& reflectance) {
  edit(SetMaterial{material, reflectance, std::nullopt});
}

LightId Controller::firstLight(const std::string& name) const {
  if (!ready()) refuseAction("there is no light yet");
  const std::vector<LightId> lights = findLights(scene(), name);
  if (lights.empty()) validateEdit(scene(), SwitchLight{name, true});  // refuses it, with near misses
  return lights.front();
}

void Controller::aim(const std::string& light, const Vec3& at) {
  const std::optional<Vec3> place = placeOf(scene(), firstLight(light));
  if (!place) refuseAction("the light '" + light + "' is at infinity: it cannot be aimed at a point");
  edit(AimLight{light, at - *place});
}

void Controller::lookThrough(const std::string& light) {
  const LightId id = firstLight(light);
  const std::optional<Vec3> place = placeOf(scene(), id);
  if (!place) refuseAction("the light '" + light + "' is at infinity: nobody can look from there");
  View view = camera_;
  view.kind = View::Kind::Perspective;
  view.direction = aimOf(scene(), id).value_or(-scene().up);
  view.up = scene().up;
  constexpr double kParallel = 1e-3;
  if (glm::length(glm::cross(glm::normalize(view.direction), glm::normalize(view.up))) < kParallel)
    view.up = deltalux::Frame(glm::normalize(view.direction)).tangent;
  view.position = *place;
  // In front of its own surface: of flat ones just so, of others outside of what surrounds the middle.
  if (const auto* area = std::get_if<AreaLight>(&scene()[id].emitter)) {
    const double size = bounds(scene()[area->primitive].shape).diagonal();
    constexpr double kFlat = 1e-3, kRound = 0.51;
    view.position += (aimOf(scene(), id) ? kFlat : kRound) * size * glm::normalize(view.direction);
  }
  view.horizontal = view.vertical = openingOf(scene(), id);
  setCamera(view);
}

// States.

const std::optional<Session::Stored>& Controller::storedAt(int slot) const {
  const auto& stored = session_->stored();
  const auto at = static_cast<std::size_t>(slot);
  if (slot < 0 || at >= stored.size() || !stored[at])
    refuseAction(std::string("nothing is stored as ") + (slot == 0 ? "A" : "B"), "store a state there first");
  return stored[at];
}

void Controller::store(int slot) {
  if (!ready()) refuseAction("there is nothing to store yet");
  if (slot != 0 && slot != 1) refuseAction("states are stored as A or B");
  if (dragging()) endDrag();
  session_->store(static_cast<std::size_t>(slot), slot == 0 ? "A" : "B", mesh_);
  storedEarly_[static_cast<std::size_t>(slot)] = !settled() || !status_.exact;
}

void Controller::compare(int slot, double wipe) {
  if (wipe >= 1) {
    compared_ = -1, wipe_ = 1;
    return;
  }
  if (!ready()) refuseAction("there is nothing to compare yet");
  storedAt(slot);
  compared_ = slot;
  wipe_ = std::max(wipe, 0.0);
}

void Controller::restore(int slot) {
  if (!ready()) refuseAction("there is nothing to restore yet");
  storedAt(slot);
  if (dragging()) endDrag();
  send(session_->restore(static_cast<std::size_t>(slot)), false);
}

}  // namespace deltalux::viewer
