#pragma once
// Lines of a PlainText with their numbers, as a stream that says which line it stands at.
#include <streambuf>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Serves one line at a time, a line that ends in a backslash together with the next. Whatever reads the stream line by
/// line, line() is the number of the line (its last one, if joined) that was served last.
class LineStreambuf : public std::streambuf {
 public:
  explicit LineStreambuf(std::string_view text) : text_(text) {}

  int line() const { return line_; }
  /// The next line without its end, skipping what is left of the present one; false at the end of the text.
  bool advance(std::string_view& content);

 protected:
  int_type underflow() override;

 private:
  bool loadLine();

  std::string_view text_;
  std::string current_;  // with '\n'
  int line_ = 0;
};

}  // namespace deltalux::io
