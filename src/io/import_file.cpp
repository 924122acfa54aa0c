#include "io/import_file.hpp"

#include <algorithm>
#include <charconv>
#include <deltalux/error.hpp>
#include <fstream>

namespace deltalux::io {

namespace fs = std::filesystem;

namespace {

std::string percentDecoded(std::string_view uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char value = 0;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(&uri[i + 1], &uri[i + 1] + 2, value, 16).ptr == &uri[i + 1] + 2) {
      decoded += static_cast<char>(value);
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  return decoded;
}

bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

bool isInside(const fs::path& path, const fs::path& folder) {
  const auto [inFolder, inPath] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return inFolder == folder.end() && inPath != path.end();
}

}  // namespace

std::string readInputFile(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(file.string(), 0, "no such file", "check the name");
  if (fs::is_directory(status)) throw InputError(file.string(), 0, "is a folder", "give the file itself");
  std::ifstream stream(file, std::ios::binary);
  std::string content;
  if (const auto size = fs::file_size(file, error); !error) content.reserve(size + 1);
  char chunk[1 << 16];
  while (stream.read(chunk, sizeof chunk) || stream.gcount() > 0)
    content.append(chunk, static_cast<std::size_t>(stream.gcount()));
  if (!stream.eof()) throw InputError(file.string(), 0, "cannot be read", "check the permissions");
  return content;
}

fs::path resolveReference(std::string_view reference, const fs::path& folder, const std::string& referrer, int line,
                          bool isUri) {
  const std::string name = isUri ? percentDecoded(reference) : std::string(reference);
  const std::string shown = "'" + std::string(reference.substr(0, 100)) + "'";
  const auto refuse = [&](const std::string& what) {
    return InputError(referrer, line, "refers to " + shown + ", " + what, "put the file into the folder of the scene");
  };
  if (name.empty()) throw InputError(referrer, line, "refers to a file without naming it", "export it again");
  if (name.find('\0') != std::string::npos) throw refuse("which is not a file name");
  if (isUri && hasScheme(reference)) throw refuse("which is not a file beside it");
  const fs::path relative(name);
  if (relative.is_absolute()) throw refuse("which is an absolute path");
  std::error_code error;
  const fs::path base = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder), error);
  const fs::path path = error ? fs::path() : fs::weakly_canonical(base / relative, error);
  if (error) throw refuse("which is not a usable file name");
  if (!isInside(path, base)) throw refuse("which lies outside its folder");
  return path;
}

}  // namespace deltalux::io
