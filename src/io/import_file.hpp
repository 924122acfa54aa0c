#pragma once
// Getting at the bytes of input files, and at the files that they refer to.
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

/// The whole content of `file`. Throws InputError when it is not there, not a file, or cannot be read.
std::string readInputFile(const std::filesystem::path& file);

/// The file that `reference` (a relative path, or a percent-encoded URI when `isUri`) means inside `folder`. Throws
/// InputError in the name of `referrer` when it names something outside that folder (absolute paths, URL schemes, `..`,
/// links that lead out): an imported scene reads nothing that does not lie beside it.
std::filesystem::path resolveReference(std::string_view reference, const std::filesystem::path& folder,
                                       const std::string& referrer, int line, bool isUri);

}  // namespace deltalux::io
