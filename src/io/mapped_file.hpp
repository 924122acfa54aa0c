#pragma once
// The bytes of a large input file without a copy of them in memory.
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

class MappedFile {
 public:
  /// What cannot be mapped (pipes) is read. Throws InputError when the file is not there or cannot be read.
  explicit MappedFile(const std::filesystem::path&);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// As the file was when it was opened; whoever cuts it short meanwhile ends the program.
  std::string_view bytes() const { return mapping_ ? std::string_view(mapping_, size_) : std::string_view(copy_); }

 private:
  const char* mapping_ = nullptr;
  std::size_t size_ = 0;
  std::string copy_;
};

}  // namespace deltalux::io
