#include <fmt/format.h>

#include <algorithm>
#include <deltalux/edit_io.hpp>
#include <deltalux/error.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>

#include "io/edits/edit_json.hpp"
#include "io/import_file.hpp"
#include "io/json_text.hpp"

namespace deltalux {

namespace fs = std::filesystem;

namespace {

constexpr double kLargestCoordinate = 1e9;  // coordinates beyond are mistakes [limit]

/// Reads the entries of one file.
class EntryReader {
 public:
  EntryReader(const std::string& file, const fs::path& folder, const ImportSettings& import)
      : file_(file), folder_(folder), import_(import) {}

  EditStep read(const io::JsonView& entry) {
    entry.expectObject();
    const std::string op = text(entry, "op");
    if (op == "transform") return Edit(transform(entry));
    if (op == "light") return light(entry);
    if (op == "material") return Edit(material(entry));
    if (op == "sky") return Edit(sky(entry));
    if (op == "add") return Edit(add(entry));
    if (op == "remove") return only(entry, {"op", "object"}), Edit(RemoveObject{text(entry, "object")});
    if (op == "undo") return only(entry, {"op"}), EditStep(Undo{});
    if (op == "redo") return only(entry, {"op"}), EditStep(Redo{});
    const std::vector<std::string> known{"transform", "light", "material", "sky", "add", "remove", "undo", "redo"};
    entry.member("op").fail(fmt::format("is '{}'; nearest: {}", op, fmt::join(nearMisses(op, known), ", ")));
  }

 private:
  /// Every key has a meaning here.
  static void only(const io::JsonView& entry, std::initializer_list<const char*> keys) {
    for (const auto& [key, value] : entry.value().items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) entry.fail("has an unknown key '" + key + "'");
  }
  /// The one of `keys` that the entry has.
  static std::string oneOf(const io::JsonView& entry, std::initializer_list<const char*> keys) {
    std::string found;
    for (const char* key : keys)
      if (entry.member(key).present()) {
        if (!found.empty()) entry.fail("has both " + found + " and " + key + ": split it in two");
        found = key;
      }
    if (found.empty())
      entry.fail(fmt::format("needs one of {}", fmt::join(std::vector<std::string>(keys.begin(), keys.end()), ", ")));
    return found;
  }
  static std::string text(const io::JsonView& entry, const char* key) {
    const io::JsonView value = entry.member(key);
    value.expectPresent("every entry of this operation names one");
    value.expectString();
    return value.value().get<std::string>();
  }
  static double number(const io::JsonView& value, double low, double high) {
    value.expectPresent("a number");
    value.expectNumber(low, high);
    return value.value().get<double>();
  }
  static Vec3 triple(const io::JsonView& value, double low = -kLargestCoordinate, double high = kLargestCoordinate) {
    value.expectPresent("three numbers");
    value.expectNumbers(3, low, high);
    return {value.value()[0].get<double>(), value.value()[1].get<double>(), value.value()[2].get<double>()};
  }

  static Mat4 rowMajor(const io::JsonView& value) {
    value.expectNumbers(16, -kLargestCoordinate, kLargestCoordinate);
    Mat4 m;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        m[column][row] = value.value()[static_cast<std::size_t>(4 * row + column)].get<double>();
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
      value.fail("is no affine map: its last row is not 0 0 0 1");
    if (!(std::abs(glm::determinant(m)) > 0)) value.fail("flattens what it maps: its determinant is 0");
    return m;
  }
  static Mat4 rotation(const io::JsonView& value) {
    value.expectObject();
    only(value, {"axis", "degrees", "about"});
    const Vec3 axis = triple(value.member("axis"));
    if (!(glm::length(axis) > 0)) value.member("axis").fail("has no length");
    const double degrees = number(value.member("degrees"), -1e6, 1e6);
    const Vec3 about = value.member("about").present() ? triple(value.member("about")) : Vec3(0);
    return glm::translate(glm::rotate(glm::translate(Mat4(1.0), about), glm::radians(degrees), glm::normalize(axis)),
                          -about);
  }

  static TransformObject transform(const io::JsonView& entry) {
    only(entry, {"op", "object", "translate", "rotate", "matrix"});
    const std::string key = oneOf(entry, {"translate", "rotate", "matrix"});
    const io::JsonView value = entry.member(key.c_str());
    const Mat4 matrix = key == "matrix"   ? rowMajor(value)
                        : key == "rotate" ? rotation(value)
                                          : glm::translate(Mat4(1.0), triple(value));
    return {text(entry, "object"), matrix};
  }

  static EditStep light(const io::JsonView& entry) {
    only(entry, {"op", "light", "scale", "rgb", "on", "aim", "translate"});
    const std::string name = text(entry, "light");
    const std::string key = oneOf(entry, {"scale", "rgb", "on", "aim", "translate"});
    const io::JsonView value = entry.member(key.c_str());
    if (key == "scale") return Edit(ScaleLight{name, static_cast<float>(number(value, 0, kLargestCoordinate))});
    if (key == "rgb") return Edit(ColourLight{name, Rgb(triple(value, 0, kLargestCoordinate))});
    if (key == "on") return value.expectBool(), EditStep(Edit(SwitchLight{name, value.value().get<bool>()}));
    if (key == "translate") return Edit(MoveLight{name, triple(value)});
    const Vec3 direction = triple(value);
    if (!(glm::length(direction) > 0)) value.fail("has no length");
    return Edit(AimLight{name, direction});
  }

  static SetMaterial material(const io::JsonView& entry) {
    only(entry, {"op", "material", "reflectance", "roughness"});
    SetMaterial edit{text(entry, "material"), {}, {}};
    const io::JsonView reflectance = entry.member("reflectance"), roughness = entry.member("roughness");
    if (reflectance.present()) edit.reflectance = Rgb(triple(reflectance, 0, 1));
    if (roughness.present()) edit.roughness = static_cast<float>(number(roughness, 0, 1));
    if (!edit.reflectance && !edit.roughness) entry.fail("sets neither reflectance nor roughness");
    return edit;
  }

  SetDaylight sky(const io::JsonView& entry) {
    only(entry, {"op", "sky", "when", "where", "north", "ground"});
    if (!daylight_)
      for (const char* key : {"sky", "when", "where"})
        entry.member(key).expectPresent("the first sky of a file says sky, when and where");
    daylight_ = io::daylightOf(entry, daylight_.value_or(Daylighting()));
    return {*daylight_};
  }

  AddObject add(const io::JsonView& entry) {
    only(entry, {"op", "object", "scene", "matrix"});
    AddObject edit{text(entry, "object"), text(entry, "scene"), nullptr, Mat4(1.0)};
    if (const io::JsonView matrix = entry.member("matrix"); matrix.present()) edit.matrix = rowMajor(matrix);
    const fs::path place = io::resolveReference(edit.file, folder_, file_, 0, false);
    std::shared_ptr<const Scene>& part = parts_[place];
    if (!part) part = std::make_shared<const Scene>(loadScene({place}, import_).scene);
    edit.part = part;
    return edit;
  }

  const std::string& file_;
  const fs::path& folder_;
  const ImportSettings& import_;
  std::optional<Daylighting> daylight_;                     // of the last entry that said
  std::map<fs::path, std::shared_ptr<const Scene>> parts_;  // read once each
};

/// Undo and redo have something to do.
void checkHistory(const std::vector<io::JsonView>& entries, const std::vector<EditStep>& steps) {
  std::size_t undo = 0, redo = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (std::holds_alternative<Undo>(steps[i])) {
      if (undo == 0) entries[i].fail("has nothing to undo");
      --undo, ++redo;
    } else if (std::holds_alternative<Redo>(steps[i])) {
      if (redo == 0) entries[i].fail("has nothing to redo");
      --redo, ++undo;
    } else {
      ++undo, redo = 0;
    }
  }
}

}  // namespace

}  // namespace deltalux

namespace deltalux::io {

std::vector<EditStep> readEdits(const JsonView& document, const std::string& file, const fs::path& folder,
                                const ImportSettings& import) {
  const JsonView edits = document.member("edits");
  edits.expectPresent("a list of edits");
  const std::vector<JsonView> entries = edits.objects();
  EntryReader reader(file, folder, import);
  std::vector<EditStep> steps;
  for (const JsonView& entry : entries) steps.push_back(reader.read(entry));
  checkHistory(entries, steps);
  return steps;
}

}  // namespace deltalux::io

namespace deltalux {

std::vector<EditStep> parseEdits(std::string_view text, const std::string& file, const fs::path& folder,
                                 const ImportSettings& import) {
  const nlohmann::json tree = io::parseJson(text, file, io::kEditHint);
  return io::readEdits(io::JsonView(tree, file, io::kEditHint), file, folder, import);
}

std::vector<EditStep> loadEdits(const fs::path& path, const ImportSettings& import) {
  return parseEdits(io::readInputFile(path), path.string(), path.parent_path(), import);
}

AppliedEdit applyStep(Scene& scene, EditHistory& history, const EditStep& step) {
  if (std::holds_alternative<Undo>(step)) return history.undo(scene);
  if (std::holds_alternative<Redo>(step)) return history.redo(scene);
  return history.apply(scene, std::get<Edit>(step));
}

void validateEdits(Scene scene, const std::vector<EditStep>& steps, const std::string& file) {
  EditHistory history;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    try {
      applyStep(scene, history, steps[i]);
    } catch (const InputError& error) {
      throw InputError(file, 0, fmt::format("edit {}: {}", i + 1, error.message()), error.hint());
    }
  }
}

}  // namespace deltalux
