// Every input that the fuzzers started from or found: read into a valid scene, or refused with an InputError. The bytes
// mean what the targets in fuzz/ say.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <functional>

#include "../../fuzz/glb_input.hpp"
#include "../../fuzz/obj_input.hpp"
#include "io/gltf.hpp"
#include "io/import_file.hpp"
#include "io/obj.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

void replay(const char* folder, const std::function<ImportedScene(const std::string&)>& read) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "fuzz/corpus" / folder)) {
    ++count;
    SCOPED_TRACE(entry.path());
    try {
      const ImportedScene imported = read(readInputFile(entry.path()));
      EXPECT_NO_THROW(validate(imported.scene));
    } catch (const InputError& error) {
      EXPECT_FALSE(error.hint().empty());
    }
  }
  EXPECT_GE(count, 3u);
}

TEST(ImportCorpus, Gltf) {
  replay("gltf", [](const std::string& bytes) { return readGltf(bytes, "fuzz.gltf", "/nonexistent", {}); });
}

TEST(ImportCorpus, Glb) {
  replay("glb", [](const std::string& bytes) { return readGltf(fuzz::glbOf(bytes), "fuzz.glb", "/nonexistent", {}); });
}

TEST(ImportCorpus, Obj) {
  const test::TempFolder folder;
  replay("obj", [&](const std::string& bytes) {
    return readObj(fuzz::objOf(bytes, folder.path()), "fuzz.obj", folder.path(), {});
  });
}

}  // namespace
}  // namespace deltalux
