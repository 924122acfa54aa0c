#include "io/number.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace deltalux::io {

namespace {

enum class Reading { Fine, Huge, Word };

// Whether digits that are out of range lie beyond the smallest double, not the largest: by the power of ten of the
// first digit that is not zero.
bool isTiny(std::string_view digits) {
  const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, e);
  const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
  const auto first = static_cast<long>(std::min(mantissa.find_first_of("123456789"), mantissa.size()));
  long exponent = 0;
  if (e < digits.size()) {
    std::string_view power = digits.substr(e + 1);
    const bool negative = power.starts_with('-');
    if (power.starts_with('+') || negative) power.remove_prefix(1);
    const auto [end, error] = std::from_chars(power.data(), power.data() + power.size(), exponent);
    if (error != std::errc()) return negative;
    if (negative) exponent = -exponent;
  }
  return point - first + exponent < 0;
}

Reading readDecimal(std::string_view word, double& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return Reading::Word;
  if (error == std::errc::result_out_of_range) {
    value = 0;
    return isTiny(word.substr(word.starts_with('-') ? 1 : 0)) ? Reading::Fine : Reading::Huge;
  }
  return std::isfinite(value) ? Reading::Fine : Reading::Word;
}

}  // namespace

std::optional<double> parseDecimal(std::string_view word) {
  double value = 0;
  if (readDecimal(word, value) != Reading::Fine) return std::nullopt;
  return value;
}

std::string notANumber(std::string_view word) {
  constexpr std::size_t kShown = 40;  // [shown]
  double value = 0;
  const bool huge = readDecimal(word, value) == Reading::Huge;
  return "'" + std::string(word.substr(0, kShown)) + (word.size() > kShown ? "...' " : "' ") +
         (huge ? "is too large a number" : "is not a number");
}

}  // namespace deltalux::io
