#pragma once
// Errors by who can mend them: InputError is the user's (exit 3), OutputError the file system's (exit 4);
// misuse of the library fails a DELTALUX_CHECK (src/base/check.hpp).
#include <stdexcept>
#include <string>

namespace deltalux {

/// Something in the user's input is wrong. what() reads "FILE:LINE: MESSAGE (HINT)"; line 0 means the file as a whole.
class InputError : public std::runtime_error {
 public:
  InputError(std::string file, int line, std::string message, std::string hint = {});

  const std::string& file() const { return file_; }
  int line() const { return line_; }
  const std::string& message() const { return message_; }
  const std::string& hint() const { return hint_; }

 private:
  std::string file_;
  int line_;
  std::string message_;
  std::string hint_;
};

/// An output file could not be written; what stood there before still stands.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user interrupted long work (exit 130).
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace deltalux
