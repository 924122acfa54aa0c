#include "io/ldt.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <filesystem>
#include <optional>

#include "io/lower_case.hpp"
#include "io/number.hpp"
#include "io/plain_text.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io {

namespace {

constexpr int kMostPlanes = 3600, kMostAngles = 3600, kMostSets = 100;  // [limit]
constexpr int kRatios = 10, kLinesOfSet = 6;                            // [layout]
constexpr double kSame = 1e-3;                                          // degrees between equal angles [rounding]
constexpr const char* kHint = "compare the file with the EULUMDAT format, line by line";

/// The lines of a file, one field each.
class LdtLines {
 public:
  LdtLines(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  int line() const { return line_; }  // of the last one read
  [[noreturn]] void fail(const std::string& message, const char* hint = kHint) const {
    throw InputError(name_, line_, message, hint);
  }

  std::string_view text(const char* what) {
    ++line_;
    if (text_.empty()) fail(std::string("the file ends where ") + what + " should stand");
    const std::size_t end = text_.find('\n');
    const std::string_view field = trimmed(text_.substr(0, end));
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    return field;
  }
  void skip(int lines, const char* what) {
    for (int i = 0; i < lines; ++i) text(what);
  }
  double number(const char* what) {
    const std::string_view field = text(what);
    const std::optional<double> value = decimal(field);
    if (!value) fail(std::string(what) + ": " + notANumber(field));
    return *value;
  }
  int integer(const char* what, int low, int high) {
    const double value = number(what);
    if (value != std::round(value) || value < low || value > high)
      fail(std::string(what) + " is not a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return static_cast<int>(value);
  }
  std::vector<double> ascending(int count, const char* what) {
    std::vector<double> all;
    for (int i = 0; i < count; ++i) {
      all.push_back(number(what));
      if (i > 0 && !(all[all.size() - 2] < all.back())) fail(std::string(what) + " do not ascend");
    }
    return all;
  }
  std::string_view rest() const { return text_; }
  /// Some programs write decimals with a comma.
  static std::optional<double> decimal(std::string_view field) {
    if (const std::optional<double> value = parseDecimal(field)) return value;
    std::string point(field);
    std::ranges::replace(point, ',', '.');
    return parseDecimal(point);
  }

 private:
  std::string_view text_;
  const std::string& name_;
  int line_ = 0;
};

struct LdtHead {
  int symmetry = 0, planes = 0, angles = 0;
};

LdtHead readHead(LdtLines& lines, IesRecord& record, const std::string& name) {
  LdtHead head;
  lines.skip(1, "the maker");
  lines.integer("the type (line 2)", 0, 3);
  head.symmetry = lines.integer("the symmetry (line 3)", 0, 4);
  head.planes = lines.integer("the number of C planes", 1, kMostPlanes);
  lines.number("the distance of C planes");
  head.angles = lines.integer("the number of intensities in each plane", 2, kMostAngles);
  lines.number("the distance of intensities");
  lines.skip(5, "a text about the luminaire");  // report, name, number, file, date
  lines.skip(3, "a dimension of the luminaire");
  const double metre = 1e-3;  // dimensions are in millimetres
  // A long luminaire lies along C90; the record's length is along the 0 plane.
  const double length = metre * lines.number("the length of the luminous area");
  const double width = metre * lines.number("the width of the luminous area");
  record.width = width > 0 ? length : -length, record.length = width > 0 ? width : -length;  // negative: round
  for (int i = 0; i < 4; ++i)
    record.height = std::max(record.height, metre * lines.number("a height of the luminous area"));
  lines.number("the downward flux fraction");
  record.outputRatio = 0.01 * lines.number("the light output ratio");
  const double conversion = lines.number("the conversion factor");
  if (conversion > 0)
    record.multiplier = conversion;
  else
    record.warnings.push_back(name + ": the conversion factor of intensities is not positive; taken as 1");
  if (const double tilt = lines.number("the tilt during measurement"); tilt != 0)
    record.warnings.push_back(name + ": it was measured tilted by " + std::to_string(tilt) +
                              " degrees; angles are taken from the luminaire's own axis");
  return head;
}

/// The flux of each set of lamps. Most programs write set by set; some the same field of all sets together.
std::vector<double> fluxOf(const std::vector<std::string_view>& fields, std::size_t sets, const LdtLines& lines) {
  const auto pick = [&](auto index) {
    std::vector<double> flux;
    for (std::size_t s = 0; s < sets; ++s) {
      const std::optional<double> number = LdtLines::decimal(fields[index(s, 0)]),
                                  value = LdtLines::decimal(fields[index(s, 2)]);
      if (!number || !value || *number != std::round(*number) || !(*value > 0)) return std::vector<double>();
      flux.push_back(*value);
    }
    return flux;
  };
  std::vector<double> flux = pick([](std::size_t s, std::size_t field) { return kLinesOfSet * s + field; });
  if (flux.empty()) flux = pick([&](std::size_t s, std::size_t field) { return sets * field + s; });
  if (flux.empty()) lines.fail("no flux of the lamps, which intensities are relative to, is above 0 (line 26c)");
  return flux;
}

void readLamps(LdtLines& lines, IesRecord& record, const std::string& name) {
  const int sets = lines.integer("the number of sets of lamps", 1, kMostSets);
  std::vector<std::string_view> fields;
  for (int i = 0; i < kLinesOfSet * sets; ++i) fields.push_back(lines.text("a set of lamps"));
  const std::vector<double> flux = fluxOf(fields, static_cast<std::size_t>(sets), lines);
  record.lampCount = 1, record.lumensPerLamp = flux.front();
  record.multiplier *= flux.front() / 1000;
  if (std::ranges::any_of(flux, [&](double f) { return f != flux.front(); }))
    record.warnings.push_back(name + ": it has " + std::to_string(sets) + " sets of lamps; the first, of " +
                              std::to_string(std::lround(flux.front())) + " lm, counts");
}

/// How many planes are stored, and the first of them. [Stockmar90 (line 30)]
struct StoredPlanes {
  int first, count;
};

StoredPlanes storedPlanes(const LdtHead& head, const LdtLines& lines) {
  const auto share = [&](int parts) {
    if (head.planes % parts != 0)
      lines.fail("the symmetry divides the C planes into " + std::to_string(parts) + " parts, but there are " +
                 std::to_string(head.planes));
    return head.planes / parts;
  };
  switch (head.symmetry) {
    case 1:
      return {0, 1};
    case 2:
      return {0, share(2) + 1};
    case 3:
      return {3 * share(4), share(2) + 1};
    case 4:
      return {0, share(4) + 1};
    default:
      return {0, head.planes};
  }
}

/// The angles of the stored planes, as complete.hpp takes them, and whether they run the other way there.
bool setHorizontals(const LdtHead& head, const std::vector<double>& all, const StoredPlanes& stored,
                    const LdtLines& lines, IesRecord& record) {
  const auto expect = [&](double angle, double wanted) {
    if (std::abs(angle - wanted) > kSame)
      lines.fail("the symmetry wants a C plane at " + std::to_string(std::lround(wanted)) +
                 " degrees, and there is one at " + std::to_string(angle));
    return wanted;
  };
  const auto n = static_cast<std::size_t>(stored.count);
  const auto at = [&](std::size_t i) { return all[(static_cast<std::size_t>(stored.first) + i) % all.size()]; };
  for (std::size_t i = 0; i < n; ++i) record.horizontals.push_back(at(i));
  std::vector<double>& h = record.horizontals;
  if (head.symmetry == 1) return h = {0}, false;
  h.front() = expect(h.front(), head.symmetry == 3 ? 270 : 0);
  if (head.symmetry == 2) h.back() = expect(h.back(), 180);
  if (head.symmetry == 4) h.back() = expect(h.back(), 90);
  if (head.symmetry != 3) return false;
  // From C270 over C0 to C90; mirrored in that plane they are C270 to C90 the other way.
  h.back() = expect(h.back(), 90);
  for (double& angle : h) angle = angle >= 270 ? 540 - angle : 180 - angle;
  std::ranges::reverse(h);
  return true;
}

}  // namespace

bool namesLdt(const std::string& file) { return lowerCase(std::filesystem::path(file).extension().string()) == ".ldt"; }

IesRecord parseLdt(std::string_view file, const std::string& name) {
  const PlainText plain(file, name);
  LdtLines lines(plain.view(), name);
  IesRecord record;
  const LdtHead head = readHead(lines, record, name);
  readLamps(lines, record, name);
  for (int i = 0; i < kRatios; ++i) lines.number("a direct ratio");
  const std::vector<double> planes = lines.ascending(head.planes, "the C planes");
  record.anglesLine = lines.line();
  if (planes.front() < 0 || planes.back() > 360) lines.fail("C planes are not within 0 and 360 degrees");
  record.verticals = lines.ascending(head.angles, "the angles gamma");
  const StoredPlanes stored = storedPlanes(head, lines);
  const bool reversed = setHorizontals(head, planes, stored, lines, record);
  for (int i = 0; i < stored.count * head.angles; ++i) record.candela.push_back(lines.number("an intensity"));
  if (reversed) {
    std::vector<double> turned;
    for (std::size_t plane = record.horizontals.size(); plane-- > 0;)
      turned.insert(turned.end(), record.candela.begin() + static_cast<std::ptrdiff_t>(plane * record.verticals.size()),
                    record.candela.begin() + static_cast<std::ptrdiff_t>((plane + 1) * record.verticals.size()));
    record.candela = std::move(turned);
  }
  mendCandela(name, record);
  if (!trimmed(lines.rest()).empty())
    lines.fail("more follows than the counts announce", "check the numbers of planes and angles, and the symmetry");
  return record;
}

}  // namespace deltalux::io
