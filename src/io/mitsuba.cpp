#include "io/mitsuba.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <list>
#include <map>

#include "io/import_file.hpp"
#include "io/import_report.hpp"
#include "io/mitsuba/shapes.hpp"
#include "io/nearest_axis.hpp"
#include "io/turned_over.hpp"

namespace deltalux::io {

namespace {

using namespace mitsuba;

constexpr int kDeepestInclude = 8;  // of files within files, and instances [limit]
constexpr std::size_t kMostPrimitives = 5'000'000, kMostShapes = 500'000, kMostFiles = 1000;  // [limit]
constexpr const char* kMitsubaHint = "compare the scene with Mitsuba's documentation";

/// Puts values of <default> in place of $names.
void substitute(XmlElement& element, std::map<std::string, std::string>& defaults) {
  if (element.name == "default") {
    const std::string *name = element.attribute("name"), *value = element.attribute("value");
    if (name && value) defaults.emplace(*name, *value);
  }
  for (auto& [key, value] : element.attributes)
    if (value.starts_with('$'))
      if (const auto known = defaults.find(value.substr(1)); known != defaults.end()) value = known->second;
  for (XmlElement& child : element.children) substitute(child, defaults);
}

class MitsubaBuilder {
 public:
  MitsubaBuilder(const std::string& name, const std::filesystem::path& folder, const ImportSettings& settings)
      : name_(name), folder_(folder), context_{name_, folder_, imported_.report, [this](const XmlElement& e) {
                                                 return target(e);
                                               }} {
    scene().up = {0, 1, 0};
    scene().metresPerUnit = settings.metresPerUnit;
  }

  void add(XmlElement root) {
    if (root.name != "scene")
      throw InputError(name_, root.line, "is no scene of Mitsuba: it is a <" + root.name.substr(0, 40) + ">",
                       kMitsubaHint);
    substitute(root, defaults_);
    roots_.push_back(std::move(root));
    include(roots_.back(), 0);
    for (const XmlElement& r : roots_) note(r);
    for (const XmlElement& r : roots_)
      for (const XmlElement& child : r.children) addSensor(child);
    for (const XmlElement& r : roots_)
      for (const XmlElement& child : r.children) addChild(child);
  }

  ImportedScene finish() {
    if (scene().primitives.empty()) throw InputError(name_, 0, "has no shape that is read", kMitsubaHint);
    warnOfIgnored(imported_.report);
    addAreaLights(scene());
    return std::move(imported_);
  }

 private:
  Scene& scene() { return imported_.scene; }
  void ignore(const std::string& what) { ++imported_.report.ignored[what]; }
  std::string kindOf(const XmlElement& e) const { return e.name + " " + Properties(e, name_).type().substr(0, 40); }

  void include(const XmlElement& root, int depth) {
    for (const XmlElement& child : root.children) {
      if (child.name != "include") continue;
      const std::string* file = child.attribute("filename");
      if (!file || depth >= kDeepestInclude || roots_.size() > kMostFiles)
        throw InputError(name_, child.line,
                         file ? "files include each other too deeply, or too many" : "<include> names no file",
                         kMitsubaHint);
      const auto path = resolveReference(*file, folder_, name_, child.line, false);
      XmlElement inner = parseXml(readInputFile(path), path.string());
      substitute(inner, defaults_);
      roots_.push_back(std::move(inner));
      include(roots_.back(), depth + 1);
    }
  }

  void note(const XmlElement& element) {
    if (const std::string* id = element.attribute("id"); id && element.name != "ref") ids_.emplace(*id, &element);
    for (const XmlElement& child : element.children) note(child);
  }
  const XmlElement* target(const XmlElement& reference) const {
    const std::string* id = reference.attribute("id");
    const auto found = id ? ids_.find(*id) : ids_.end();
    if (found == ids_.end())
      throw InputError(name_, reference.line, "refers to '" + (id ? id->substr(0, 60) : "") + "', which is not there",
                       kMitsubaHint);
    return found->second;
  }

  void addChild(const XmlElement& e) {
    if (e.name == "shape") addShape(e, Mat4(1.0), 0);
    if (e.name == "emitter") addEmitter(e);
    if (e.name == "medium") ignore("medium");
  }

  void addSensor(const XmlElement& e) {
    if (e.name != "sensor") return;
    const Properties p(e, name_);
    if (p.type() != "perspective" && p.type() != "thinlens") return ignore(kindOf(e));
    const Mat4 m = p.toWorld();
    View view;
    view.name = e.attribute("id") ? *e.attribute("id") : "sensor" + std::to_string(scene().views.size());
    view.position = Vec3(m[3]), view.direction = Vec3(m[2]), view.up = Vec3(m[1]);
    if (!(glm::length(glm::cross(view.direction, view.up)) > 0)) return ignore("sensors that are flat");
    double width = 768, height = 576;  // Mitsuba's own defaults
    for (const XmlElement& child : e.children)
      if (child.name == "film")
        width = Properties(child, name_).number("width", width),
        height = Properties(child, name_).number("height", height);
    if (!(width >= 1 && height >= 1)) p.fail(e, "its film has no size");
    const double fov = std::clamp(p.number("fov", 50), 0.1, 179.0);
    const std::string axis = p.word("fov_axis").value_or("x");
    const bool across = axis == "x" || (axis == "smaller" && width <= height) || (axis == "larger" && width >= height);
    const double tangent = std::tan(glm::radians(fov) / 2);
    const auto degrees = [](double t) { return 2 * glm::degrees(std::atan(t)); };
    view.horizontal = across ? fov : degrees(tangent * width / height);
    view.vertical = across ? degrees(tangent * height / width) : fov;
    if (scene().views.empty()) scene().up = nearestAxis(view.up);
    scene().views.push_back(std::move(view));
  }

  void addShape(const XmlElement& e, const Mat4& outer, int depth) {
    const Properties p(e, name_);
    const std::string type = p.type();
    if (type == "shapegroup") return;
    const Mat4 toWorld = outer * p.toWorld();
    if (++shapes_ > kMostShapes) p.fail(e, "the scene has too many shapes and instances");
    if (depth > kDeepestInclude) p.fail(e, "instances contain each other");
    if (type == "instance") {
      for (const XmlElement& child : e.children) {
        if (child.name != "ref") continue;
        for (const XmlElement& part : target(child)->children)
          if (part.name == "shape") addShape(part, toWorld, depth + 1);
      }
      return;
    }
    const auto shapes = shapesOf(context_, p);
    if (!shapes) return ignore(kindOf(e));
    const MaterialId material = materialFor(e);
    const std::string own = e.attribute("id") ? *e.attribute("id") : type + std::to_string(unnamed_++);
    const ObjectId object = internObject(scene(), own, '/');
    for (const Shape& shape : *shapes) {
      const auto placed = transformed(shape, toWorld);
      if (!placed) {
        ignore("shapes that are sheared or flattened");
        continue;
      }
      if (scene().primitives.size() >= kMostPrimitives) p.fail(e, "the scene has too many surfaces");
      scene().primitives.push_back({p.flag("flip_normals", false) ? turnedOver(*placed) : *placed, material, object});
    }
    ++imported_.report.surfaces[type];
  }

  MaterialId materialFor(const XmlElement& shape) {
    const XmlElement *bsdf = nullptr, *emitter = nullptr;
    for (const XmlElement& child : shape.children) {
      const XmlElement* e = child.name == "ref" ? target(child) : &child;
      if (e->name == "bsdf") bsdf = e;
      if (e->name == "emitter") emitter = e;
    }
    const auto [known, isNew] = made_.try_emplace({bsdf, emitter}, MaterialId(scene().materials.size()));
    if (!isNew) return known->second;
    Material material =
        bsdf ? materialOf(context_, *bsdf) : Material{"default", Opaque{Rgb(0.5f), {}, {}}, std::nullopt};
    if (material.name.empty()) material.name = "material" + std::to_string(scene().materials.size());
    if (emitter) {
      const Properties p(*emitter, name_);
      const Rgb radiance = colourOf(context_, p, "radiance", Rgb(1.0f));
      if (p.type() != "area") ignore(kindOf(*emitter));
      if (p.type() == "area" && !isBlack(radiance))
        material.emission = Emission{material.coverage * radiance, false, {}, {}, false};
    }
    scene().materials.push_back(std::move(material));
    return known->second;
  }

  void addEmitter(const XmlElement& e) {
    const Properties p(e, name_);
    const std::string type = p.type();
    const Mat4 m = p.toWorld();
    const std::string name = e.attribute("id") ? *e.attribute("id") : type + std::to_string(scene().lights.size());
    const auto add = [&](auto emitter) { scene().lights.push_back({name, std::move(emitter), Rgb(1.0f)}); };
    const auto along = [&](const Vec3& direction) {
      if (!(glm::length(direction) > 0)) p.fail(e, "it shines nowhere");
      return glm::normalize(direction);
    };
    if (type == "point") {
      add(PointLight{p.point("position", Vec3(m[3])), colourOf(context_, p, "intensity", Rgb(1.0f))});
    } else if (type == "spot") {
      const double cutoff = std::clamp(p.number("cutoff_angle", 20), 0.01, 90.0);
      const double beam = std::clamp(p.number("beam_width", 0.75 * cutoff), 0.0, cutoff);
      add(SpotLight{Vec3(m[3]), along(Vec3(m[2])), colourOf(context_, p, "intensity", Rgb(1.0f)),
                    std::cos(glm::radians(beam)), std::cos(glm::radians(cutoff))});
    } else if (type == "directional") {
      SunLight sun;
      sun.direction = -along(p.point("direction", Vec3(m[2])));
      sun.radiance = colourOf(context_, p, "irradiance", Rgb(1.0f)) * static_cast<float>(1 / solidAngle(sun));
      add(sun);
    } else if (type == "constant") {
      DomeLight dome;
      dome.axis = dome.up = scene().up, dome.halfAngle = kPi;
      dome.scale = colourOf(context_, p, "radiance", Rgb(1.0f)), dome.distribution = UniformSky{1};
      add(dome);
    } else {
      ignore(kindOf(e));
    }
  }

  std::string name_;
  std::filesystem::path folder_;
  ImportedScene imported_;
  Context context_;
  std::list<XmlElement> roots_;  // of the file and those that it includes
  std::map<std::string, std::string> defaults_;
  std::map<std::string, const XmlElement*> ids_;
  std::map<std::pair<const XmlElement*, const XmlElement*>, MaterialId> made_;
  std::size_t unnamed_ = 0, shapes_ = 0;
};

}  // namespace

ImportedScene readMitsuba(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                          const ImportSettings& settings) {
  MitsubaBuilder builder(name, folder, settings);
  builder.add(parseXml(text, name));
  return builder.finish();
}

ImportedScene loadMitsuba(const std::filesystem::path& file, const ImportSettings& settings) {
  return readMitsuba(readInputFile(file), file.string(), file.parent_path(), settings);
}

}  // namespace deltalux::io
