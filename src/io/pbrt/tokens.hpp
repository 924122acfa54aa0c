#pragma once
// The words of a pbrt file. [pbrt]
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace deltalux::io::pbrt {

/// Where something stands. The name belongs to whoever reads the files.
struct Place {
  const std::string* file = nullptr;
  int line = 0;
};

[[noreturn]] void fail(const Place&, const std::string& message);

struct Token {
  enum class Kind { Word, Text, Open, Close };  // Text: what stood in quotes
  Kind kind = Kind::Word;
  std::string_view text;
  int line = 0;
};

/// One file's tokens in order; their texts live as long as this.
class Tokens {
 public:
  Tokens(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  /// The next one, which stays; nullptr at the end. Throws InputError with the line.
  const Token* peek();
  /// The next one; an error at the end, which says what was wanted.
  Token take(const char* wanted);
  /// The text of the next one, which must be in quotes.
  std::string takeText(const char* wanted);
  /// The next one, a number of reasonable size.
  double takeNumber();
  /// Passes over the next one if it is that.
  bool passed(Token::Kind);

  Place place() const { return {&file_, line_}; }

 private:
  bool advance();
  std::string_view quoted();

  std::string_view rest_;
  const std::string& file_;
  int line_ = 1;
  std::optional<Token> next_;
  std::deque<std::string> unescaped_;
};

/// The number that a word is. Throws InputError.
double numberOf(std::string_view word, const Place&);

/// A word as messages show it.
std::string shown(std::string_view word);

}  // namespace deltalux::io::pbrt
