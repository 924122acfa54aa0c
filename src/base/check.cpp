#include "base/check.hpp"

#include <stdexcept>

namespace deltalux {

void failCheck(const char* expression, const char* file, int line, const std::string& message) {
  const std::string path(file);
  const std::size_t slash = path.find_last_of('/');
  throw std::logic_error(path.substr(slash == std::string::npos ? 0 : slash + 1) + ":" + std::to_string(line) +
                         ": check failed: " + expression + (message.empty() ? "" : ": " + message));
}

}  // namespace deltalux
