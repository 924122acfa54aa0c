#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// Largest magnitude a number of a scene may have; beyond it single-precision rays lose the scene.
inline constexpr double kLargestNumber = 1e12;  // [limit]

/// A number that is finite and at most kLargestNumber in magnitude, from all of `word`; nullopt otherwise.
std::optional<double> parseNumber(std::string_view word);
std::optional<long> parseInteger(std::string_view word);
/// As above; throws InputError that names `what`.
double requireNumber(std::string_view word, const SourceLine& where, std::string_view what);
long requireInteger(std::string_view word, const SourceLine& where, std::string_view what);

/// Words of a scene description (a PlainText): separated by white space, quoted with " or ' when they hold some.
class Lexer {
 public:
  Lexer(std::string_view text, std::shared_ptr<const std::string> file) : text_(text), file_(std::move(file)) {}

  /// Skips white space and, before an object, comments. False at the end of the text.
  bool skipToObject();
  bool atCommand() const { return text_[position_] == '!'; }
  /// The command line at the position, without its '!'; backslash-newline pairs are taken out.
  std::string commandLine();
  /// Skips white space; the next word, or nullopt at the end.
  std::optional<std::string_view> word();

  SourceLine where() const { return {file_, line_}; }

 private:
  void advance();

  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  std::size_t position_ = 0;
  int line_ = 1;
};

}  // namespace deltalux::io::radiance
