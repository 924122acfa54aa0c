#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/output.hpp>

#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

using Names = std::vector<std::string>;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const test::TempFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("hello ");
    file.write("world");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    file.commit();
  }
  EXPECT_EQ(test::readText(folder / "a.txt"), "hello world");
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(AtomicFile, WhatStoodThereStandsUntilTheCommit) {
  const test::TempFolder folder;
  folder.write("a.txt", "old");
  {
    AtomicFile abandoned(folder / "a.txt");
    abandoned.write("new");
  }
  EXPECT_EQ(test::readText(folder / "a.txt"), "old");
  EXPECT_EQ(folder.names(), Names{"a.txt"});
  writeFile(folder / "a.txt", "new");
  EXPECT_EQ(test::readText(folder / "a.txt"), "new");
}

TEST(AtomicFile, FollowsSymbolicLinks) {
  const test::TempFolder folder;
  folder.write("real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  writeFile(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(test::readText(folder / "real.txt"), "new");
}

TEST(AtomicFile, DevicesAreWrittenAndNotReplaced) {
  writeFile("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_THROW(writeFile("/dev/full", "no room"), OutputError);
}

TEST(AtomicFile, SaysWhatIsWrongWithTheTarget) {
  const test::TempFolder folder;
  const auto messageFor = [](const std::filesystem::path& target) -> std::string {
    try {
      checkWritable(target);
    } catch (const OutputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(messageFor(folder / "none/a.txt").find("there is no folder"), std::string::npos);
  EXPECT_NE(messageFor(folder.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(messageFor("").find("names no file"), std::string::npos);
  EXPECT_EQ(messageFor(folder / "a.txt"), "");
  EXPECT_TRUE(folder.names().empty());
}

/// The number of a process that was, and is no more.
pid_t endedProcess() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(AtomicFile, WhatKilledWritersLeftIsRemovedByTheNextWrite) {
  const test::TempFolder folder;
  const pid_t killed = ::fork();
  if (killed == 0) {
    AtomicFile file(folder / "solution.dlx");
    file.write("half of it");
    ::kill(::getpid(), SIGKILL);
  }
  ::waitpid(killed, nullptr, 0);
  folder.write(fmt::format(".some.other.csv.{}-99.tmp", endedProcess()), "");
  folder.write(fmt::format(".own.{}-0.tmp", ::getpid()), "of an earlier process of our number");
  ASSERT_EQ(folder.names().size(), 3u);
  writeFile(folder / "a.txt", "new");
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(AtomicFile, WhatOthersWriteOrNameOtherwiseStays) {
  const test::TempFolder folder;
  const pid_t ended = endedProcess();
  Names names{"a.txt"};
  const auto keep = [&](const std::string& name) { names.push_back(name), folder.write(name, "theirs"); };
  keep(fmt::format(".of.a.living.process.{}-0.tmp", ::getppid()));
  keep(fmt::format("a.{}-0.tmp", ended));
  keep(fmt::format(".a.{}-0.txt", ended));
  keep(fmt::format(".a.{}-100.tmp", ended));
  keep(fmt::format(".a.{}-.tmp", ended));
  keep(fmt::format(".{}-0.tmp", ended));
  keep(fmt::format(".a.{}x-0.tmp", ended));
  keep(".a.-0.tmp");
  keep(".a.0-0.tmp");
  keep(".a.99999999999999999999-0.tmp");
  std::filesystem::create_symlink("a.txt", folder / fmt::format(".link.{}-0.tmp", ended));
  names.push_back(fmt::format(".link.{}-0.tmp", ended));
  std::filesystem::create_directory(folder / fmt::format(".folder.{}-0.tmp", ended));
  names.push_back(fmt::format(".folder.{}-0.tmp", ended));
  // Of a process that cannot be seen from here, but holds its file locked.
  keep(fmt::format(".elsewhere.{}-0.tmp", ended));
  const int held = ::open((folder / names.back()).c_str(), O_RDONLY);
  ASSERT_EQ(::flock(held, LOCK_EX | LOCK_NB), 0);
  writeFile(folder / "a.txt", "new");
  std::sort(names.begin(), names.end());
  EXPECT_EQ(folder.names(), names);
  ::close(held);
}

TEST(AtomicFile, WritersToOneFolderLeaveEachOtherAlone) {
  const test::TempFolder folder;
  AtomicFile one(folder / "one.txt"), same(folder / "one.txt");
  one.write("one"), same.write("the same");
  writeFile(folder / "two.txt", "two");
  one.commit();
  EXPECT_EQ(test::readText(folder / "one.txt"), "one");
  same.commit();
  EXPECT_EQ(test::readText(folder / "one.txt"), "the same");
  EXPECT_EQ(folder.names(), (Names{"one.txt", "two.txt"}));
}

TEST(AtomicFile, ReadOnlyFoldersAreRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const test::TempFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THROW(checkWritable(folder / "a.txt"), OutputError);
}

}  // namespace
}  // namespace deltalux
