// The same text with the line ends of any system, and with a byte order mark, is the same to every reader, and its
// mistakes stand in the same lines.
#include <gtest/gtest.h>

#include <deltalux/edit_io.hpp>
#include <deltalux/error.hpp>
#include <deltalux/points.hpp>
#include <functional>

#include "io/gltf.hpp"
#include "io/ies.hpp"
#include "io/obj.hpp"
#include "io/plain_text.hpp"
#include "io/radiance.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

using test::TempFolder;

std::string withEnds(const std::string& text, const std::string& end) {
  std::string result;
  for (const char c : text) result += c == '\n' ? end : std::string(1, c);
  return result;
}

const std::string kMark = "\xef\xbb\xbf";

std::vector<std::string> formsOf(const std::string& text) {
  return {text, withEnds(text, "\r\n"), withEnds(text, "\r"), kMark + text, kMark + withEnds(text, "\r")};
}

/// Whether `read` makes the same of all forms of `good`, and finds the mistake in `bad` in line `line` in all of them.
template <class Read>
void expectSame(const std::string& good, const std::string& bad, int line, const Read& read) {
  const auto expected = read(good);
  for (const std::string& form : formsOf(good)) EXPECT_EQ(read(form), expected);
  for (const std::string& form : formsOf(bad)) {
    try {
      read(form);
      ADD_FAILURE() << "was read: " << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(error.line(), line) << error.what();
    }
  }
  try {
    read("\xff\xfe" + good);
    ADD_FAILURE() << "UTF-16 was read";
  } catch (const InputError& error) {
    EXPECT_FALSE(error.message().empty());
  }
}

TEST(PlainText, EndsOfLines) {
  EXPECT_EQ(PlainText("a\r\nb\rc\n\r\r\n", "f").view(), "a\nb\nc\n\n\n");
  EXPECT_EQ(PlainText(kMark + "a\r", "f").view(), "a\n");
  EXPECT_EQ(PlainText("", "f").view(), "");
  const std::string text = "as it is\n";
  EXPECT_EQ(PlainText(text, "f").view().data(), text.data());
  EXPECT_THROW(PlainText("\xfe\xff", "f"), InputError);
}

std::size_t primitivesOf(const ImportedScene& imported) {
  validate(imported.scene);
  return imported.scene.primitives.size() * 1000 + imported.scene.lights.size();
}

TEST(TextForms, Radiance) {
  const auto read = [](const std::string& text) {
    radiance::NoAccess none;
    return primitivesOf(readRadiance({"a.rad", {}, "a.rad", text}, none, {}));
  };
  const std::string good =
      "# made\nvoid plastic g\n0\n0\n5 .5 .5 .5 0 0\n# lamp\nvoid light l 0 0 3 1 1 1\n!genbox g box \\\n1 1 1\n"
      "l sphere s 0 0 4 0 0 3 .1\n";
  EXPECT_EQ(read(good), 7001u);
  expectSame(good, good + "l sphere t 0 0 4 0 0 3 1e400\n", 11, read);
  expectSame(good, good + "l sphere t 0 0 4 0 0 nan 1\n", 11, read);
}

TEST(TextForms, FilesThatGeneratorsRead) {
  const TempFolder folder;
  for (const std::string& form : formsOf("0 0\n1 0\n0 1\n")) {
    folder.write("outline", form);
    const auto scene = folder.write("a.rad", "void plastic g 0 0 5 .5 .5 .5 0 0\n!genprism g p outline -l 0 0 1\n");
    EXPECT_EQ(loadScene({scene}).scene.primitives.size(), 5u);
  }
}

TEST(TextForms, ObjAndMtl) {
  const TempFolder folder;
  const std::string mtl = "newmtl a\nKd 0 0 0\nKe 1 2 3\n";
  for (const std::string& form : formsOf(mtl)) {
    folder.write("m.mtl", form);
    const auto read = [&](const std::string& text) {
      const ImportedScene imported = readObj(text, "a.obj", folder.path(), {});
      EXPECT_EQ(imported.scene.materials.at(0).emission->radiance, Rgb(1, 2, 3));
      return primitivesOf(imported);
    };
    const std::string good = "mtllib m.mtl\no one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 \\\n3\n";
    EXPECT_EQ(read(good), 1001u);
    expectSame(good, good + "v 0 0 1e400\n", 9, read);
  }
  for (const std::string& form : formsOf(mtl + "Kd 1e400\n")) {
    const auto file = folder.write("m.mtl", form);
    try {
      readObj("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", "a.obj", folder.path(), {});
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), file.string());
      EXPECT_EQ(error.line(), 4);
    }
  }
}

TEST(TextForms, Ies) {
  const TempFolder folder;
  const auto read = [&](const std::string& text) {
    return luminousFlux(readPhotometry(text, "a.ies", folder.path()).photometry);
  };
  const std::string head = "IESNA:LM-63-2002\n[TEST]\nTILT=tilt.dat\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n";
  for (const std::string& form : formsOf("1\n2\n0 90\n0.5 0.25\n")) {
    folder.write("tilt.dat", form);
    EXPECT_NEAR(read(head + "100 100\n"), 0.5 * 400 * kPi, 1e-9);
  }
  expectSame(head + "100 100\n", head + "100 1e400\n", 8, read);
  expectSame(head + "100 100\n", head + "100 nan\n", 8, read);
}

TEST(TextForms, Points) {
  const auto read = [](const std::string& text) { return parsePoints(text, "p.csv").points.size(); };
  const std::string good = "# c\nx,y,z,nx,ny,nz\n1,2,3,0,0,1\n\n4,5,6,0,0,1\n";
  EXPECT_EQ(read(good), 2u);
  expectSame(good, good + "1,2,1e400,0,0,1\n", 6, read);
  expectSame(good, good + "1,2,1e30,0,0,1\n", 6, read);
}

TEST(TextForms, Edits) {
  const auto read = [](const std::string& text) { return parseEdits(text, "e.json", ".", {}).size(); };
  const std::string good = "{\"edits\": [\n  {\"op\": \"light\", \"light\": \"a\",\n   \"scale\": 0.5}\n]}\n";
  EXPECT_EQ(read(good), 1u);
  expectSame(good, "{\"edits\": [\n{\"op\": \"1e400\",\n\"scale\": 1e400}]}", 3, read);
  expectSame(good, "{\"edits\": [\n{\"op\": \"light\",\n\"scale\": }]}", 3, read);
}

TEST(TextForms, Gltf) {
  const auto read = [](const std::string& text) { return readGltf(text, "a.gltf", ".", {}).scene.objects.size(); };
  const std::string good = "{\"asset\": {\"version\": \"2.0\"},\n\"scenes\": [{\"nodes\": [0]}],\n\"nodes\": [{}]}\n";
  EXPECT_EQ(read(good), 1u);
  expectSame(good, "{\"asset\":\n{\"version\": \"2.0\"},\n\"x\": -1e400}", 3, read);
}

TEST(TextForms, Views) {
  const TempFolder folder;
  for (const std::string& form : formsOf("# views\nrvu -vp 1 1 1 -vd 1 0 0\nrvu -vp 4 5 6 -vd 0 1 0\n"))
    EXPECT_EQ(loadView(folder.write("v.vf", form)).position, Vec3(4, 5, 6));
  for (const std::string& form : formsOf("# views\nrvu -vp 1 1 1e400\n")) {
    try {
      loadView(folder.write("v.vf", form));
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.line(), 2);
    }
  }
}

}  // namespace
}  // namespace deltalux
