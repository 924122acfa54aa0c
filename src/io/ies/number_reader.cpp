#include "io/ies/number_reader.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>

#include "io/number.hpp"

namespace deltalux::io {

namespace {
constexpr std::string_view kSeparators(" \t\r\n,\f\v", 7);
constexpr const char* kStandardHint = "compare the file with its IES LM-63 standard, or get it again from the maker";
}  // namespace

NumberReader::NumberReader(std::string_view text, std::string name, int line)
    : text_(text), name_(std::move(name)), line_(line) {}

std::string_view NumberReader::rest() {
  const std::size_t begin = std::min(text_.find_first_not_of(kSeparators), text_.size());
  line_ += static_cast<int>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
  text_.remove_prefix(begin);
  return text_;
}

std::string_view NumberReader::next(const char* what) {
  if (rest().empty()) throw InputError(name_, line_, std::string("the file ends before ") + what, kStandardHint);
  const std::string_view token = text_.substr(0, text_.find_first_of(kSeparators));
  text_.remove_prefix(token.size());
  return token;
}

double NumberReader::number(const char* what) {
  const std::string_view token = next(what);
  if (const auto value = parseDecimal(token)) return *value;
  throw InputError(name_, line_, notANumber(token) + " for " + what, kStandardHint);
}

int NumberReader::integer(const char* what, int low, int high) {
  const double value = number(what);
  if (value != std::floor(value) || value < low || value > high) {
    throw InputError(
        name_, line_,
        std::string(what) + " must be a whole number from " + std::to_string(low) + " to " + std::to_string(high),
        kStandardHint);
  }
  return static_cast<int>(value);
}

void NumberReader::expectRoomFor(int count, const char* what) {
  // Each takes a digit and, all but the last, a separator.
  if (static_cast<std::size_t>(count) > text_.size() / 2 + 1) {
    throw InputError(name_, line_,
                     std::to_string(count) + " values for " + what + " are announced, the file is too short",
                     kStandardHint);
  }
}

std::vector<double> NumberReader::numbers(int count, const char* what) {
  expectRoomFor(count, what);
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = number(what);
  return values;
}

std::vector<double> NumberReader::ascending(int count, const char* what) {
  expectRoomFor(count, what);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(number(what));
    if (i > 0 && values[values.size() - 1] <= values[values.size() - 2]) {
      throw InputError(name_, line_, std::string(what) + " do not ascend", kStandardHint);
    }
  }
  return values;
}

}  // namespace deltalux::io
