// Daylight in words: "perez:800,100", "2026-06-21T09:00+02:00", "47.4,8.5".
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <deltalux/daylight.hpp>

namespace deltalux {

namespace {

/// Takes apart a text from its beginning.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : rest_(text) {}

  bool take(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  /// So many digits.
  std::optional<int> digits(std::size_t count) {
    int value = 0;
    if (rest_.size() < count) return std::nullopt;
    for (const char c : rest_.substr(0, count)) {
      if (c < '0' || c > '9') return std::nullopt;
      value = 10 * value + (c - '0');
    }
    rest_.remove_prefix(count);
    return value;
  }
  std::optional<double> number(double low, double high) {
    double value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc() || !(value >= low && value <= high)) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  bool done() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

int daysOf(int year, int month) {
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};  // [defined]
  const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return kDays[month - 1] + (month == 2 && leap);
}

/// "Z", "+02:00"; hours.
std::optional<double> readZone(TextCursor& text) {
  if (text.take("Z")) return 0.0;
  const bool east = text.take("+");
  if (!east && !text.take("-")) return std::nullopt;
  const std::optional<int> hours = text.digits(2);
  text.take(":");
  const std::optional<int> minutes = text.done() ? 0 : text.digits(2);
  if (!hours || !minutes || *hours > 14 || *minutes > 59) return std::nullopt;
  return (east ? 1 : -1) * (*hours + *minutes / 60.0);
}

constexpr double kMostLux = 1e6, kMostIrradiance = 2000;  // [limit]

}  // namespace

std::optional<std::variant<GeneralSky, AllWeatherSky>> parseSkyModel(std::string_view words) {
  TextCursor text(words);
  if (text.take("cie:")) {
    const std::optional<double> type = text.number(1, 15);
    if (!type || *type != std::round(*type)) return std::nullopt;
    GeneralSky sky{static_cast<int>(*type), std::nullopt};
    if (text.take(",") && !(sky.illuminance = text.number(0, kMostLux))) return std::nullopt;
    return text.done() ? std::optional(std::variant<GeneralSky, AllWeatherSky>(sky)) : std::nullopt;
  }
  if (!text.take("perez:")) return std::nullopt;
  const std::optional<double> direct = text.number(0, kMostIrradiance);
  if (!direct || !text.take(",")) return std::nullopt;
  const std::optional<double> diffuse = text.number(0, kMostIrradiance);
  if (!diffuse || !text.done()) return std::nullopt;
  return AllWeatherSky{*direct, *diffuse};
}

std::optional<CivilTime> parseCivilTime(std::string_view words) {
  TextCursor text(words);
  constexpr int kFirstYear = 1900, kLastYear = 2100;  // of the sun's formulas, with some room [limit]
  const std::optional<int> year = text.digits(4);
  if (!year || *year < kFirstYear || *year > kLastYear || !text.take("-")) return std::nullopt;
  const std::optional<int> month = text.digits(2);
  if (!month || *month < 1 || *month > 12 || !text.take("-")) return std::nullopt;
  const std::optional<int> day = text.digits(2);
  if (!day || *day < 1 || *day > daysOf(*year, *month)) return std::nullopt;
  if (!text.take("T") && !text.take(" ")) return std::nullopt;
  const std::optional<int> hour = text.digits(2);
  if (!hour || *hour > 23 || !text.take(":")) return std::nullopt;
  const std::optional<int> minute = text.digits(2);
  if (!minute || *minute > 59) return std::nullopt;
  std::optional<double> second = 0.0;
  if (text.take(":")) second = text.number(0, 60);
  if (!second || *second >= 60) return std::nullopt;
  CivilTime time{*year, *month, *day, *hour + *minute / 60.0 + *second / 3600, std::nullopt};
  if (!text.done() && !(time.zone = readZone(text))) return std::nullopt;
  return text.done() ? std::optional(time) : std::nullopt;
}

std::optional<Place> parsePlace(std::string_view words) {
  TextCursor text(words);
  const std::optional<double> latitude = text.number(-90, 90);
  if (!latitude || !text.take(",")) return std::nullopt;
  text.take(" ");
  const std::optional<double> longitude = text.number(-180, 180);
  if (!longitude || !text.done()) return std::nullopt;
  return Place{*latitude, *longitude};
}

std::string toText(const std::variant<GeneralSky, AllWeatherSky>& sky) {
  if (const auto* measured = std::get_if<AllWeatherSky>(&sky))
    return fmt::format("perez:{},{}", measured->directNormal, measured->diffuseHorizontal);
  const GeneralSky& general = std::get<GeneralSky>(sky);
  return fmt::format("cie:{}", general.type) + (general.illuminance ? fmt::format(",{}", *general.illuminance) : "");
}

std::string toText(const CivilTime& time) {
  const auto seconds = static_cast<int>(std::lround(3600 * time.hour));  // files have no finer ones
  std::string text =
      fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}", time.year, time.month, time.day, seconds / 3600, seconds / 60 % 60);
  if (seconds % 60 != 0) text += fmt::format(":{:02}", seconds % 60);
  if (!time.zone) return text;
  const int minutes = static_cast<int>(std::lround(60 * std::abs(*time.zone)));
  return text + fmt::format("{}{:02}:{:02}", *time.zone < 0 ? '-' : '+', minutes / 60, minutes % 60);
}

std::string toText(const Place& place) { return fmt::format("{},{}", place.latitude, place.longitude); }

}  // namespace deltalux
