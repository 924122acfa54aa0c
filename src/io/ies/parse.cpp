#include "io/ies/parse.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <deltalux/error.hpp>
#include <optional>

#include "io/ies/number_reader.hpp"
#include "io/import_file.hpp"
#include "io/plain_text.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io {

namespace {

constexpr int kMaxAngles = 100000;  // [limit]
constexpr double kFoot = 0.3048;    // [m] [defined]

std::string upperCase(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  return upper;
}

// Files of 1986 name no standard.
int revisionOf(std::string_view firstLine) {
  constexpr std::string_view kTag = "LM-63-";
  const std::string line = upperCase(firstLine.substr(0, 80));
  if (line.find("IESNA91") != std::string::npos) return 1991;
  const std::size_t tag = line.find(kTag);
  int year = 1986;
  if (tag != std::string::npos) {
    const char* const digits = line.data() + tag + kTag.size();
    std::from_chars(digits, line.data() + line.size(), year);
  }
  return year;
}

// The TILT= line divides labels from numbers.
struct Layout {
  std::string_view tilt;     // what stands behind TILT=
  std::string_view numbers;  // from the line after it
  int numbersLine = 0;
};

std::optional<Layout> findTilt(std::string_view text) {
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view content = trimmed(text.substr(begin, end - begin));
    const std::string_view behind = content.size() > 4 ? trimmed(content.substr(4)) : std::string_view();
    if (upperCase(content.substr(0, 4)) == "TILT" && !behind.empty() && behind.front() == '=') {
      return Layout{trimmed(behind.substr(1)), text.substr(std::min(end + 1, text.size())), line + 1};
    }
    begin = end + 1;
  }
  return std::nullopt;
}

// The four tilt records; returns the lamp's factor in the position of measurement, at 0 degrees.
double readTiltFactor(NumberReader& reader, const std::string& name) {
  reader.integer("the lamp-to-luminaire geometry", 1, 3);
  const int count = reader.integer("the number of tilt angles", 1, kMaxAngles);
  const std::vector<double> angles = reader.ascending(count, "the tilt angles");
  const std::vector<double> factors = reader.numbers(count, "the tilt factors");
  if (*std::min_element(factors.begin(), factors.end()) < 0) {
    throw InputError(name, reader.line(), "a tilt factor is negative", "compare the file with its IES LM-63 standard");
  }
  const std::size_t above =
      static_cast<std::size_t>(std::upper_bound(angles.begin(), angles.end(), 0.0) - angles.begin());
  if (above == 0) return factors.front();
  if (above == angles.size()) return factors.back();
  const double t = -angles[above - 1] / (angles[above] - angles[above - 1]);
  return (1 - t) * factors[above - 1] + t * factors[above];
}

double tiltFactorOfFile(const std::string& reference, const std::string& name, const std::filesystem::path& folder,
                        int line, std::vector<std::string>& warnings) {
  const std::filesystem::path file = resolveReference(reference, folder, name, line, false);
  if (!std::filesystem::is_regular_file(file)) {
    warnings.push_back(name + ": tilt file '" + reference +
                       "' is not there; the lamp is taken as in its test position");
    return 1;
  }
  const std::string read = readInputFile(file);
  const PlainText plain(read, file.string());
  NumberReader reader(plain.view(), file.string(), 1);
  return readTiltFactor(reader, file.string());
}

double tiltFactor(const Layout& layout, NumberReader& reader, const std::string& name,
                  const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  const std::string kind = upperCase(layout.tilt);
  if (kind == "NONE" || kind.empty()) return 1;
  const double factor = kind == "INCLUDE" ? readTiltFactor(reader, name)
                                          : tiltFactorOfFile(std::string(layout.tilt.substr(0, 255)), name, folder,
                                                             layout.numbersLine - 1, warnings);
  if (factor != 1) {
    warnings.push_back(name + ": the lamp's tilt factor at 0 degrees, " + std::to_string(factor) + ", was applied");
  }
  return factor;
}

void readHeader(NumberReader& reader, const std::string& name, IesRecord& record) {
  record.lampCount = reader.number("the number of lamps");
  record.lumensPerLamp = reader.number("the lumens per lamp");
  const double multiplier = reader.number("the candela multiplier");
  if (!(multiplier > 0)) {
    throw InputError(name, reader.line(), "the candela multiplier is not positive",
                     "set it to 1 if nothing else is known");
  }
  record.multiplier *= multiplier;
}

void readDimensions(NumberReader& reader, IesRecord& record) {
  const double unit = reader.integer("the units type (1 feet, 2 metres)", 1, 2) == 1 ? kFoot : 1.0;
  record.width = unit * reader.number("the luminous width");
  record.length = unit * reader.number("the luminous length");
  record.height = unit * reader.number("the luminous height");
}

// The middle field was the ballast-lamp photometric factor before 1995, "future use" from then on, and says how the
// file came about in 2019 (1.1 is an accredited test, no factor). [LM-63]
void readElectrical(NumberReader& reader, const std::string& name, IesRecord& record) {
  double factor = reader.number("the ballast factor");
  const double second = reader.number("the ballast-lamp factor");
  if (record.revision < 1995) factor *= second;
  reader.number("the input watts");
  if (factor > 0) {
    record.multiplier *= factor;
  } else {
    record.warnings.push_back(name + ": the ballast factor is not positive; taken as 1");
  }
}

}  // namespace

// Below zero is the noise of a measurement, or a mistake; it is no light.
void mendCandela(const std::string& name, IesRecord& record) {
  const auto negative = std::count_if(record.candela.begin(), record.candela.end(), [](double i) { return i < 0; });
  const double lowest = *std::min_element(record.candela.begin(), record.candela.end());
  for (double& value : record.candela) value = std::max(value, 0.0);
  if (negative > 0) {
    record.warnings.push_back(name + ": " + std::to_string(negative) + " of " + std::to_string(record.candela.size()) +
                              " candela values are negative, down to " + std::to_string(lowest) + "; taken as 0");
  }
  const auto dark = [](double value) { return value == 0; };
  if (std::all_of(record.candela.begin(), record.candela.end(), dark))
    record.warnings.push_back(name + ": no candela value is above 0; the luminaire gives no light");
}

IesRecord parseIes(std::string_view file, const std::string& name, const std::filesystem::path& folder) {
  const PlainText plain(file, name);
  const std::string_view text = plain.view();
  const std::optional<Layout> layout = findTilt(text);
  if (!layout) {
    throw InputError(name, 0, "is not an IES LM-63 file: it has no line TILT=",
                     "give a photometric file: LM-63, TM-33 in XML, or EULUMDAT in a file named .ldt");
  }
  IesRecord record;
  record.revision = revisionOf(text.substr(0, text.find('\n')));
  NumberReader reader(layout->numbers, name, layout->numbersLine);
  record.multiplier = tiltFactor(*layout, reader, name, folder, record.warnings);
  readHeader(reader, name, record);
  const int verticalCount = reader.integer("the number of vertical angles", 2, kMaxAngles);
  const int horizontalCount = reader.integer("the number of horizontal angles", 1, kMaxAngles);
  record.type = static_cast<PhotometricType>(reader.integer("the photometric type (1 C, 2 B, 3 A)", 1, 3));
  readDimensions(reader, record);
  readElectrical(reader, name, record);
  record.verticals = reader.ascending(verticalCount, "the vertical angles");
  record.horizontals = reader.ascending(horizontalCount, "the horizontal angles");
  record.anglesLine = reader.line();
  if (verticalCount > kMaxAngles * 100 / horizontalCount) {
    throw InputError(name, reader.line(), "more than ten million candela values are announced", "thin out the angles");
  }
  record.candela = reader.numbers(verticalCount * horizontalCount, "the candela values");
  mendCandela(name, record);
  const std::string_view rest = reader.rest();
  if (!rest.empty() && (std::isdigit(static_cast<unsigned char>(rest.front())) || rest.front() == '.')) {
    throw InputError(name, reader.line(), "more numbers follow than the counts announce",
                     "check the numbers of angles, and that decimals are written with a point");
  }
  return record;
}

}  // namespace deltalux::io
