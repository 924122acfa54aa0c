#include "support/random_edits.hpp"

#include <algorithm>
#include <deltalux/error.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "edit_list.hpp"

namespace deltalux::test {

namespace {
constexpr int kTogether = 4;  // edits that are taken back by one update
}  // namespace

Editable everythingIn(const Scene& scene, const std::filesystem::path& list) {
  Editable all;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  if (list.empty())
    for (const Object& object : scene.objects) add(all.objects, object.name);
  else
    for (const bench::EditPhase& phase : bench::loadEditList(list, scene))
      for (const bench::NamedEdit& edit : phase.edits)
        if (edit.kind == "move" || edit.kind == "move lamp") add(all.objects, edit.subject);
  for (const Light& light : scene.lights) {
    add(all.lights, light.name);
    if (!std::holds_alternative<AreaLight>(light.emitter)) add(all.placed, light.name);
  }
  if (all.placed.empty()) all.placed = all.lights;
  for (const Material& material : scene.materials) add(all.paints, material.name);
  all.rough = all.paints;
  all.reach = 0.4 / scene.metresPerUnit;
  return all;
}

StepReport RandomEdits::step() {
  for (;;) {
    const Edit edit = choose();
    last_ = std::to_string(done()) + ": " + editOperation(edit) + " " + editSubject(edit);
    try {
      undo_.push_back(engine_.apply(edit));
    } catch (const InputError&) {
      continue;  // of what is not there just now
    }
    if (std::holds_alternative<RemoveObject>(edit)) gone_.push_back(undo_.back());
    return engine_.update();
  }
}

void RandomEdits::undoAll() {
  for (int since = 1; !undo_.empty(); ++since) {
    engine_.apply(undo_.back());
    undo_.pop_back();
    if (since % kTogether == 0 || undo_.empty()) engine_.update();
  }
  gone_.clear();
  scaled_.assign(scaled_.size(), 0);
}

Edit RandomEdits::choose() {
  switch (pickIndex(12)) {
    case 0:
    case 1:
    case 2: {
      Mat4 matrix(1.0);
      matrix[3] = glm::dvec4(between(-1, 1), between(-1, 1), between(0, 1), 1.0 / what_.reach) * what_.reach;
      return TransformObject{pick(what_.objects), matrix};
    }
    case 3:
      return turn(pick(what_.objects));
    case 4:
      return RemoveObject{pick(what_.objects)};
    case 5:
    case 6: {
      if (gone_.empty()) return dim();
      const Restore back = gone_.back();
      gone_.pop_back();
      return back;
    }
    case 7:
      return dim();
    case 8:
      return SwitchLight{pick(what_.lights), rng_.uniform() < 0.6};
    case 9:
      if (rng_.uniform() < 0.5) return AimLight{pick(what_.placed), Vec3(between(-0.5, 0.5), between(-0.5, 0.5), -1)};
      return MoveLight{pick(what_.placed), what_.reach * Vec3(between(-1, 1), between(-1, 1), 0)};
    case 10:
      return SetMaterial{pick(what_.rough), {}, static_cast<float>(between(0.05, 0.3))};
    default:
      return SetMaterial{pick(what_.paints),
                         Rgb(static_cast<float>(between(0.2, 0.8)), static_cast<float>(between(0.2, 0.8)),
                             static_cast<float>(between(0.2, 0.8))),
                         {}};
  }
}

Edit RandomEdits::turn(const std::string& object) {
  const Scene& scene = engine_.solution().scene();
  Box box;
  for (const ObjectId id : findObjects(scene, object))
    for (const PrimitiveId p : primitivesOf(scene, id)) box.extend(bounds(scene[p].shape));
  const Vec3 about = box.empty() ? Vec3(0.0) : box.center();
  const Mat4 turned = glm::rotate(Mat4(1.0), between(-0.5, 0.5), scene.up);
  return TransformObject{object, glm::translate(Mat4(1.0), about) * turned * glm::translate(Mat4(1.0), -about)};
}

/// Twice or half as bright, never further than four times from where it was.
Edit RandomEdits::dim() {
  const std::size_t light = pickIndex(what_.lights.size());
  const int by = scaled_[light] == 2 || (scaled_[light] > -2 && rng_.uniform() < 0.5) ? -1 : 1;
  scaled_[light] += by;
  return ScaleLight{what_.lights[light], by > 0 ? 2.0f : 0.5f};
}

}  // namespace deltalux::test
