#pragma once
// Text files as they come from any system and editor.
#include <string>
#include <string_view>

namespace deltalux::io {

/// A text with '\n' at the end of its lines, whatever it had there (CR LF, CR), and without the byte order mark of
/// UTF-8. Costs a copy only where a CR stands. Throws InputError in the name of `file` for UTF-16, which no reader here
/// takes.
class PlainText {
 public:
  PlainText(std::string_view text, const std::string& file);
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

  /// Valid as long as this and the text it was made from.
  std::string_view view() const { return view_; }

 private:
  std::string copy_;
  std::string_view view_;
};

}  // namespace deltalux::io
