// A request of areas, as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/sheet.hpp>
#include <initializer_list>

#include "io/import_file.hpp"
#include "io/json_text.hpp"
#include "io/json_view.hpp"

namespace deltalux {

namespace {

constexpr const char* kHint = "docs/sheet.md shows the form of requests";
constexpr double kLargest = 1e9;     // coordinates beyond are mistakes [limit]
constexpr double kRight = 1e-4;      // cosine between sides at right angles at most [rounding]
constexpr double kMostLux = 1e7;     // [limit]
constexpr double kMostHeight = 1e3;  // [m] [limit]

using io::JsonView;

/// Every key has a meaning here.
void only(const JsonView& object, std::initializer_list<const char*> keys) {
  object.expectObject();
  for (const auto& [key, value] : object.value().items())
    if (std::ranges::find(keys, key) == keys.end()) {
      const std::vector<std::string> known(keys.begin(), keys.end());
      object.fail(fmt::format("has an unknown key '{}'; nearest: {}", key, fmt::join(nearMisses(key, known), ", ")));
    }
}

std::string text(const JsonView& value) {
  value.expectString();
  return value.present() ? value.value().get<std::string>() : std::string();
}

std::optional<double> number(const JsonView& value, double low, double high) {
  value.expectNumber(low, high);
  return value.present() ? std::optional(value.value().get<double>()) : std::nullopt;
}

Vec3 triple(const JsonView& value) {
  value.expectPresent("three numbers");
  value.expectNumbers(3, -kLargest, kLargest);
  return {value.value()[0].get<double>(), value.value()[1].get<double>(), value.value()[2].get<double>()};
}

/// A name, or several.
std::vector<std::string> names(const JsonView& value) {
  if (!value.present()) return {};
  if (value.value().is_string()) return {text(value)};
  std::vector<std::string> all;
  for (const JsonView& one : value.elements()) all.push_back(text(one));
  return all;
}

GridArea rectangle(const JsonView& value) {
  only(value, {"corner", "u", "v"});
  const GridArea area{triple(value.member("corner")), triple(value.member("u")), triple(value.member("v"))};
  const double u = glm::length(area.u), v = glm::length(area.v);
  if (!(u > 0 && v > 0) || std::abs(glm::dot(area.u, area.v)) > kRight * u * v)
    value.fail("has sides that are not at right angles");
  return area;
}

std::vector<Vec3> polygon(const JsonView& value) {
  std::vector<Vec3> corners;
  for (const JsonView& corner : value.elements()) corners.push_back(triple(corner));
  if (corners.size() < 3 || !makePolygon(corners)) value.fail("is no polygon: three corners or more, in one plane");
  return corners;
}

AreaRequirements requirements(const JsonView& value, AreaRequirements required) {
  if (!value.present()) return required;
  only(value, {"Em", "U0", "UGR", "cylindrical", "walls", "ceiling"});
  const auto set = [&](const char* key, std::optional<double>& to, double high) {
    if (const JsonView member = value.member(key); member.present()) {
      if (member.value().is_null())
        to = {};
      else
        to = number(member, 0, high);
    }
  };
  set("Em", required.mean, kMostLux), set("U0", required.uniformity, 1), set("UGR", required.glare, 100);
  set("cylindrical", required.cylindrical, kMostLux), set("walls", required.walls, kMostLux);
  set("ceiling", required.ceiling, kMostLux);
  return required;
}

SheetArea area(const JsonView& value) {
  only(value, {"name", "kind", "surface", "rectangle", "polygon", "height", "border", "spacing", "eye_height",
               "directions", "skip_covered", "required", "walls", "ceiling"});
  SheetArea area;
  area.line = value.line();
  value.member("name").expectPresent("what the sheet calls this area");
  area.name = text(value.member("name")), area.kind = text(value.member("kind"));
  if (!area.kind.empty()) {
    const auto required = en12464(area.kind);
    if (!required)
      value.member("kind").fail(
          fmt::format("is '{}'; EN 12464-1 is known here for: {}", area.kind, fmt::join(en12464Kinds(), ", ")));
    area.required = *required;
  }
  area.required = requirements(value.member("required"), area.required);
  const JsonView surface = value.member("surface"), sides = value.member("rectangle"),
                 corners = value.member("polygon");
  if (surface.present() + sides.present() + corners.present() != 1)
    value.fail("needs one of surface, rectangle, polygon");
  if (surface.present())
    area.on = text(surface);
  else if (sides.present())
    area.on = rectangle(sides);
  else
    area.on = polygon(corners);
  area.grid.height = number(value.member("height"), 0, kMostHeight).value_or(0);
  area.grid.border = number(value.member("border"), 0, kMostHeight).value_or(area.grid.border);
  area.grid.spacing = number(value.member("spacing"), 1e-3, kMostHeight).value_or(0);
  area.eyeHeight = number(value.member("eye_height"), 0, kMostHeight).value_or(area.eyeHeight);
  value.member("directions").expectInteger(1, 360);
  if (value.member("directions").present()) area.directions = value.member("directions").value().get<int>();
  value.member("skip_covered").expectBool();
  if (value.member("skip_covered").present()) area.skipCovered = value.member("skip_covered").value().get<bool>();
  area.walls = names(value.member("walls")), area.ceiling = names(value.member("ceiling"));
  return area;
}

LuminairePower luminaire(const JsonView& value) {
  only(value, {"lights", "name", "watts"});
  value.member("lights").expectPresent("the lights' name; * stands for anything");
  return {text(value.member("lights")), text(value.member("name")), number(value.member("watts"), 0, kMostLux)};
}

}  // namespace

SheetRequest parseSheetRequest(std::string_view json, const std::string& file) {
  const nlohmann::json tree = io::parseJson(json, file, kHint);
  const JsonView document(tree, file, kHint, json);
  only(document, {"title", "project", "author", "date", "maintenance_factor", "view", "areas", "luminaires"});
  SheetRequest request;
  request.file = file;
  if (document.member("title").present()) request.title = text(document.member("title"));
  request.project = text(document.member("project")), request.author = text(document.member("author"));
  request.date = text(document.member("date")), request.view = text(document.member("view"));
  request.maintenanceFactor = number(document.member("maintenance_factor"), 0.01, 1).value_or(1);
  document.member("areas").expectPresent("a list of areas");
  for (const JsonView& one : document.member("areas").objects()) request.areas.push_back(area(one));
  if (request.areas.empty()) document.member("areas").fail("has none");
  for (const JsonView& one : document.member("luminaires").objects()) request.luminaires.push_back(luminaire(one));
  return request;
}

SheetRequest loadSheetRequest(const std::filesystem::path& file) {
  return parseSheetRequest(io::readInputFile(file), file.string());
}

}  // namespace deltalux
