#pragma once
// Output that appears complete or not at all: written to a temporary file in the same folder, synced, renamed. Whoever
// writes to a folder removes from it what others were killed at. A temporary file is locked while its writer lives.
#include <filesystem>
#include <string_view>

namespace deltalux::io {

class AtomicFile {
 public:
  /// Opens the temporary file. Devices and pipes are written directly: there is nothing to keep. Throws OutputError.
  explicit AtomicFile(const std::filesystem::path& target);
  /// Removes the temporary file unless committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. Throws OutputError.
  void write(std::string_view bytes);
  /// Puts the file in its place; what stood there before is replaced now and not earlier. Throws OutputError.
  void commit();

 private:
  [[noreturn]] void fail(const char* doing) const;
  void discard();

  std::filesystem::path target_;     // as the user named it
  std::filesystem::path place_;      // symbolic links followed
  std::filesystem::path temporary_;  // empty for devices
  int descriptor_ = -1;
};

/// AtomicFile in one call.
void writeFile(const std::filesystem::path& target, std::string_view bytes);

}  // namespace deltalux::io
