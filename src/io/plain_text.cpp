#include "io/plain_text.hpp"

#include <deltalux/error.hpp>

namespace deltalux::io {

PlainText::PlainText(std::string_view text, const std::string& file) : view_(text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw InputError(file, 0, "is text in UTF-16", "save it as UTF-8");
  if (view_.starts_with("\xef\xbb\xbf")) view_.remove_prefix(3);
  if (view_.find('\r') == std::string_view::npos) return;
  copy_.reserve(view_.size());
  for (std::size_t i = 0; i < view_.size(); ++i) {
    if (view_[i] != '\r') {
      copy_ += view_[i];
    } else if (i + 1 == view_.size() || view_[i + 1] != '\n') {
      copy_ += '\n';
    }
  }
  view_ = copy_;
}

}  // namespace deltalux::io
