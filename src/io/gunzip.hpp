#pragma once
// Files that may be packed by gzip, as meshes and parts of scenes are.
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Whether bytes begin as gzip's do.
bool isGzip(std::string_view bytes);

/// What is packed there. Throws InputError in the name of `file` when it is damaged or too large.
std::string gunzip(std::string_view bytes, const std::string& file);

/// The content of a file, unpacked where it is packed. Throws InputError.
std::string readUnpacked(const std::filesystem::path& file);

}  // namespace deltalux::io
