#include <deltalux/error.hpp>
#include <utility>

namespace deltalux {

namespace {
std::string describe(const std::string& file, int line, const std::string& message, const std::string& hint) {
  std::string text = file;
  if (line > 0) text += ":" + std::to_string(line);
  text += text.empty() ? "" : ": ";
  text += message;
  if (!hint.empty()) text += " (" + hint + ")";
  return text;
}
}  // namespace

InputError::InputError(std::string file, int line, std::string message, std::string hint)
    : std::runtime_error(describe(file, line, message, hint)),
      file_(std::move(file)),
      line_(line),
      message_(std::move(message)),
      hint_(std::move(hint)) {}

}  // namespace deltalux
