#include <gtest/gtest.h>

#include "export/byte_planes.hpp"

namespace deltalux {
namespace {

TEST(BytePlanes, HoldFoldedDifferences) {
  // 5, +2, -300: folded 10, 4, 599.
  const std::string planes = exporting::differencePlanes(std::vector<std::int32_t>{5, 7, -293});
  EXPECT_EQ(planes, std::string({10, 4, char(599 & 255), 0, 0, 599 >> 8, 0, 0, 0, 0, 0, 0}));
}

TEST(BytePlanes, TellWordsFromTheirColourBefore) {
  const auto word = [](unsigned e, unsigned r, unsigned g, unsigned b) { return e << 27 | b << 18 | g << 9 | r; };
  // The second has half of the first's light in the same colour, but for one more step of red; the third is black.
  const std::string planes = exporting::rgb9e5Planes(
      std::vector<std::uint32_t>{word(16, 400, 300, 5), word(15, 401, 300, 5), word(0, 0, 0, 0)});
  const auto byte = [&](std::size_t plane, std::size_t i) {
    return int(static_cast<unsigned char>(planes[3 * plane + i]));
  };
  EXPECT_EQ(byte(0, 0), 16);
  EXPECT_EQ(byte(1, 0), 800 & 255);
  EXPECT_EQ(byte(2, 0), 600 & 255);
  EXPECT_EQ(byte(3, 0), 10);
  EXPECT_EQ(byte(4, 0), 3 | 2 << 2);
  EXPECT_EQ(byte(0, 1), 255);
  EXPECT_EQ(byte(2, 1), 511 - 300 < 0 ? 0 : (2 * (511 - 300) - 1) & 255);  // twice the mantissa is more than there is
  EXPECT_EQ(byte(1, 1), 2);
  EXPECT_EQ(byte(0, 2), 256 - 15);
  EXPECT_EQ(byte(1, 2), 0);
}

}  // namespace
}  // namespace deltalux
