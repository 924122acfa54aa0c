#include "io/obj/lines.hpp"

#include <algorithm>

namespace deltalux::io {

bool LineStreambuf::loadLine() {
  if (text_.empty()) return false;
  current_.clear();
  for (bool joined = true; joined && !text_.empty();) {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view part = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    joined = part.ends_with('\\');
    if (joined) part.remove_suffix(1);
    current_ += part;
    ++line_;
  }
  // tinyobjloader overlooks a group without a name, which ends the group before it.
  if (current_ == "g") current_ += ' ';
  current_ += '\n';
  setg(current_.data(), current_.data(), current_.data() + current_.size());
  return true;
}

bool LineStreambuf::advance(std::string_view& content) {
  if (!loadLine()) return false;
  content = std::string_view(current_).substr(0, current_.size() - 1);
  return true;
}

LineStreambuf::int_type LineStreambuf::underflow() {
  return gptr() < egptr() || loadLine() ? traits_type::to_int_type(*gptr()) : traits_type::eof();
}

}  // namespace deltalux::io
