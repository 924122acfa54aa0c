#include "io/json_text.hpp"

#include <algorithm>
#include <deltalux/error.hpp>

#include "io/number.hpp"
#include "io/plain_text.hpp"

namespace deltalux::io {

using nlohmann::json;

namespace {

// Where the text outside of its strings is, in order.
template <class Visit>
void forEachOutsideStrings(std::string_view text, Visit visit) {
  bool inString = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (inString && text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      inString = !inString;
    } else if (!inString) {
      visit(i);
    }
  }
}

int lineAt(std::string_view text, std::size_t position) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(position, text.size()));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

void checkDepth(std::string_view text, const std::string& name, const char* hint) {
  constexpr int kMaxDepth = 100;  // [limit]
  int depth = 0;
  forEachOutsideStrings(text, [&](std::size_t i) {
    if (text[i] == '}' || text[i] == ']') --depth;
    if ((text[i] == '{' || text[i] == '[') && ++depth > kMaxDepth)
      throw InputError(name, lineAt(text, i), "is JSON nested more than 100 deep", hint);
  });
}

InputError tooLarge(std::string_view text, const std::string& name, const char* hint) {
  constexpr std::string_view kNumber = "+-.0123456789eE";
  std::size_t behind = 0, at = text.size();
  forEachOutsideStrings(text, [&](std::size_t i) {
    if (i < behind || at < text.size() || kNumber.substr(1, 12).find(text[i]) == std::string_view::npos) return;
    behind = std::min(text.find_first_not_of(kNumber, i), text.size());
    if (!parseDecimal(text.substr(i, behind - i))) at = i;
  });
  const std::string_view word = text.substr(at, text.find_first_not_of(kNumber, at) - at);
  return InputError(name, at < text.size() ? lineAt(text, at) : 0, notANumber(word), hint);
}

/// Walks over text that is JSON.
class Walker {
 public:
  explicit Walker(std::string_view text) : text_(text) {}

  std::size_t at() const { return at_; }
  char peek() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) { return peek() == c && ++at_; }
  /// What stands between quotes.
  std::string_view string() {
    take('"');
    const std::size_t from = at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    const std::size_t end = std::min(at_, text_.size());
    at_ = end + 1;
    return text_.substr(from, end - from);
  }
  void skipValue() {
    const char first = peek();
    if (first == '"') return (void)string();
    if (first != '{' && first != '[') {
      at_ = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
      return;
    }
    int depth = 0;
    do {
      const char c = peek();
      if (c == '"') {
        string();
        continue;
      }
      depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
      ++at_;
    } while (depth > 0 && at_ < text_.size());
  }
  /// Goes to the member or element of that name of the value here; false where there is none.
  bool enter(std::string_view name) {
    const bool object = take('{');
    if (!object && !take('[')) return false;
    for (std::size_t i = 0; at_ < text_.size() && peek() != '}' && peek() != ']'; ++i) {
      const std::size_t begin = at_;
      const bool found = object ? string() == name : std::to_string(i) == name;
      if (object) take(':');
      if (found && object) return member_ = begin, true;
      if (found) return peek(), member_ = at_, true;
      skipValue();
      take(',');
    }
    return false;
  }
  /// Where the member that was entered last begins, its key included.
  std::size_t member() const { return member_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0, member_ = 0;
};

}  // namespace

int lineOf(std::string_view text, std::string_view pointer) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Walker walker(text);
  walker.peek();
  std::size_t found = walker.at();
  while (pointer.starts_with('/')) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    if (!walker.enter(pointer.substr(0, end))) break;
    found = walker.member();
    pointer.remove_prefix(end);
  }
  return lineAt(text, found);
}

json parseJson(std::string_view text, const std::string& name, const char* hint) {
  const PlainText plain(text, name);
  text = plain.view();
  checkDepth(text, name, hint);
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::parse_error& error) {
    const std::string what = error.what();
    throw InputError(name, lineAt(text, error.byte), "is not JSON: " + what.substr(what.find("] ") + 2, 200), hint);
  } catch (const json::exception&) {
    throw tooLarge(text, name, hint);
  }
}

}  // namespace deltalux::io
