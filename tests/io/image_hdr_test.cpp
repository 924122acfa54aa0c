#define STBI_ONLY_HDR
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/image_io.hpp>

#include "io/image/formats.hpp"
#include "support/temp_folder.hpp"
#include "support/test_image.hpp"

namespace deltalux {
using namespace io;

namespace {

/// RGBE keeps each channel to one step of 1/256 of the brightest channel's power of two.
void expectWithinOneStep(const Image& actual, const Image& expected, double steps) {
  ASSERT_EQ(actual.width, expected.width);
  ASSERT_EQ(actual.height, expected.height);
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const Rgb& e = expected.pixels[i];
    const double step = isBlack(e) ? 0.0 : std::exp2(std::floor(std::log2(maxChannel(e))) + 1.0) / 256.0;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(actual.pixels[i][c], e[c], steps * step * (1 + 1e-5)) << "pixel " << i;
  }
}

std::string header(const std::string& variables, const std::string& resolution) {
  return "#?RADIANCE\n" + variables + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n";
}

TEST(Hdr, RoundTripKeepsPixelsViewAndExposure) {
  const test::TempFolder folder;
  for (const int width : {1, 7, 8, 300}) {  // below 8 flat, from 8 on run lengths
    Image image = test::mixedImage(width, 5);
    image.view = "-vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 45 -vv 40";
    image.exposure = 0.25;
    saveImage(folder / "a.hdr", image);
    const Image read = loadImage(folder / "a.hdr");
    expectWithinOneStep(read, image, 0.5);
    EXPECT_EQ(read.view, image.view);
    EXPECT_DOUBLE_EQ(read.exposure, 0.25);
  }
}

TEST(Hdr, AnotherDecoderReadsTheSamePicture) {
  const Image image = test::mixedImage(300, 9);
  const std::string bytes = encodeHdr(image);
  int width = 0, height = 0, channels = 0;
  float* data = stbi_loadf_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                                       &width, &height, &channels, 3);
  ASSERT_NE(data, nullptr) << stbi_failure_reason();
  Image other;
  other.width = width;
  other.height = height;
  for (int i = 0; i < width * height; ++i) other.pixels.push_back({data[3 * i], data[3 * i + 1], data[3 * i + 2]});
  stbi_image_free(data);
  expectWithinOneStep(other, image, 1.0);  // it does not add the half step
}

TEST(Hdr, MeanErrorIsZero) {
  Image image;
  image.width = 400;
  image.height = 100;
  Rng rng(3);
  for (int i = 0; i < 40000; ++i) image.pixels.push_back(Rgb(static_cast<float>(0.5 + 0.5 * rng.uniform())));
  const Image read = decodeHdr(encodeHdr(image), "memory");
  double error = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) error += read.pixels[i].g - image.pixels[i].g;
  EXPECT_NEAR(error / 40000.0, 0.0, 4.0 * (1.0 / 256.0 / std::sqrt(12.0)) / 200.0);
}

TEST(Hdr, ExposuresAndColourCorrectionsAreCumulativeAndDividedOut) {
  const std::string pixel{static_cast<char>(128), static_cast<char>(64), 32, static_cast<char>(129)};
  const Image image = decodeHdr(
      header("EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR= 1 0.5 2\nVIEW= -vtv\nVIEW= -vh 30\n", "-Y 1 +X 1") + pixel,
      "a.hdr");
  EXPECT_DOUBLE_EQ(image.exposure, 8.0);
  EXPECT_EQ(image.view, "-vtv -vh 30");
  EXPECT_FLOAT_EQ(image.pixels[0].r, 128.5f / 128 / 8);
  EXPECT_FLOAT_EQ(image.pixels[0].g, 64.5f / 128 / 4);
  EXPECT_FLOAT_EQ(image.pixels[0].b, 32.5f / 128 / 16);
}

TEST(Hdr, AllOrientationsGiveTheSamePicture) {
  // 2 wide, 1 high: left bright, right dark, told in eight ways.
  const std::string bright{100, 0, 0, static_cast<char>(128)}, dark{10, 0, 0, static_cast<char>(128)};
  for (const char* resolution : {"-Y 1 +X 2", "+Y 1 +X 2", "+X 2 -Y 1", "+X 2 +Y 1"}) {
    const Image image = decodeHdr(header("", resolution) + bright + dark, "a.hdr");
    ASSERT_EQ(image.width, 2) << resolution;
    EXPECT_GT(image.at(0, 0).r, image.at(1, 0).r) << resolution;
  }
  for (const char* resolution : {"-Y 1 -X 2", "+Y 1 -X 2", "-X 2 -Y 1", "-X 2 +Y 1"}) {
    const Image image = decodeHdr(header("", resolution) + dark + bright, "a.hdr");
    ASSERT_EQ(image.width, 2) << resolution;
    EXPECT_GT(image.at(0, 0).r, image.at(1, 0).r) << resolution;
  }
  const Image upwards = decodeHdr(header("", "+Y 2 +X 1") + dark + bright, "a.hdr");
  EXPECT_GT(upwards.at(0, 0).r, upwards.at(0, 1).r);
}

TEST(Hdr, ReadsOldRunLengths) {
  const std::string pixel{100, 50, 25, static_cast<char>(128)};
  const std::string runs{1, 1, 1, 43, 1, 1, 1, 1};  // 43 + 1 * 256 repetitions
  const Image image = decodeHdr(header("", "-Y 1 +X 300") + pixel + runs, "a.hdr");
  EXPECT_EQ(image.at(299, 0), image.at(0, 0));
  EXPECT_FLOAT_EQ(image.at(0, 0).r, 100.5f / 256);
}

TEST(Hdr, DamagedPicturesAreInputErrors) {
  const std::string good = encodeHdr(test::mixedImage(64, 8));
  for (std::size_t length = 0; length < good.size(); length += 7)
    EXPECT_THROW(decodeHdr(std::string_view(good).substr(0, length), "a.hdr"), InputError) << length;
  const std::string pixels(64, '\2');
  for (const char* resolution :
       {"", "-Y 0 +X 1", "-Y 1 +X -1", "-Y 1 -Y 1", "-Y 60000 +X 60000", "Y 1 X 1", "-Y 1 +X 1 +X 1"})
    EXPECT_THROW(decodeHdr(header("", resolution) + pixels, "a.hdr"), InputError) << resolution;
  EXPECT_THROW(decodeHdr("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n0000", "a.hdr"), InputError);
  EXPECT_THROW(decodeHdr(header("EXPOSURE=0\n", "-Y 1 +X 1") + "0000", "a.hdr"), InputError);
  EXPECT_THROW(loadImage("no such folder/a.hdr"), InputError);
}

TEST(Hdr, ExtremesStayInRange) {
  Image image;
  image.width = 3;
  image.height = 1;
  image.pixels = {Rgb(1e38f), Rgb(-1.0f, 0.0f, 1.0f), Rgb(1e-38f)};
  const Image read = decodeHdr(encodeHdr(image), "memory");
  EXPECT_NEAR(read.pixels[0].r, 1e38f, 0.01e38f);
  EXPECT_NEAR(read.pixels[1].r, 0.0f, 1.0f / 256);
  EXPECT_EQ(read.pixels[2], Rgb(0.0f));
}

}  // namespace
}  // namespace deltalux
