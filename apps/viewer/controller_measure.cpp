// The cursor, meters that stay, and why it is bright.
#include <algorithm>
#include <deltalux/error.hpp>

#include "controller.hpp"

namespace deltalux::viewer {

std::optional<MeshHit> Controller::meshHit(double x, double y) const {
  if (!mesh_ || width_ <= 0 || height_ <= 0) return std::nullopt;
  const ViewRay ray = rayThrough(camera_, width_, height_, x, y);
  return pick_.first(ray.origin, ray.direction, draw_.section);
}

std::optional<SurfaceHit> Controller::hitAt(double x, double y) const {
  const std::optional<MeshHit> hit = meshHit(x, y);
  return hit ? std::optional(hit->surface) : std::nullopt;
}

// The cursor.

void Controller::pointAt(double x, double y) {
  if (cursorAt_ && *cursorAt_ == glm::dvec2(x, y) && cursorQuestion_.answered) return;
  cursorAt_ = glm::dvec2(x, y);
  lookUnderCursor();
  askNext();
}

/// What the mesh itself says of the place: until the solver has answered.
void Controller::lookUnderCursor() {
  cursor_ = {};
  cursorQuestion_ = {};
  if (!cursorAt_ || !ready()) return;
  const std::optional<MeshHit> hit = meshHit(cursorAt_->x, cursorAt_->y);
  if (!hit) return;
  const SurfaceHit& surface = hit->surface;
  const SurfaceMesh& side = *mesh_->surfaces[SolutionMesh::side(surface.primitive, surface.front)];
  cursor_.known = true;
  cursor_.point = {surface.position, surface.normal};
  cursor_.primitive = surface.primitive;
  cursor_.object = scene()[surface.primitive].object;
  cursor_.material = scene()[surface.primitive].material;
  cursor_.lux = photometric(glm::dvec3(hit->irradiance), scene().luminousEfficacy);
  cursor_.candelaPerSquareMetre = photometric(
      glm::dvec3(side.radiance) + glm::dvec3(side.albedo * hit->irradiance) / kPi, scene().luminousEfficacy);
  cursorQuestion_.point = cursor_.point;
}

void Controller::explain(const ProbePoint& point) {
  explanation_.reset();
  explainQuestion_ = {point, 0, false};
  askNext();
}

/// One question at a time, and only while the light stands still: a drag needs the solver for itself.
void Controller::askNext() {
  if (!settled()) return;
  const auto open = [](const Question& q) { return q.point && !q.answered; };
  const auto asked = [&](const Question& q) { return open(q) && q.number != 0; };
  if (asked(explainQuestion_)) return;
  if (open(explainQuestion_))
    explainQuestion_.number = solver_->ask(*explainQuestion_.point), cursorQuestion_.number = 0;
  else if (open(cursorQuestion_) && !asked(cursorQuestion_))
    cursorQuestion_.number = solver_->ask(*cursorQuestion_.point, camera_.position);
}

void Controller::takeAnswer(const Answer& answer) {
  const bool now = mesh_ && answer.version == mesh_->version;
  if (answer.question == explainQuestion_.number && explainQuestion_.point) {
    explanation_ = answer.contributions;
    explainQuestion_.number = 0, explainQuestion_.answered = now;
  }
  if (answer.question == cursorQuestion_.number && cursorQuestion_.point) {
    cursorQuestion_.number = 0, cursorQuestion_.answered = now;
    cursor_.lux = photometric(answer.reading.irradiance, scene().luminousEfficacy);
    if (answer.radiance)
      cursor_.candelaPerSquareMetre = photometric(glm::dvec3(*answer.radiance), scene().luminousEfficacy);
    cursor_.contributions = answer.contributions;
  }
}

// Meters.

void Controller::pinMeters() {
  std::vector<ProbePoint> points;
  for (const Probe& p : probes_) points.push_back(p.point);
  if (field_)
    for (int j = 0; j < field_->rows; ++j)
      for (int i = 0; i < field_->columns; ++i)
        points.push_back(
            {field_->corner + (i + 0.5) / field_->columns * field_->across + (j + 0.5) / field_->rows * field_->along,
             field_->normal});
  pinned_ = solver_->pin(std::move(points));
  historyIsOfMesh_ = false;
}

void Controller::pinProbe(const std::string& name, const ProbePoint& point) {
  const auto at = std::find_if(probes_.begin(), probes_.end(), [&](const Probe& p) { return p.name == name; });
  if (at == probes_.end())
    probes_.push_back({name, point, 0, false, {}});
  else
    *at = {name, point, 0, false, {}};
  pinMeters();
}

void Controller::unpinProbe(const std::string& name) {
  if (std::erase_if(probes_, [&](const Probe& p) { return p.name == name; }) == 0) {
    std::vector<std::string> existing;
    for (const Probe& p : probes_) existing.push_back(p.name);
    std::string hint;
    for (const std::string& near : nearMisses(name, existing)) hint += (hint.empty() ? "nearest: " : ", ") + near;
    throw InputError("", 0, "there is no probe '" + name + "'", hint);
  }
  pinMeters();
}

void Controller::setField(std::optional<MeterField> field) {
  if (field) {
    if (field->columns < 1 || field->rows < 1) throw InputError("", 0, "a field of meters has at least one", "");
    if (!(glm::length(field->normal) > 0)) throw InputError("", 0, "the normal of a field has a length", "");
    field->normal = glm::normalize(field->normal);
    field->exact = false;
  }
  field_ = std::move(field);
  pinMeters();
}

void Controller::takeReadings(const Readings& readings) {
  if (readings.pinned != pinned_ || !ready()) return;  // of points that are no longer meant
  constexpr std::size_t kHistory = 256;
  const bool exact = readings.exact && mesh_ && readings.version >= mesh_->version;
  const auto lux = [&](std::size_t i) { return photometric(readings.results[i].irradiance, scene().luminousEfficacy); };
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    Probe& probe = probes_[i];
    // An exact reading takes the place of what the mesh said of the same light.
    if (readings.exact && !probe.history.empty() && historyIsOfMesh_) probe.history.pop_back();
    probe.lux = lux(i), probe.exact = exact;
    probe.history.push_back(static_cast<float>(probe.lux));
    if (probe.history.size() > kHistory) probe.history.pop_front();
  }
  historyIsOfMesh_ = !readings.exact;
  if (!field_) return;
  field_->exact = exact;
  field_->mean = 0, field_->least = kInfinity;
  const std::size_t count = readings.results.size() - probes_.size();
  for (std::size_t i = 0; i < count; ++i) {
    field_->mean += lux(probes_.size() + i) / static_cast<double>(count);
    field_->least = std::min(field_->least, lux(probes_.size() + i));
  }
  field_->uniformity = field_->mean > 0 ? field_->least / field_->mean : 0;
}

}  // namespace deltalux::viewer
