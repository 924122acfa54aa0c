#include "io/ply/values.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <deltalux/error.hpp>

#include "io/number.hpp"

namespace deltalux::io::ply {

namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

template <class T>
double numberOf(const char* bytes, bool swapped) {
  char ordered[sizeof(T)];
  std::memcpy(ordered, bytes, sizeof(T));
  if (swapped) std::reverse(ordered, ordered + sizeof(T));
  return static_cast<double>(std::bit_cast<T>(ordered));
}

constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};  // of Number's types [layout]

}  // namespace

void Values::fail(const std::string& message) const {
  throw InputError(file_, encoding_ == Encoding::Text ? line_ : 0, message, "export it again");
}

void Values::fail(const Element& element, const std::string& message) const {
  throw InputError(file_, element.line, message, "export it again");
}

double Values::nextWord() {
  std::size_t begin = 0;
  for (; begin < rest_.size() && isSpace(rest_[begin]); ++begin) line_ += rest_[begin] == '\n';
  std::size_t end = begin;
  while (end < rest_.size() && !isSpace(rest_[end])) ++end;
  const std::string_view word = rest_.substr(begin, end - begin);
  if (word.empty()) fail("the file ends before all that its header announces");
  rest_.remove_prefix(end);
  const std::optional<double> value = parseDecimal(word);
  if (!value) fail(notANumber(word));
  return *value;
}

double Values::next(Number number) {
  if (encoding_ == Encoding::Text) return nextWord();
  const std::size_t size = kSizes[static_cast<std::size_t>(number)];
  if (rest_.size() < size) fail("the file ends before all that its header announces");
  const char* bytes = rest_.data();
  rest_.remove_prefix(size);
  const bool swapped = (encoding_ == Encoding::BigEndian) == (std::endian::native == std::endian::little);
  switch (number) {
    case Number::Int8:
      return numberOf<std::int8_t>(bytes, swapped);
    case Number::Uint8:
      return numberOf<std::uint8_t>(bytes, swapped);
    case Number::Int16:
      return numberOf<std::int16_t>(bytes, swapped);
    case Number::Uint16:
      return numberOf<std::uint16_t>(bytes, swapped);
    case Number::Int32:
      return numberOf<std::int32_t>(bytes, swapped);
    case Number::Uint32:
      return numberOf<std::uint32_t>(bytes, swapped);
    case Number::Float32:
      return numberOf<float>(bytes, swapped);
    case Number::Float64:
      break;
  }
  return numberOf<double>(bytes, swapped);
}

std::size_t Values::nextCount(Number number) {
  constexpr double kMost = 4e9;  // what indices and counts of 32 bits hold [limit]
  const double value = next(number);
  if (!(value >= 0 && value <= kMost) || value != std::floor(value)) fail("a count or an index is no integer from 0");
  return static_cast<std::size_t>(value);
}

void Values::skip(const Property& property) {
  for (std::size_t left = property.count ? nextCount(*property.count) : 1; left > 0; --left) next(property.number);
}

}  // namespace deltalux::io::ply
