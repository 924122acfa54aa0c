#include <gtest/gtest.h>

#include "base/random.hpp"
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

/// As web/src/payload.js reads them.
std::vector<std::array<int, 4>> readBack(const std::string& planes) {
  const std::size_t n = planes.size() / 5;
  const auto byte = [&](std::size_t plane, std::size_t i) {
    return int(static_cast<unsigned char>(planes[plane * n + i]));
  };
  const auto unfold = [](int z) { return z & 1 ? -(z + 1) / 2 : z / 2; };
  std::vector<std::array<int, 4>> out;
  std::array<int, 4> w{0, 0, 0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    const auto [e0, r0, g0, b0] = w;
    const int e = (e0 + byte(0, i)) & 255, high = byte(4, i);
    const int g =
        int(std::min(std::floor(g0 * std::exp2(e0 - e) + 0.5), 511.0)) + unfold(byte(2, i) | (high >> 2 & 3) << 8);
    const auto other = [&](int c0) {
      return g0 > 0 ? int(std::min(std::floor(double(c0) * g / g0 + 0.5), 511.0)) : c0;
    };
    w = {e, other(r0) + unfold(byte(1, i) | (high & 3) << 8), g, other(b0) + unfold(byte(3, i) | (high >> 4) << 8)};
    out.push_back(w);
  }
  return out;
}

TEST(BytePlanes, WordsComeBackWithinTheirSlack) {
  Rng random(3, 4);
  std::vector<std::uint32_t> words;
  std::vector<std::uint8_t> slack;
  const auto below = [&](int n) { return static_cast<std::uint32_t>(random.uniform() * n); };
  for (int i = 0; i < 5000; ++i) {
    words.push_back((10 + below(6)) << 27 | below(512) << 18 | below(512) << 9 | below(512));
    slack.push_back(static_cast<std::uint8_t>(below(5)));
  }
  const auto exact = readBack(exporting::rgb9e5Planes(words)), near = readBack(exporting::rgb9e5Planes(words, slack));
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_EQ(exact[i][0], int(words[i] >> 27));
    EXPECT_EQ(near[i][0], int(words[i] >> 27));
    for (std::size_t c = 0; c < 3; ++c) {
      const int value = int(words[i] >> (9 * c) & 511);
      EXPECT_EQ(exact[i][c + 1], value);
      EXPECT_LE(std::abs(near[i][c + 1] - value), int(slack[i]));
      EXPECT_GE(near[i][c + 1], 0);
      EXPECT_LE(near[i][c + 1], 511);
    }
  }
}

}  // namespace
}  // namespace deltalux
