#include "io/atomic_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

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

TEST(AtomicFile, ReadOnlyFoldersAreRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const test::TempFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THROW(checkWritable(folder / "a.txt"), OutputError);
}

}  // namespace
}  // namespace deltalux
