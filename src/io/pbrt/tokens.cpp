#include "io/pbrt/tokens.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>

#include "io/number.hpp"

namespace deltalux::io::pbrt {

namespace {

constexpr double kMostNumber = 1e15;  // of all numbers [limit]
constexpr std::size_t kShown = 40;    // [shown]

}  // namespace

void fail(const Place& at, const std::string& message) {
  throw InputError(*at.file, at.line, message, "compare the scene with pbrt-v4's documentation of its format");
}

std::string shown(std::string_view word) {
  return "'" + std::string(word.substr(0, kShown)) + (word.size() > kShown ? "...'" : "'");
}

double numberOf(std::string_view word, const Place& at) {
  const std::optional<double> value = parseDecimal(word);
  if (!value) fail(at, notANumber(word));
  if (!(std::abs(*value) <= kMostNumber)) fail(at, shown(word) + " is too large a number");
  return *value;
}

std::string_view Tokens::quoted() {
  const std::size_t end = [&] {
    std::size_t i = 1;
    while (i < rest_.size() && rest_[i] != '"' && rest_[i] != '\n') i += rest_[i] == '\\' ? 2 : 1;
    return i;
  }();
  if (end >= rest_.size() || rest_[end] != '"') fail(place(), "a text in quotes does not end in its line");
  const std::string_view raw = rest_.substr(1, end - 1);
  rest_.remove_prefix(end + 1);
  if (raw.find('\\') == std::string_view::npos) return raw;
  std::string plain;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\') {
      plain += raw[i];
      continue;
    }
    constexpr std::string_view kEscaped = "bfnrt\\\"'", kMeant = "\b\f\n\r\t\\\"'";
    const std::size_t which = kEscaped.find(raw[++i]);
    if (which == std::string_view::npos) fail(place(), "a text has an escape that pbrt does not know");
    plain += kMeant[which];
  }
  return unescaped_.emplace_back(std::move(plain));
}

bool Tokens::advance() {
  for (;;) {
    const std::size_t blanks = std::min(rest_.find_first_not_of(" \t\n"), rest_.size());
    line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(blanks), '\n'));
    rest_.remove_prefix(blanks);
    if (!rest_.starts_with('#')) break;
    rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
  }
  if (rest_.empty()) return false;
  const char first = rest_.front();
  if (first == '"') {
    next_ = Token{Token::Kind::Text, quoted(), line_};
  } else if (first == '[' || first == ']') {
    next_ = Token{first == '[' ? Token::Kind::Open : Token::Kind::Close, rest_.substr(0, 1), line_};
    rest_.remove_prefix(1);
  } else {
    const std::size_t end = std::min(rest_.find_first_of(" \t\n\"[]#"), rest_.size());
    next_ = Token{Token::Kind::Word, rest_.substr(0, end), line_};
    rest_.remove_prefix(end);
  }
  return true;
}

const Token* Tokens::peek() { return next_ || advance() ? &*next_ : nullptr; }

Token Tokens::take(const char* wanted) {
  if (!peek()) fail(place(), std::string("the file ends where ") + wanted + " should stand");
  const Token token = *next_;
  next_.reset();
  return token;
}

std::string Tokens::takeText(const char* wanted) {
  const Token token = take(wanted);
  if (token.kind != Token::Kind::Text)
    fail(place(), shown(token.text) + " stands where " + wanted + " in quotes should stand");
  return std::string(token.text);
}

double Tokens::takeNumber() {
  const Token token = take("a number");
  if (token.kind != Token::Kind::Word) fail(place(), shown(token.text) + " stands where a number should stand");
  return numberOf(token.text, place());
}

bool Tokens::passed(Token::Kind kind) {
  if (!peek() || next_->kind != kind) return false;
  next_.reset();
  return true;
}

}  // namespace deltalux::io::pbrt
