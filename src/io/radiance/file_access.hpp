#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltalux::io::radiance {

struct SourceFile {
  std::string name;              // for messages
  std::filesystem::path folder;  // where the files that it names are looked for
  std::string identity;          // equal for the same file, however it was named
  std::string text;
};

/// The seam through which scenes reach files: tests and fuzzers have no disk behind it.
class FileAccess {
 public:
  virtual ~FileAccess() = default;
  /// The file that `name` means in a file of `folder`; nullopt when there is none.
  virtual std::optional<SourceFile> open(const std::string& name, const std::filesystem::path& folder) = 0;
};

/// Files on disk: looked for where the program runs, as Radiance's commands do (they are written to be run from the
/// folder of a project), then in the including file's folder, then in the scene's.
class DiskAccess : public FileAccess {
 public:
  explicit DiskAccess(std::filesystem::path sceneFolder) : sceneFolder_(std::move(sceneFolder)) {}
  std::optional<SourceFile> open(const std::string& name, const std::filesystem::path& folder) override;

 private:
  std::filesystem::path sceneFolder_;
};

/// No files at all.
class NoAccess : public FileAccess {
 public:
  std::optional<SourceFile> open(const std::string&, const std::filesystem::path&) override { return std::nullopt; }
};

}  // namespace deltalux::io::radiance
