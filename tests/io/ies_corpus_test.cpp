// Every input that once was a fuzzer's case: read, or refused with an InputError.
#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>

#include "io/ies.hpp"
#include "io/import_file.hpp"
#include "support/shared.hpp"

namespace deltalux {
using namespace io;

namespace {

TEST(IesCorpus, IsReadOrRefused) {
  for (const char* format : {"ies", "ldt", "tm33"}) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "fuzz/corpus" / format)) {
      ++count;
      const std::string name = entry.path().string() + "." + format;
      try {
        const PhotometryFile file = readPhotometry(readInputFile(entry.path()), name, "/nonexistent");
        const double flux = luminousFlux(file.photometry);
        EXPECT_TRUE(flux >= 0 && std::isfinite(flux)) << entry.path();
      } catch (const InputError& error) {
        EXPECT_FALSE(error.hint().empty()) << entry.path();
      }
    }
    EXPECT_GE(count, 5u) << format;
  }
}

}  // namespace
}  // namespace deltalux
