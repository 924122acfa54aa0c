#define STBI_ONLY_PNG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <gtest/gtest.h>

#include <cstring>
#include <deltalux/error.hpp>
#include <deltalux/image_io.hpp>

#include "support/temp_folder.hpp"
#include "support/test_image.hpp"

namespace deltalux {
namespace {

TEST(Png, HoldsTheToneMappedPicture) {
  const test::TempFolder folder;
  const Image image = test::mixedImage(31, 6);
  saveImage(folder / "a.png", image, {ToneOperator::Linear, 1.5});
  const DisplayImage expected = toneMap(image, {ToneOperator::Linear, 1.5});
  int width = 0, height = 0, channels = 0;
  unsigned char* data = stbi_load((folder / "a.png").c_str(), &width, &height, &channels, 0);
  ASSERT_NE(data, nullptr) << stbi_failure_reason();
  ASSERT_EQ(width, 31);
  ASSERT_EQ(height, 6);
  ASSERT_EQ(channels, 3);
  EXPECT_EQ(std::memcmp(data, expected.pixels.data(), 3 * expected.pixels.size()), 0);
  stbi_image_free(data);
}

TEST(ImageFile, FormatFollowsFromTheName) {
  EXPECT_EQ(imageFormatOf("a.exr"), ImageFormat::Exr);
  EXPECT_EQ(imageFormatOf("a/b.HDR"), ImageFormat::Hdr);
  EXPECT_EQ(imageFormatOf("a.pic"), ImageFormat::Hdr);
  EXPECT_EQ(imageFormatOf("a.png"), ImageFormat::Png);
  EXPECT_EQ(imageFormatOf("a.jpg"), std::nullopt);
  EXPECT_EQ(imageFormatOf("exr"), std::nullopt);
}

TEST(ImageFile, UnknownFormatsAndMissingFoldersAreOutputErrorsAndLeaveNothing) {
  const test::TempFolder folder;
  const Image image = test::mixedImage(4, 4);
  EXPECT_THROW(saveImage(folder / "a.jpg", image), OutputError);
  EXPECT_THROW(saveImage(folder / "none/a.exr", image), OutputError);
  EXPECT_THROW(saveImage(folder / "a.exr", toneMap(image)), OutputError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(ViewOptions, AreRadiances) {
  View view;
  view.position = {1, 2.5, -3};
  view.horizontal = 60;
  view.vertical = 46.25;
  EXPECT_EQ(viewOptions(view), "-vtv -vp 1 2.5 -3 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 46.25");
  view.kind = View::Kind::Parallel;
  EXPECT_EQ(viewOptions(view).substr(0, 4), "-vtl");
}

}  // namespace
}  // namespace deltalux
