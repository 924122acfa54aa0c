#pragma once
// Before long work: is there a place for its result?
#include <filesystem>

namespace deltalux {

/// Throws OutputError when `target` cannot be written: no such folder, folder not writable, or it is a folder itself.
/// Touches nothing.
void checkWritable(const std::filesystem::path& target);

}  // namespace deltalux
