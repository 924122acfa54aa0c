#pragma once
// The numbers of a PLY file's body, one after the other.
#include <string>
#include <string_view>

#include "io/ply/header.hpp"

namespace deltalux::io::ply {

class Values {
 public:
  Values(std::string_view bytes, const Header& header, const std::string& file)
      : rest_(bytes.substr(header.size)), encoding_(header.encoding), line_(header.lines + 1), file_(file) {}

  /// The next number, of that type. Throws InputError at the end, and at a word of text that is none.
  double next(Number);
  /// The next number as a count, from 0.
  std::size_t nextCount(Number);
  void skip(const Property&);
  /// No more numbers than that can follow.
  std::size_t atMost() const { return rest_.size(); }

  [[noreturn]] void fail(const std::string& message) const;
  /// In a line of the header.
  [[noreturn]] void fail(const Element&, const std::string& message) const;

 private:
  double nextWord();

  std::string_view rest_;
  Encoding encoding_;
  int line_;
  const std::string& file_;
};

}  // namespace deltalux::io::ply
