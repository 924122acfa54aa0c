#pragma once
// Development scenes and reference values that are not part of the repository.
#include <filesystem>
#include <optional>

namespace deltalux::test {

/// The folder named by the environment's DELTALUX_SHARED, else by the build's; nullopt when neither exists.
std::optional<std::filesystem::path> sharedFolder();

/// A folder of the source tree.
std::filesystem::path sourceFolder();

}  // namespace deltalux::test

/// Skips the test with a message unless the shared folder is there; binds its path to `name`.
#define DELTALUX_SHARED_OR_SKIP(name)                                                             \
  const auto name##Folder = ::deltalux::test::sharedFolder();                                     \
  if (!name##Folder) GTEST_SKIP() << "set DELTALUX_SHARED to the folder with scenes/ and reference/"; \
  const std::filesystem::path& name = *name##Folder
