#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/points.hpp>
#include <deltalux/units.hpp>
#include <fstream>
#include <sstream>

#include "base/check.hpp"
#include "io/atomic_file.hpp"
#include "io/number.hpp"
#include "io/plain_text.hpp"
#include "io/trimmed.hpp"

namespace deltalux {

namespace {
constexpr std::array<const char*, 6> kNeeded{"x", "y", "z", "nx", "ny", "nz"};
constexpr double kLargestColumn = 1e15;  // coordinate [limit]
constexpr const char* kExpected = "a points file starts with a row x,y,z,nx,ny,nz";

/// Fields of one line; a comma within double quotes belongs to its field. [RFC 4180, one line per record]
std::vector<std::string> fieldsOf(std::string_view line) {
  std::vector<std::string> fields;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != ',')) continue;
    fields.emplace_back(io::trimmed(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  return fields;
}

std::string_view unquoted(std::string_view field) {
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') return field.substr(1, field.size() - 2);
  return field;
}

/// Quoted where a comma or a quote is in it.
std::string quotedField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  PointTable parse() {
    std::string_view line;
    if (!nextLine(line)) fail("there is no header row", kExpected);
    readHeader(line);
    while (nextLine(line)) readRow(line);
    if (table_.rows.empty()) fail("there are no points after the header row", kExpected);
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
    throw InputError(file_, line_, message, hint);
  }

  /// The next line that is neither blank nor a comment.
  bool nextLine(std::string_view& line) {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line = io::trimmed(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  }

  void readHeader(std::string_view line) {
    table_.columns = fieldsOf(line);
    for (std::string& name : table_.columns) name = std::string(unquoted(name));
    for (std::size_t i = 0; i < kNeeded.size(); ++i) {
      const auto found = std::find(table_.columns.begin(), table_.columns.end(), kNeeded[i]);
      if (found == table_.columns.end()) fail(fmt::format("the header row has no column {}", kNeeded[i]), kExpected);
      if (std::find(found + 1, table_.columns.end(), kNeeded[i]) != table_.columns.end())
        fail(fmt::format("the header row has column {} twice", kNeeded[i]), "remove one");
      needed_[i] = static_cast<std::size_t>(found - table_.columns.begin());
    }
  }

  void readRow(std::string_view line) {
    std::vector<std::string> row = fieldsOf(line);
    if (row.size() != table_.columns.size())
      fail(fmt::format("this row has {} fields, the header row {}", row.size(), table_.columns.size()),
           "every row needs a value for every column");
    std::array<double, 6> v{};
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = number(row[needed_[i]], kNeeded[i]);
    for (std::size_t i = 0; i < 3; ++i)
      if (std::abs(v[i]) > kLargestColumn)
        fail(fmt::format("column {}: {} is too far away", kNeeded[i], row[needed_[i]]), "points lie within 1e15 units");
    const double largest = std::max({std::abs(v[3]), std::abs(v[4]), std::abs(v[5])});
    if (!(largest > 0)) fail("the normal nx,ny,nz has no direction", "give the surface's normal");
    const Vec3 normal = Vec3(v[3], v[4], v[5]) / largest;  // first, so that squares neither vanish nor overflow
    table_.points.push_back({{v[0], v[1], v[2]}, glm::normalize(normal)});
    table_.rows.push_back(std::move(row));
  }

  double number(std::string_view field, const char* column) const {
    const std::string_view text = unquoted(field);
    if (const auto value = io::parseDecimal(text)) return *value;
    fail(fmt::format("column {}: {}", column, text.empty() ? "there is no number" : io::notANumber(text)),
         "write numbers like -1.25 or 3e-4");
  }

  std::string_view rest_;
  std::string file_;
  int line_ = 0;
  PointTable table_;
  std::array<std::size_t, 6> needed_{};
};

const std::vector<std::string> kResultColumns{"E_r", "E_g", "E_b", "lux", "se_r", "se_g", "se_b"};

std::string resultFields(const ProbeResult& result, double luminousEfficacy) {
  const glm::dvec3 E = result.irradiance, se = result.standardError;
  return fmt::format("{:.7g},{:.7g},{:.7g},{:.7g},{:.4g},{:.4g},{:.4g}", E.r, E.g, E.b,
                     photometric(E, luminousEfficacy), se.r, se.g, se.b);
}
}  // namespace

std::optional<std::size_t> PointTable::column(std::string_view name) const {
  const auto at = std::ranges::find(columns, name);
  if (at == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(at - columns.begin());
}

PointTable parsePoints(std::string_view text, const std::string& fileName) {
  const io::PlainText plain(text, fileName);
  return Parser(plain.view(), fileName).parse();
}

PointTable readPoints(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (!stream || std::filesystem::is_directory(path) || !(text << stream.rdbuf()))
    throw InputError(path.string(), 0, "cannot read this points file", kExpected);
  return parsePoints(std::move(text).str(), path.string());
}

std::vector<ProbePoint> pointsIn(const Scene& scene, const PointTable& table) {
  std::vector<ProbePoint> points = table.points;
  for (ProbePoint& p : points) p.position -= scene.origin;
  return points;
}

std::string formatProbeColumns(const PointTable& table, std::span<const std::string> names,
                               std::span<const std::vector<ProbeResult>> results, double luminousEfficacy) {
  DELTALUX_CHECK(results.size() == names.size(), "results of each group");
  std::vector<std::string> added;
  for (const std::string& name : names) added.push_back(quotedField("lux_" + name));
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (std::ranges::find(added, table.columns[i]) == added.end()) kept.push_back(i);
  std::vector<std::string> fields;
  for (const std::size_t i : kept) fields.push_back(table.columns[i]);
  fields.insert(fields.end(), added.begin(), added.end());
  std::string text = fmt::format("{}\n", fmt::join(fields, ","));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    fields.clear();
    for (const std::size_t i : kept) fields.push_back(table.rows[row][i]);
    for (const std::vector<ProbeResult>& group : results)
      fields.push_back(fmt::format("{:.7g}", photometric(group[row].irradiance, luminousEfficacy)));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

void writeProbeColumns(const std::filesystem::path& path, const PointTable& table, std::span<const std::string> names,
                       std::span<const std::vector<ProbeResult>> results, double luminousEfficacy) {
  io::writeFile(path, formatProbeColumns(table, names, results, luminousEfficacy));
}

std::string formatProbeResults(const PointTable& table, std::span<const ProbeResult> results, double luminousEfficacy) {
  DELTALUX_CHECK(results.size() == table.rows.size(), "one result per point");
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (std::ranges::find(kResultColumns, table.columns[i]) == kResultColumns.end()) kept.push_back(i);

  std::string text;
  for (const std::size_t i : kept) text += table.columns[i] + ",";
  text += fmt::format("{}\n", fmt::join(kResultColumns, ","));
  for (std::size_t row = 0; row < results.size(); ++row) {
    for (const std::size_t i : kept) text += table.rows[row][i] + ",";
    text += resultFields(results[row], luminousEfficacy) + "\n";
  }
  return text;
}

void writeProbeResults(const std::filesystem::path& path, const PointTable& table, std::span<const ProbeResult> results,
                       double luminousEfficacy) {
  io::writeFile(path, formatProbeResults(table, results, luminousEfficacy));
}

}  // namespace deltalux
