#include "io/pbrt.hpp"

#include <algorithm>
#include <array>
#include <deltalux/error.hpp>

#include "io/gunzip.hpp"
#include "io/import_file.hpp"
#include "io/import_report.hpp"
#include "io/nearest_axis.hpp"
#include "io/pbrt/camera.hpp"
#include "io/pbrt/lights.hpp"
#include "io/pbrt/surfaces.hpp"
#include "io/pbrt/transforms.hpp"
#include "io/plain_text.hpp"

namespace deltalux::io {

namespace pbrt {

namespace {

constexpr int kDeepestInclude = 16;                                  // of files within files [limit]
constexpr std::size_t kMostFiles = 100'000, kDeepestState = 10'000;  // [limit]

class PbrtBuilder {
 public:
  PbrtBuilder(const std::filesystem::path& folder, const ImportSettings& settings)
      : context_{folder, imported_.report, {}, 0}, surfaces_(context_, imported_.scene) {
    imported_.scene.up = {0, 1, 0};
    imported_.scene.metresPerUnit = settings.metresPerUnit;
  }

  void add(std::string_view text, const std::string& name) {
    read(text, names_.emplace_back(name), 0);
    if (!saved_.empty()) fail(saved_.back().at, "what begins here has no end");
  }

  ImportedScene finish() {
    if (imported_.scene.primitives.empty())
      fail({&names_.front(), 0}, inWorld_ ? "has no shape that is read" : "has no WorldBegin");
    surfaces_.finish();
    warnOfIgnored(imported_.report);
    addAreaLights(imported_.scene);
    return std::move(imported_);
  }

 private:
  using Statement = void (PbrtBuilder::*)(Tokens&, const Place&);

  void read(std::string_view text, const std::string& name, int depth) {
    const PlainText plain(text, name);
    Tokens tokens(plain.view(), name);
    while (tokens.peek()) {
      const Token token = tokens.take("a statement");
      const Place at = tokens.place();
      if (token.kind != Token::Kind::Word) fail(at, shown(token.text) + " stands where a statement should begin");
      if (token.text == "Include" || token.text == "Import")
        include(tokens, at, depth, token.text == "Import");
      else if (const auto step = takeTransform(token.text, tokens))
        transform(*step, token.text == "Transform", at);
      else
        (this->*statement(token.text, at))(tokens, at);
    }
  }

  void include(Tokens& tokens, const Place& at, int depth, bool apart) {
    const std::string file = tokens.takeText("a file");
    if (depth >= kDeepestInclude || names_.size() >= kMostFiles)
      fail(at, "files include each other too deeply, or too many");
    const auto path = resolveReference(file, context_.folder, *at.file, at.line, false);
    const State before = state_;
    read(readUnpacked(path), names_.emplace_back(path.string()), depth + 1);
    if (apart) state_ = before;
  }

  void transform(const Mat4& step, bool inPlace, const Place& at) {
    if (!state_.transforms) return;
    state_.toWorld = inPlace ? step : state_.toWorld * step;
    requireFinite(state_.toWorld, at);
  }

  Statement statement(std::string_view word, const Place& at) const {
    using B = PbrtBuilder;
    static const std::map<std::string_view, Statement> kBeforeWorld{
        {"Camera", &B::camera}, {"Film", &B::film}, {"WorldBegin", &B::worldBegin}};
    static const std::map<std::string_view, Statement> kInWorld{{"Shape", &B::shape},
                                                                {"ObjectBegin", &B::objectBegin},
                                                                {"ObjectEnd", &B::objectEnd},
                                                                {"LightSource", &B::light},
                                                                {"ObjectInstance", &B::instance},
                                                                {"AreaLightSource", &B::areaLight},
                                                                {"Material", &B::material},
                                                                {"NamedMaterial", &B::useNamed},
                                                                {"MakeNamedMaterial", &B::makeNamed},
                                                                {"Texture", &B::texture},
                                                                {"AttributeEnd", &B::attributeEnd},
                                                                {"AttributeBegin", &B::attributeBegin},
                                                                {"ReverseOrientation", &B::reverse},
                                                                {"WorldEnd", &B::nothing}};
    static const std::map<std::string_view, Statement> kAnywhere{{"Attribute", &B::attribute},
                                                                 {"Identity", &B::identity},
                                                                 {"TransformBegin", &B::transformBegin},
                                                                 {"TransformEnd", &B::transformEnd},
                                                                 {"ActiveTransform", &B::activeTransform},
                                                                 {"TransformTimes", &B::transformTimes},
                                                                 {"CoordinateSystem", &B::coordinateSystem},
                                                                 {"CoordSysTransform", &B::coordSysTransform},
                                                                 {"MakeNamedMedium", &B::medium},
                                                                 {"MediumInterface", &B::mediumInterface},
                                                                 {"Option", &B::option},
                                                                 {"ColorSpace", &B::colorSpace},
                                                                 {"Sampler", &B::passOver},
                                                                 {"Integrator", &B::passOver},
                                                                 {"PixelFilter", &B::passOver},
                                                                 {"Accelerator", &B::passOver}};
    if (const auto found = kAnywhere.find(word); found != kAnywhere.end()) return found->second;
    if (const auto found = kInWorld.find(word); found != kInWorld.end()) {
      if (!inWorld_) fail(at, shown(word) + " stands before WorldBegin");
      return found->second;
    }
    const auto found = kBeforeWorld.find(word);
    if (found == kBeforeWorld.end()) fail(at, shown(word) + " is no statement of pbrt-v4");
    if (inWorld_) fail(at, shown(word) + " stands behind WorldBegin");
    return found->second;
  }

  void save(Saved::By by, const Place& at) {
    if (saved_.size() >= kDeepestState) fail(at, "statements lie too deeply within each other");
    saved_.push_back({by, at, state_});
  }
  State restore(Saved::By by, const Place& at) {
    if (saved_.empty() || saved_.back().by != by)
      fail(at, "what ends here was not begun, or something within was not ended");
    State state = std::move(saved_.back().state);
    saved_.pop_back();
    return state;
  }

  const Entity* keep(Entity entity) { return &entities_.emplace_back(std::move(entity)); }

  // Statements. What they are called by stands in statement().
  void nothing(Tokens&, const Place&) {}
  void passOver(Tokens& t, const Place&) { t.takeText("a kind"), takeParameters(t); }
  void option(Tokens& t, const Place&) { takeParameters(t); }
  void colorSpace(Tokens& t, const Place&) {
    if (t.takeText("a colour space") != "srgb") ignore(context_, "colour spaces (numbers as they stand)");
  }
  void camera(Tokens& t, const Place&) {
    const std::string type = t.takeText("a kind of camera");
    camera_ = keep(takeEntity(t, state_, type, "camera"));
    fromWorld_ = state_.toWorld;
    systems_["camera"] = glm::inverse(state_.toWorld);
  }
  void film(Tokens& t, const Place&) {
    const std::string type = t.takeText("a kind of film");
    film_ = keep(takeEntity(t, state_, type, "film"));
  }
  void worldBegin(Tokens&, const Place&) {
    inWorld_ = true;
    state_.toWorld = Mat4(1.0), state_.transforms = true;
    systems_["world"] = Mat4(1.0);
    if (!camera_) return;
    auto view = viewOf(context_, *camera_, film_, fromWorld_);
    if (!view) return;
    imported_.scene.up = nearestAxis(view->up);
    imported_.scene.views.push_back(std::move(*view));
  }

  void attribute(Tokens& t, const Place& at) { takeDefaults(t, state_, at); }
  void attributeBegin(Tokens&, const Place& at) { save(Saved::By::Attribute, at); }
  void attributeEnd(Tokens&, const Place& at) { state_ = restore(Saved::By::Attribute, at); }
  void transformBegin(Tokens&, const Place& at) { save(Saved::By::Transform, at); }
  void transformEnd(Tokens&, const Place& at) { state_.toWorld = restore(Saved::By::Transform, at).toWorld; }
  void objectBegin(Tokens& t, const Place& at) {
    surfaces_.beginObject(t.takeText("an object's name"), at);
    save(Saved::By::Object, at);
  }
  void objectEnd(Tokens&, const Place& at) {
    state_ = restore(Saved::By::Object, at);
    surfaces_.endObject(at);
  }
  void instance(Tokens& t, const Place& at) {
    surfaces_.addInstance(t.takeText("an object's name"), state_.toWorld, at);
  }

  void identity(Tokens&, const Place&) {
    if (state_.transforms) state_.toWorld = Mat4(1.0);
  }
  void coordinateSystem(Tokens& t, const Place& at) {
    constexpr std::size_t kMost = 100'000;  // [limit]
    systems_[t.takeText("a name")] = state_.toWorld;
    if (systems_.size() > kMost) fail(at, "there are too many coordinate systems");
  }
  void coordSysTransform(Tokens& t, const Place& at) {
    const std::string name = t.takeText("a name");
    const auto found = systems_.find(name);
    if (found == systems_.end()) fail(at, "the coordinate system " + shown(name) + " is not there");
    transform(found->second, true, at);
  }
  void transformTimes(Tokens& t, const Place&) { t.takeNumber(), t.takeNumber(); }
  void activeTransform(Tokens& t, const Place& at) {
    const std::string_view which = t.take("All, StartTime or EndTime").text;
    if (which != "All" && which != "StartTime" && which != "EndTime") fail(at, shown(which) + " is no time");
    state_.transforms = which != "EndTime";
    if (!state_.transforms) ignore(context_, "motion (as it starts)");
  }
  void reverse(Tokens&, const Place&) { state_.reversed = !state_.reversed; }

  void shape(Tokens& t, const Place&) {
    const std::string type = t.takeText("a kind of shape");
    surfaces_.addShape(takeEntity(t, state_, type, "shape"), state_);
  }
  void light(Tokens& t, const Place&) {
    const std::string type = t.takeText("a kind of light");
    addLight(context_, imported_.scene, takeEntity(t, state_, type, "light"), state_.toWorld);
  }
  void areaLight(Tokens& t, const Place&) {
    const std::string type = t.takeText("a kind of light");
    state_.areaLight = keep(takeEntity(t, state_, type, "light"));
  }
  void material(Tokens& t, const Place&) {
    const std::string type = t.takeText("a kind of material");
    state_.material = keep(takeEntity(t, state_, type, "material"));
  }
  void makeNamed(Tokens& t, const Place&) {
    const std::string name = t.takeText("a material's name");
    Entity entity = takeEntity(t, state_, "", "material");
    entity.type = textOr(entity, "type", "");
    surfaces_.define(name, std::move(entity));
  }
  void useNamed(Tokens& t, const Place& at) { state_.material = surfaces_.named(t.takeText("a material's name"), at); }
  void texture(Tokens& t, const Place& at) {
    const std::string name = t.takeText("a texture's name"), of = t.takeText("what a texture consists of");
    if (of != "float" && of != "spectrum" && of != "color")
      fail(at, shown(of) + " is nothing that a texture consists of");
    std::string type = t.takeText("a kind of texture");
    context_.textures[(of == "float" ? "float " : "spectrum ") + name] = {
        takeEntity(t, state_, std::move(type), "texture"), std::nullopt};
  }
  void medium(Tokens& t, const Place&) {
    t.takeText("a medium's name"), takeParameters(t);
    ignore(context_, "media");
  }
  void mediumInterface(Tokens& t, const Place&) {
    t.takeText("a medium's name");
    if (t.peek() && t.peek()->kind == Token::Kind::Text) t.takeText("a medium's name");
  }

  ImportedScene imported_;
  Context context_;
  Surfaces surfaces_;
  std::deque<std::string> names_;  // of files
  std::deque<Entity> entities_;    // that statements after theirs refer to
  State state_;
  std::vector<Saved> saved_;
  std::map<std::string, Mat4, std::less<>> systems_;
  bool inWorld_ = false;
  const Entity *camera_ = nullptr, *film_ = nullptr;
  Mat4 fromWorld_{1.0};
};

}  // namespace

}  // namespace pbrt

ImportedScene readPbrt(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                       const ImportSettings& settings) {
  pbrt::PbrtBuilder builder(folder, settings);
  builder.add(text, name);
  return builder.finish();
}

ImportedScene loadPbrt(const std::filesystem::path& file, const ImportSettings& settings) {
  return readPbrt(readUnpacked(file), file.string(), file.parent_path(), settings);
}

}  // namespace deltalux::io
