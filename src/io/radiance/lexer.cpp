#include "io/radiance/lexer.hpp"

#include <charconv>
#include <cmath>

#include "io/number.hpp"

namespace deltalux::io::radiance {

namespace {
bool isSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 40;  // [shown]
  return "'" + std::string(word.substr(0, kLongest)) + (word.size() > kLongest ? "...'" : "'");
}

/// from_chars takes no leading plus sign.
std::string_view withoutPlus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}
}  // namespace

std::optional<double> parseNumber(std::string_view word) {
  const auto value = parseDecimal(word);
  if (!value || std::abs(*value) > kLargestNumber) return std::nullopt;
  return value;
}

std::optional<long> parseInteger(std::string_view word) {
  word = withoutPlus(word);
  long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

double requireNumber(std::string_view word, const SourceLine& where, std::string_view what) {
  if (const auto value = parseNumber(word)) return *value;
  throw inputError(where, shown(word) + " is no usable number for " + std::string(what),
                   "numbers are finite and at most 1e12 in magnitude");
}

long requireInteger(std::string_view word, const SourceLine& where, std::string_view what) {
  if (const auto value = parseInteger(word)) return *value;
  throw inputError(where, shown(word) + " is no integer for " + std::string(what));
}

void Lexer::advance() {
  if (text_[position_] == '\n') ++line_;
  ++position_;
}

bool Lexer::skipToObject() {
  while (position_ < text_.size()) {
    if (text_[position_] == '#') {
      while (position_ < text_.size() && text_[position_] != '\n') advance();
    } else if (isSpace(text_[position_])) {
      advance();
    } else {
      return true;
    }
  }
  return false;
}

std::string Lexer::commandLine() {
  std::string command;
  for (advance(); position_ < text_.size() && text_[position_] != '\n'; advance()) {
    const std::string_view rest = text_.substr(position_);
    if (rest.starts_with("\\\n")) {
      advance();
    } else {
      command += text_[position_];
    }
  }
  return command;
}

std::optional<std::string_view> Lexer::word() {
  while (position_ < text_.size() && isSpace(text_[position_])) advance();
  if (position_ >= text_.size()) return std::nullopt;
  const char quote = text_[position_];
  const bool quoted = quote == '"' || quote == '\'';
  if (quoted) advance();
  const std::size_t begin = position_;
  while (position_ < text_.size() && (quoted ? text_[position_] != quote : !isSpace(text_[position_]))) advance();
  const std::string_view found = text_.substr(begin, position_ - begin);
  if (quoted && position_ < text_.size()) advance();
  return found;
}

}  // namespace deltalux::io::radiance
