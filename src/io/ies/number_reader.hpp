#pragma once
// Numbers one by one, wherever lines break.
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

/// Reads numbers from `text`, which starts at line `line` of the file `name`; blanks, commas and line ends separate
/// them. Every function throws InputError with the line.
class NumberReader {
 public:
  NumberReader(std::string_view text, std::string name, int line);

  /// The next number, always finite; `what` names it in messages.
  double number(const char* what);
  /// The next number, which must be whole and in [low, high] (1986 files write 3.0 for 3).
  int integer(const char* what, int low, int high);
  /// `count` numbers; counts that the rest of the text cannot hold are refused before anything is stored.
  std::vector<double> numbers(int count, const char* what);
  /// `count` numbers, each greater than the one before.
  std::vector<double> ascending(int count, const char* what);
  /// What is left of the text, without leading separators.
  std::string_view rest();

  int line() const { return line_; }  // of the last number read

 private:
  std::string_view next(const char* what);
  void expectRoomFor(int count, const char* what);

  std::string_view text_;
  std::string name_;
  int line_;
};

}  // namespace deltalux::io
