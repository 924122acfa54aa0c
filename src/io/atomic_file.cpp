#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <deltalux/error.hpp>
#include <deltalux/output.hpp>

namespace deltalux {

namespace fs = std::filesystem;

namespace {
[[noreturn]] void refuse(const fs::path& target, const std::string& why) {
  throw OutputError(fmt::format("cannot write {}: {}", target.string(), why));
}

fs::path folderOf(const fs::path& place) { return place.has_parent_path() ? place.parent_path() : fs::path("."); }

/// Where the file really goes: the end of a chain of symbolic links, as far as it exists.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  if (!fs::is_symlink(target, error)) return target;
  const fs::path place = fs::weakly_canonical(target, error);
  return error ? target : place;
}

bool isDevice(const fs::path& place) {
  std::error_code error;
  const fs::file_status status = fs::status(place, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}
}  // namespace

void checkWritable(const fs::path& target) {
  if (target.empty() || !target.has_filename()) refuse(target, "this names no file");
  const fs::path place = resolved(target);
  std::error_code error;
  if (fs::is_directory(place, error)) refuse(target, "it is a folder (give a file name)");
  if (isDevice(place)) return;
  const fs::path folder = folderOf(place);
  if (!fs::is_directory(folder, error))
    refuse(target, fmt::format("there is no folder {} (create it first)", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(target, fmt::format("the folder {} is not writable ({})", folder.string(), std::strerror(errno)));
}

}  // namespace deltalux

namespace deltalux::io {

AtomicFile::AtomicFile(const fs::path& target) : target_(target), place_(resolved(target)) {
  checkWritable(target);
  if (isDevice(place_)) {
    descriptor_ = ::open(place_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    for (int attempt = 0; descriptor_ < 0 && attempt < 100; ++attempt) {
      temporary_ = folderOf(place_) /
                   fmt::format(".{}.{}-{}.tmp", place_.filename().string().substr(0, 200), ::getpid(), attempt);
      descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) break;
    }
  }
  if (descriptor_ < 0) {
    temporary_.clear();
    fail("opening");
  }
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(const char* doing) const {
  refuse(target_, fmt::format("{} failed: {}", doing, std::strerror(errno)));
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("writing");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  const bool device = temporary_.empty();
  if (!device && ::fsync(descriptor_) != 0) fail("syncing");
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail("closing");
  if (device) return;
  if (::rename(temporary_.c_str(), place_.c_str()) != 0) fail("renaming");
  temporary_.clear();
  // The name itself reaches the disk with its folder; a failure here cannot be mended and loses nothing yet.
  const int folder = ::open(folderOf(place_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

void writeFile(const fs::path& target, std::string_view bytes) {
  AtomicFile file(target);
  file.write(bytes);
  file.commit();
}

}  // namespace deltalux::io
