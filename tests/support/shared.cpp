#include "support/shared.hpp"

#include <cstdlib>
#include <string>

namespace deltalux::test {

std::optional<std::filesystem::path> sharedFolder() {
  const char* fromEnvironment = std::getenv("DELTALUX_SHARED");
  const std::string folder = fromEnvironment ? fromEnvironment : DELTALUX_SHARED_DEFAULT;
  if (folder.empty() || !std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

std::filesystem::path sourceFolder() { return DELTALUX_SOURCE_DIR; }

}  // namespace deltalux::test
