#include "edit_list.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <fstream>
#include <set>
#include <sstream>

namespace deltalux::bench {

namespace {

struct Room {
  Vec2 lower{0}, upper{0};

  Vec2 middle() const { return 0.5 * (lower + upper); }
  /// From the nearest point of the room; 0 within.
  double distance(const Vec2& p) const { return glm::distance(p, glm::clamp(p, lower, upper)); }
};

/// The object of that full name, if any.
ObjectId objectNamed(const Scene& scene, std::string_view name) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].name == name) return ObjectId(i);
  return {};
}

Box boundsOf(const Scene& scene, ObjectId object) {
  Box box;
  for (const PrimitiveId p : primitivesOf(scene, object)) box.extend(bounds(scene[p].shape));
  return box;
}

/// Where a thing at `p` is moved to, as a direction.
Vec2 awayFromWall(const Room& room, const Vec2& p) {
  const Vec2 off = (p - room.middle()) / (0.5 * (room.upper - room.lower));
  return std::abs(off.x) > std::abs(off.y) ? Vec2(off.x > 0 ? -1 : 1, 0) : Vec2(0, off.y > 0 ? -1 : 1);
}

class Reader {
 public:
  Reader(const std::string& file, const Scene& scene) : file_(file), scene_(scene) {}

  std::vector<EditPhase> read(std::string_view text) {
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
      ++line_;
      std::istringstream words(line.substr(0, line.find('#')));
      if (std::string word; words >> word) take(word, words);
    }
    line_ = 0;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i)
      if (!scene_.objects[i].parent.valid() && !listed_.contains(i))
        refuse("the list has no object '" + scene_.objects[i].name + "'", "move it, or say that it is fixed");
    return {{"move", std::move(moves_)}, {"lamp", std::move(lamps_)}, {"paint", std::move(paints_)}};
  }

 private:
  [[noreturn]] void refuse(const std::string& message, const std::string& hint = {}) const {
    throw InputError(file_, line_, message, hint);
  }

  void take(const std::string& word, std::istringstream& words) {
    if (word == "step")
      step_ = number(words) / scene_.metresPerUnit;
    else if (word == "room")
      takeRoom(words);
    else if (word == "fixed")
      forEachObject(words, [](ObjectId) {});
    else if (word == "move")
      forEachObject(words, [&](ObjectId o) { moves_.push_back(move("move", o)); });
    else if (word == "lamp")
      forEachObject(words, [&](ObjectId o) { takeLamp(o); });
    else if (word == "paint")
      takePaint(words);
    else
      refuse("no line begins with '" + word + "'");
    if (std::string rest; words.clear(), words >> rest) refuse("'" + rest + "' is too much here");
  }

  double number(std::istringstream& words) const {
    double value = 0;
    if (!(words >> value)) refuse("a number is missing");
    return value;
  }

  void takeRoom(std::istringstream& words) {
    std::string name;
    words >> name;
    Room room;
    for (double* x : {&room.lower.x, &room.lower.y, &room.upper.x, &room.upper.y}) *x = number(words);
    if (!(room.lower.x < room.upper.x && room.lower.y < room.upper.y)) refuse("the room has no area");
    rooms_.push_back(room);
  }

  template <class Visit>
  void forEachObject(std::istringstream& words, const Visit& visit) {
    for (std::string name; words >> name;)
      for (const ObjectId object : objects(name)) {
        if (!visited_.insert(object.index()).second) refuse("the list has '" + name + "' twice");
        for (ObjectId o = object; o.valid(); o = scene_[o].parent) listed_.insert(o.index());
        visit(object);
      }
  }

  std::vector<ObjectId> objects(const std::string& name) const {
    const bool below = name.ends_with(".*");
    const ObjectId named = objectNamed(scene_, below ? name.substr(0, name.size() - 2) : name);
    std::vector<ObjectId> found;
    if (named.valid() && !below) found = {named};
    if (named.valid() && below)
      for (std::size_t i = 0; i < scene_.objects.size(); ++i)
        if (scene_.objects[i].parent == named) found.emplace_back(i);
    if (found.empty()) refuse("the scene has no object '" + name + "'");
    return found;
  }

  NamedEdit move(const char* kind, ObjectId object) const {
    const std::string& name = scene_[object].name;
    if (!(step_ > 0)) refuse("'step' must stand before what moves");
    if (rooms_.empty()) refuse("a room must stand before what moves");
    const Box box = boundsOf(scene_, object);
    if (box.empty()) refuse("'" + name + "' has no surface");
    const Vec2 at(box.center());
    const Room& room = *std::min_element(rooms_.begin(), rooms_.end(),
                                         [&](const Room& a, const Room& b) { return a.distance(at) < b.distance(at); });
    Mat4 matrix(1.0);
    matrix[3] = glm::dvec4(step_ * awayFromWall(room, at), 0, 1);
    return {kind, name, TransformObject{name, matrix}};
  }

  void takeLamp(ObjectId object) {
    const std::string& name = scene_[object].name;
    if (findLights(scene_, name).empty()) refuse("'" + name + "' has no light");
    lamps_.push_back({"dim", name, ScaleLight{name, 0.5f}});
    lamps_.push_back({"off", name, SwitchLight{name, false}});
    lamps_.push_back({"on", name, SwitchLight{name, true}});
    lamps_.push_back(move("move lamp", object));
  }

  void takePaint(std::istringstream& words) {
    std::string material;
    words >> material;
    Rgb rgb(0.0f);
    for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(number(words));
    const SetMaterial edit{material, rgb, {}};
    try {
      validateEdit(scene_, edit);
    } catch (const InputError& error) {
      refuse(error.message(), error.hint());
    }
    paints_.push_back({"paint", material, edit});
  }

  const std::string& file_;
  const Scene& scene_;
  int line_ = 0;
  double step_ = 0;  // in units of the scene
  std::vector<Room> rooms_;
  std::set<std::size_t> visited_, listed_;  // objects; these and all above
  std::vector<NamedEdit> moves_, lamps_, paints_;
};

}  // namespace

std::vector<EditPhase> parseEditList(std::string_view text, const std::string& file, const Scene& scene) {
  return Reader(file, scene).read(text);
}

std::vector<EditPhase> loadEditList(const std::filesystem::path& path, const Scene& scene) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path.string(), 0, "it cannot be read");
  std::ostringstream text;
  text << in.rdbuf();
  return parseEditList(text.str(), path.string(), scene);
}

EditPhase movesSpread(const std::vector<EditPhase>& phases, std::size_t count) {
  std::vector<NamedEdit> moves;
  for (const EditPhase& phase : phases)
    for (const NamedEdit& edit : phase.edits)
      if (edit.kind == "move") moves.push_back(edit);
  count = std::min(count, moves.size());
  EditPhase spread{"move", {}};
  for (std::size_t i = 0; i < count; ++i) spread.edits.push_back(moves[i * moves.size() / count]);
  return spread;
}

}  // namespace deltalux::bench
