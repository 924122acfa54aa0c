#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <deltalux/error.hpp>
#include <deltalux/output.hpp>
#include <optional>
#include <string>

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

namespace {

std::string temporaryName(const fs::path& place, int attempt) {
  return fmt::format(".{}.{}-{}.tmp", place.filename().string().substr(0, 200), ::getpid(), attempt);
}

/// Who writes, or wrote, a temporary file of such a name; nothing when the name is none of ours.
std::optional<pid_t> writerOf(std::string_view name) {
  constexpr std::string_view kEnd = ".tmp";
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return std::nullopt;
  name.remove_suffix(kEnd.size());
  const std::size_t dot = name.rfind('.'), dash = name.rfind('-');
  if (dot < 2 || dash == name.npos || dash <= dot) return std::nullopt;
  const std::string_view process = name.substr(dot + 1, dash - dot - 1), attempt = name.substr(dash + 1);
  const auto isNumber = [](std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
  };
  pid_t writer = 0;
  if (!isNumber(process) || !isNumber(attempt) || attempt.size() > 2) return std::nullopt;
  if (std::from_chars(process.data(), process.data() + process.size(), writer).ec != std::errc() || writer <= 0)
    return std::nullopt;
  return writer;
}

/// Whether another process of this number lives. What an earlier process of our own number left is not alive.
bool livesElsewhere(pid_t process) { return process != ::getpid() && (::kill(process, 0) == 0 || errno != ESRCH); }

/// Removes a file unless someone holds it locked: a writer on another machine, or in another container.
void removeUnlocked(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat opened {
  }, named{};
  if (::fstat(descriptor, &opened) == 0 && S_ISREG(opened.st_mode) && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 &&
      ::lstat(file.c_str(), &named) == 0 && named.st_dev == opened.st_dev && named.st_ino == opened.st_ino)
    ::unlink(file.c_str());
  ::close(descriptor);
}

/// Removes the temporary files in `folder` whose writers are no more. What cannot be looked at stays.
void removeAbandoned(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::optional<pid_t> writer = writerOf(entry->path().filename().string());
    if (writer && !livesElsewhere(*writer)) removeUnlocked(entry->path());
  }
}

/// Locks the file that was just made; false when someone took it for abandoned meanwhile. Where files cannot be locked
/// there is nothing to do: nobody will find it unlocked then, either.
bool lockNew(int descriptor) {
  ::flock(descriptor, LOCK_EX);
  struct stat status {};
  return ::fstat(descriptor, &status) != 0 || status.st_nlink > 0;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target), place_(resolved(target)) {
  checkWritable(target);
  if (isDevice(place_)) {
    descriptor_ = ::open(place_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    removeAbandoned(folderOf(place_));
    for (int attempt = 0; descriptor_ < 0 && attempt < 100; ++attempt) {
      temporary_ = folderOf(place_) / temporaryName(place_, attempt);
      descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) break;
      if (descriptor_ >= 0 && !lockNew(descriptor_)) ::close(descriptor_), descriptor_ = -1;
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
  // Locked until it has its name, so that nobody takes it for abandoned.
  if (!device && ::rename(temporary_.c_str(), place_.c_str()) != 0) fail("renaming");
  temporary_.clear();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0 && device) fail("closing");  // what is synced is safe
  if (device) return;
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
