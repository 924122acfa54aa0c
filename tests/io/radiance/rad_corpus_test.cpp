// Every input that the fuzzer starts from or has found wanting, and what is left of each when it is cut short.
#include <gtest/gtest.h>

#include <filesystem>

#include "../fuzz/rad_input.hpp"
#include "io/import_file.hpp"
#include "support/shared.hpp"

namespace deltalux::io::radiance {
namespace {

TEST(RadCorpus, ReadsCleanlyWholeAndCutShort) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(deltalux::test::sourceFolder() / "fuzz/corpus/rad")) {
    const std::string text = readInputFile(entry.path());
    EXPECT_TRUE(readsCleanly(text)) << entry.path();
    for (std::size_t size = 0; size < text.size(); size += 7) {
      EXPECT_TRUE(readsCleanly(std::string_view(text).substr(0, size))) << entry.path() << " cut to " << size;
    }
    ++count;
  }
  EXPECT_GE(count, 6u);
}

TEST(RadCorpus, SeedsAreScenes) {
  for (const char* seed : {"surfaces", "materials", "sky", "arrays", "boxes", "curves", "patterns"}) {
    const auto file = deltalux::test::sourceFolder() / "fuzz/corpus/rad" / (std::string(seed) + ".rad");
    TextFiles files(readInputFile(file));
    EXPECT_NO_THROW(readRadiance(files.scene(), files, {})) << seed;
  }
}

}  // namespace
}  // namespace deltalux::io::radiance
