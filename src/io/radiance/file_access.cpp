#include "io/radiance/file_access.hpp"

#include <system_error>

#include "io/import_file.hpp"

namespace deltalux::io::radiance {

namespace fs = std::filesystem;

std::optional<SourceFile> DiskAccess::open(const std::string& name, const fs::path& folder) {
  for (const fs::path& path : {fs::path(name), folder / name, sceneFolder_ / name}) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) continue;
    const fs::path canonical = fs::weakly_canonical(path, error);
    return SourceFile{path.string(), path.parent_path(), error ? path.string() : canonical.string(),
                      readInputFile(path)};
  }
  return std::nullopt;
}

}  // namespace deltalux::io::radiance
