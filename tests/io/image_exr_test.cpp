#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/image_io.hpp>

#include "io/image/formats.hpp"
#include "support/temp_folder.hpp"
#include "support/test_image.hpp"

namespace deltalux {
using namespace io;

namespace {

TEST(Exr, RoundTripIsExact) {
  const test::TempFolder folder;
  Image image = test::mixedImage(33, 17);
  image.view = "-vtv -vp 1 2 3";
  saveImage(folder / "a.exr", image);
  const Image read = loadImage(folder / "a.exr");
  ASSERT_EQ(read.width, 33);
  ASSERT_EQ(read.height, 17);
  EXPECT_EQ(read.pixels, image.pixels);
  EXPECT_EQ(read.view, image.view);
}

TEST(Exr, SaysWhatItsNumbersMean) {
  const test::TempFolder folder;
  saveImage(folder / "a.exr", test::mixedImage(4, 4));
  const Imf::InputFile file((folder / "a.exr").c_str());
  EXPECT_FLOAT_EQ(Imf::whiteLuminance(file.header()), 179.0f);
  EXPECT_FLOAT_EQ(Imf::chromaticities(file.header()).green.x, 0.290f);
  EXPECT_FLOAT_EQ(Imf::chromaticities(file.header()).white.x, 1.0f / 3.0f);
}

TEST(Exr, DamagedPicturesAreInputErrors) {
  const std::string good = encodeExr(test::mixedImage(64, 64));
  for (const std::size_t length : {std::size_t{0}, std::size_t{3}, std::size_t{50}, std::size_t{200}})
    EXPECT_THROW(decodeExr(std::string_view(good).substr(0, length), "a.exr"), InputError) << length;
  EXPECT_THROW(decodeExr("this is text, not a picture, and long enough to be read", "a.exr"), InputError);
}

}  // namespace
}  // namespace deltalux
