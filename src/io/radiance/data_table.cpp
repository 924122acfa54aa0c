#include "io/radiance/data_table.hpp"

#include <algorithm>
#include <cmath>

#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr long kMostDimensions = 5;       // [limit]
constexpr long kMostPoints = 10'000'000;  // of one dimension [limit]

class DataReader {
 public:
  explicit DataReader(const SourceFile& file)
      : text_(file.text), name_(std::make_shared<const std::string>(file.name)) {}

  DataTable read() {
    DataTable table;
    const long dimensions = integer("the number of dimensions");
    if (dimensions < 1 || dimensions > kMostDimensions) fail("a data file has one to five dimensions");
    double values = 1;
    for (long i = 0; i < dimensions; ++i) {
      table.dimensions.push_back(dimension());
      values *= static_cast<double>(table.dimensions.back().count);
    }
    // Each value takes a digit and a space at least: what cannot be there needs no memory.
    if (2 * values > static_cast<double>(text_.size()) + 1) fail("the file ends before its last value");
    table.values.reserve(static_cast<std::size_t>(values));
    for (std::size_t i = 0; i < static_cast<std::size_t>(values); ++i) table.values.push_back(number("a value"));
    return table;
  }

 private:
  DataTable::Dimension dimension() {
    DataTable::Dimension d;
    d.begin = number("where a dimension begins"), d.end = number("where a dimension ends");
    const long count = integer("the number of points");
    if (count < 1 || count > kMostPoints) fail("a dimension has 1 to " + std::to_string(kMostPoints) + " points");
    d.count = static_cast<std::size_t>(count);
    if (d.begin != d.end || count == 1) return d;
    for (std::size_t i = 0; i < d.count; ++i) d.points.push_back(number("a coordinate"));
    const bool ascending = d.points[1] > d.points[0];
    for (std::size_t i = 1; i < d.count; ++i) {
      if (d.points[i] == d.points[i - 1] || (d.points[i] > d.points[i - 1]) != ascending) {
        fail("the coordinates of a dimension are not in order");
      }
    }
    d.begin = d.points.front(), d.end = d.points.back();
    return d;
  }

  std::string_view word(const char* what) {
    const auto space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    for (bool comment = false; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') ++line_, comment = false;
      if (text_[at_] == '#') comment = true;
      if (!comment && !space(text_[at_])) break;
    }
    if (at_ == text_.size()) fail(std::string("the file ends before ") + what);
    const std::size_t begin = at_;
    while (at_ < text_.size() && !space(text_[at_]) && text_[at_] != '#') ++at_;
    return text_.substr(begin, at_ - begin);
  }
  double number(const char* what) {
    const std::string_view w = word(what);
    return requireNumber(w, where(), what);
  }
  long integer(const char* what) {
    const std::string_view w = word(what);
    return requireInteger(w, where(), what);
  }
  SourceLine where() const { return {name_, line_}; }
  [[noreturn]] void fail(const std::string& message) const {
    throw inputError(where(), message, "Radiance's data files: dimensions, their points, then the values");
  }

  std::string_view text_;
  std::shared_ptr<const std::string> name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Which step of the dimension, and how far along it: below 0 and above 1 outside.
struct Step {
  std::size_t index = 0;
  double along = 0;
};

Step locate(const DataTable::Dimension& d, double x) {
  if (d.count < 2) return {};
  const std::size_t last = d.count - 2;
  if (d.points.empty()) {
    const double steps = (x - d.begin) / (d.end - d.begin) * static_cast<double>(d.count - 1);
    const auto index = static_cast<std::size_t>(std::clamp(std::floor(steps), 0.0, static_cast<double>(last)));
    return {index, steps - static_cast<double>(index)};
  }
  const bool ascending = d.end > d.begin;
  const auto above = std::upper_bound(d.points.begin() + 1, d.points.end() - 1, x,
                                      [&](double a, double b) { return ascending ? a < b : a > b; });
  const auto index = std::min(static_cast<std::size_t>(above - d.points.begin()) - 1, last);
  return {index, (x - d.points[index]) / (d.points[index + 1] - d.points[index])};
}

double valueBelow(const DataTable& table, std::span<const double> at, std::size_t dimension, std::size_t offset) {
  if (dimension == table.dimensions.size()) return table.values[offset];
  const DataTable::Dimension& d = table.dimensions[dimension];
  const Step step = locate(d, at[dimension]);
  const std::size_t first = offset * d.count + step.index;
  const double y0 = valueBelow(table, at, dimension + 1, first);
  if (d.count < 2) return y0;
  const double y1 = valueBelow(table, at, dimension + 1, first + 1), t = step.along;
  if (t > 2) return (2 * y1 - y0) / (t - 1);
  if (t < -1) return (2 * y0 - y1) / -t;
  return (1 - t) * y0 + t * y1;
}

}  // namespace

DataTable parseDataTable(const SourceFile& file) { return DataReader(file).read(); }

double valueAt(const DataTable& table, std::span<const double> at) {
  for (const double x : at) {
    if (!std::isfinite(x)) return std::nan("");
  }
  return valueBelow(table, at, 0, 0);
}

}  // namespace deltalux::io::radiance
