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

}  // namespace

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
