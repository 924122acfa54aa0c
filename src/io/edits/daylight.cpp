#include "io/edits/edit_json.hpp"

namespace deltalux::io {

namespace {

std::string wordsIn(const JsonView& value) {
  value.expectString();
  return value.value().get<std::string>();
}

}  // namespace

Daylighting daylightOf(const JsonView& json, Daylighting daylight) {
  if (const JsonView sky = json.member("sky"); sky.present()) {
    const auto model = parseSkyModel(wordsIn(sky));
    if (!model) sky.fail("is no sky: \"cie:TYPE\" with 1 to 15, \"cie:TYPE,LUX\" or \"perez:DIRECT_NORMAL,DIFFUSE\"");
    daylight.sky = *model;
  }
  if (const JsonView when = json.member("when"); when.present()) {
    const auto time = parseCivilTime(wordsIn(when));
    if (!time) when.fail("is no time as 2026-06-21T09:00+02:00, of 1900 to 2100");
    daylight.time = *time;
  }
  if (const JsonView where = json.member("where"); where.present()) {
    where.expectNumbers(2, -180, 180);
    daylight.place = {where.value()[0].get<double>(), where.value()[1].get<double>()};
    if (std::abs(daylight.place.latitude) > 90) where.fail("begins with a latitude beyond 90 degrees");
  }
  if (const JsonView north = json.member("north"); north.present()) {
    north.expectNumber(-360, 360);
    daylight.north = north.value().get<double>();
  }
  if (const JsonView ground = json.member("ground"); ground.present()) {
    ground.expectNumber(0, 1);
    daylight.groundReflectance = ground.value().get<double>();
  }
  return daylight;
}

nlohmann::ordered_json membersOf(const Daylighting& daylight) {
  return {{"sky", toText(daylight.sky)},
          {"when", toText(daylight.time)},
          {"where", {daylight.place.latitude, daylight.place.longitude}},
          {"north", daylight.north},
          {"ground", daylight.groundReflectance}};
}

}  // namespace deltalux::io
