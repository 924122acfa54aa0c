#include <deltalux/edit_io.hpp>
#include <deltalux/error.hpp>

#include "base/check.hpp"
#include "io/atomic_file.hpp"
#include "io/edits/edit_json.hpp"
#include "io/import_file.hpp"
#include "io/json_text.hpp"

namespace deltalux {

namespace fs = std::filesystem;

}  // namespace deltalux

namespace deltalux::io {

using Json = nlohmann::ordered_json;

}  // namespace deltalux::io

namespace deltalux {

namespace {

constexpr int kRecordingVersion = 1;  // [layout]

io::Json triple(const Vec3& v) { return {v.x, v.y, v.z}; }
io::Json triple(const Rgb& c) { return {c.r, c.g, c.b}; }
io::Json rowMajor(const Mat4& m) {
  io::Json numbers = io::Json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) numbers.push_back(m[column][row]);
  return numbers;
}

io::Json entry(const TransformObject& e) {
  return {{"op", "transform"}, {"object", e.object}, {"matrix", rowMajor(e.matrix)}};
}
io::Json entry(const AddObject& e) {
  return {{"op", "add"}, {"object", e.object}, {"scene", e.file}, {"matrix", rowMajor(e.matrix)}};
}
io::Json entry(const RemoveObject& e) { return {{"op", "remove"}, {"object", e.object}}; }
io::Json entry(const ScaleLight& e) { return {{"op", "light"}, {"light", e.light}, {"scale", e.factor}}; }
io::Json entry(const ColourLight& e) { return {{"op", "light"}, {"light", e.light}, {"rgb", triple(e.rgb)}}; }
io::Json entry(const SwitchLight& e) { return {{"op", "light"}, {"light", e.light}, {"on", e.on}}; }
io::Json entry(const AimLight& e) { return {{"op", "light"}, {"light", e.light}, {"aim", triple(e.direction)}}; }
io::Json entry(const MoveLight& e) { return {{"op", "light"}, {"light", e.light}, {"translate", triple(e.offset)}}; }
io::Json entry(const SetMaterial& e) {
  io::Json json{{"op", "material"}, {"material", e.material}};
  if (e.reflectance) json["reflectance"] = triple(*e.reflectance);
  if (e.roughness) json["roughness"] = *e.roughness;
  return json;
}
io::Json entry(const SetDaylight& e) {
  io::Json json{{"op", "sky"}};
  json.update(io::membersOf(e.daylight));
  return json;
}
io::Json entry(const Restore&) {
  DELTALUX_CHECK(false, "a recording says undo or redo instead of what they restore");
  return {};
}
io::Json entry(const Edit& e) {
  return std::visit([](const auto& edit) { return entry(edit); }, e);
}
io::Json entry(Undo) { return {{"op", "undo"}}; }
io::Json entry(Redo) { return {{"op", "redo"}}; }

double number(const io::JsonView& object, const char* key, double low, double high, double otherwise) {
  const io::JsonView value = object.member(key);
  value.expectNumber(low, high);
  return value.present() ? value.value().get<double>() : otherwise;
}
std::uint64_t count(const io::JsonView& object, const char* key, std::uint64_t otherwise) {
  const io::JsonView value = object.member(key);
  if (!value.present()) return otherwise;
  if (!value.value().is_number_unsigned()) value.fail("is not a whole number");
  return value.value().get<std::uint64_t>();
}

SolveSettings settingsOf(const io::JsonView& document) {
  SolveSettings s;
  const io::JsonView json = document.member("settings");
  s.error = number(json, "error", 1e-4, 0.999, s.error);
  s.seconds = number(json, "seconds", 0, 1e9, s.seconds);
  s.particles = count(json, "particles", s.particles);
  json.member("diffuse_only").expectBool();
  if (json.member("diffuse_only").present()) s.diffuseOnly = json.member("diffuse_only").value().get<bool>();
  const io::JsonView textures = json.member("caustic_textures");
  textures.expectBool();
  if (textures.present()) s.causticTextures = textures.value().get<bool>();
  const io::JsonView method = json.member("method"), byLight = json.member("by_light"), groups = json.member("groups");
  if (method.present()) {
    method.expectString();
    const std::string name = method.value().get<std::string>();
    if (name != "lines" && name != "paper") method.fail("is neither \"lines\" nor \"paper\"");
    s.method = name == "paper" ? SolveMethod::Paper : SolveMethod::Lines;
  }
  s.reemittedShare = number(json, "reemitted_share", 1e-6, 1, s.reemittedShare);
  byLight.expectBool();
  if (byLight.present()) s.byLight = byLight.value().get<bool>();
  if (groups.present())
    for (const io::JsonView& g : groups.objects()) {
      for (const char* key : {"name", "lights"}) {
        g.member(key).expectPresent("a group has a name and the lights of it");
        g.member(key).expectString();
      }
      s.groups.push_back({g.member("name").value().get<std::string>(), g.member("lights").value().get<std::string>()});
    }
  if (s.byLight && s.method == SolveMethod::Paper) method.fail("keeps no lights apart");
  s.seed = count(document, "seed", s.seed);
  return s;
}

}  // namespace

}  // namespace deltalux

namespace deltalux::io {

nlohmann::ordered_json entryOf(const EditStep& step) {
  return std::visit([](const auto& s) { return entry(s); }, step);
}

}  // namespace deltalux::io

namespace deltalux {

std::string toJson(const Recording& r) {
  io::Json scene = io::Json::array(), luminaires = io::Json::array(), edits = io::Json::array();
  for (const fs::path& file : r.scene) scene.push_back(file.string());
  for (const Luminaire& l : r.luminaires)
    luminaires.push_back({{"file", l.file.string()}, {"position", triple(l.position)}});
  io::Json groups = io::Json::array();
  for (const LightPattern& g : r.settings.groups) groups.push_back({{"name", g.group}, {"lights", g.pattern}});
  for (const EditStep& step : r.steps) edits.push_back(io::entryOf(step));
  io::Json document{
      {"recording", kRecordingVersion},
      {"scene", std::move(scene)},
      {"luminaires", std::move(luminaires)},
      {"import", {{"metres_per_unit", r.import.metresPerUnit}, {"luminous_efficacy", r.import.luminousEfficacy}}},
      {"seed", r.settings.seed},
      {"settings",
       {{"error", r.settings.error},
        {"particles", r.settings.particles},
        {"seconds", r.settings.seconds},
        {"diffuse_only", r.settings.diffuseOnly},
        {"caustic_textures", r.settings.causticTextures},
        {"method", r.settings.method == SolveMethod::Paper ? "paper" : "lines"},
        {"reemitted_share", r.settings.reemittedShare},
        {"by_light", r.settings.byLight},
        {"groups", std::move(groups)}}},
      {"edits", std::move(edits)}};
  if (r.daylight) document["daylight"] = io::membersOf(*r.daylight);
  return document.dump(2, ' ', false, io::Json::error_handler_t::replace) + "\n";
}

void saveEdits(const fs::path& path, const std::vector<EditStep>& steps) {
  io::Json edits = io::Json::array();
  for (const EditStep& step : steps) edits.push_back(io::entryOf(step));
  const io::Json document{{"edits", std::move(edits)}};
  io::writeFile(path, document.dump(2, ' ', false, io::Json::error_handler_t::replace) + "\n");
}

void saveRecording(const fs::path& path, const Recording& recording) {
  Recording fromThere = recording;
  const fs::path folder = fs::absolute(path).parent_path();
  const auto relative = [&](fs::path& file) { file = fs::absolute(file).lexically_proximate(folder); };
  for (fs::path& file : fromThere.scene) relative(file);
  for (Luminaire& l : fromThere.luminaires) relative(l.file);
  io::writeFile(path, toJson(fromThere));
}

Recording loadRecording(const fs::path& path) {
  const std::string file = path.string();
  const nlohmann::json tree = io::parseJson(io::readInputFile(path), file, io::kEditHint);
  const io::JsonView document(tree, file, io::kEditHint);
  const io::JsonView version = document.member("recording");
  version.expectPresent("this is no recording");
  version.expectInteger(kRecordingVersion, kRecordingVersion);
  Recording r;
  const io::JsonView scene = document.member("scene"), import = document.member("import");
  scene.expectPresent("the files of the scene");
  for (const io::JsonView& name : scene.elements()) {
    name.expectString();
    r.scene.push_back((path.parent_path() / name.value().get<std::string>()).lexically_normal());
  }
  const io::JsonView luminaires = document.member("luminaires");
  if (luminaires.present())
    for (const io::JsonView& l : luminaires.objects()) {
      l.member("file").expectPresent("the file of a measured light");
      l.member("file").expectString();
      const io::JsonView position = l.member("position");
      position.expectPresent("where the light is");
      position.expectNumbers(3, -1e9, 1e9);
      const auto& at = position.value();
      r.luminaires.push_back({(path.parent_path() / l.member("file").value().get<std::string>()).lexically_normal(),
                              {at[0].get<double>(), at[1].get<double>(), at[2].get<double>()}});
    }
  if (r.scene.empty()) scene.fail("names no file");
  r.import.metresPerUnit = number(import, "metres_per_unit", 1e-12, 1e12, r.import.metresPerUnit);
  r.import.luminousEfficacy = number(import, "luminous_efficacy", 1e-6, 1e6, r.import.luminousEfficacy);
  r.settings = settingsOf(document);
  if (const io::JsonView daylight = document.member("daylight"); daylight.present()) {
    daylight.expectObject();
    for (const char* key : {"sky", "when", "where"}) daylight.member(key).expectPresent("a daylight says it");
    r.daylight = io::daylightOf(daylight, {});
  }
  r.steps = io::readEdits(document, file, path.parent_path(), r.import);
  return r;
}

}  // namespace deltalux
