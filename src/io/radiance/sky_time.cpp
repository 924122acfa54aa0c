#include "io/radiance/sky_time.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

namespace {

/// Standard meridians by the zones' abbreviations [degrees west].
std::optional<double> zoneMeridian(std::string_view zone) {
  constexpr std::array<std::pair<std::string_view, double>, 26> kZones{
      {{"YST", 135}, {"YDT", 120},   {"PST", 120},  {"PDT", 105},   {"MST", 105},  {"MDT", 90},   {"CST", 90},
       {"CDT", 75},  {"EST", 75},    {"EDT", 60},   {"AST", 60},    {"ADT", 45},   {"NST", 52.5}, {"NDT", 37.5},
       {"GMT", 0},   {"BST", -15},   {"CET", -15},  {"CEST", -30},  {"EET", -30},  {"EEST", -45}, {"GST", -60},
       {"GDT", -75}, {"IST", -82.5}, {"JST", -135}, {"NZST", -180}, {"NZDT", -195}}};
  for (const auto& [name, meridian] : kZones) {
    if (name == zone) return meridian;
  }
  return std::nullopt;
}

/// [+]hour[:minutes][zone]; true when the zone sets the meridian.
bool readHour(ObjectMaker& maker, SunTime& time, Site& site) {
  std::string_view text = maker.word("hour");
  const std::string whole(text);
  time.solar = text.starts_with('+');
  if (time.solar) text.remove_prefix(1);
  const std::size_t end = std::min(text.find_first_not_of("0123456789:."), text.size());
  const std::string_view clock = text.substr(0, end), zone = text.substr(end);
  const std::size_t colon = clock.find(':');
  const auto hours = parseNumber(clock.substr(0, colon));
  const auto minutes = colon == std::string_view::npos ? std::optional(0.0) : parseNumber(clock.substr(colon + 1));
  if (!hours || !minutes || *hours < 0 || *hours > 24) maker.fail("'" + whole + "' is no hour of the day");
  time.hour = *hours + *minutes / 60;
  if (zone.empty()) return false;
  std::string upper(zone);
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  const auto meridian = zoneMeridian(upper);
  if (time.solar || !meridian) maker.fail("'" + whole + "': unknown time zone");
  site.meridian = glm::radians(*meridian);
  return true;
}

}  // namespace

SkyTime readSkyTime(ObjectMaker& maker) {
  SkyTime when;
  const std::string first = maker.word("month or -ang");
  if (first == "-ang") {
    const double altitude = maker.number("altitude"), azimuth = maker.number("azimuth");
    when.angles = SunAngles{glm::radians(altitude), glm::radians(azimuth)};
    return when;
  }
  const auto month = parseInteger(first);
  const long day = maker.integer("day");
  if (!month || *month < 1 || *month > 12) maker.fail("'" + first.substr(0, 20) + "' is no month");
  if (day < 1 || day > 31) maker.fail(std::to_string(day) + " is no day of a month");
  when.time.month = static_cast<int>(*month), when.time.day = static_cast<int>(day);
  when.zoneGiven = readHour(maker, when.time, when.site);
  return when;
}

std::string readOption(ObjectMaker& maker) {
  std::string option = maker.word("option");
  if (option.size() < 2 || (option[0] != '-' && option[0] != '+'))
    maker.fail("'" + option.substr(0, 20) + "' is no option");
  return option;
}

bool readSiteOption(ObjectMaker& maker, const std::string& option, SkyTime& when) {
  if (option == "-a") {
    when.site.latitude = glm::radians(maker.number("-a"));
  } else if (option == "-o") {
    when.site.longitude = glm::radians(maker.number("-o"));
  } else if (option == "-m") {
    const double meridian = glm::radians(maker.number("-m"));
    if (!when.zoneGiven) when.site.meridian = meridian;
  } else if (option == "-y") {
    const long year = maker.integer("-y");
    if (year < 1950 || year > 2050) maker.fail("the sun's position is good for the years 1950 to 2050");
    when.time.year = static_cast<int>(year);
  } else {
    return false;
  }
  return true;
}

SunAngles sunAngles(const SkyTime& when) { return when.angles ? *when.angles : sunAngles(when.time, when.site); }

}  // namespace deltalux::io::radiance
