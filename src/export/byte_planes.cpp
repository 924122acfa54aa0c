#include "export/byte_planes.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::exporting {

namespace {

std::uint32_t folded(std::int32_t d) { return static_cast<std::uint32_t>(d) << 1 ^ (d < 0 ? 0xffffffffu : 0u); }

struct Word {
  int exponent = 0, red = 0, green = 0, blue = 0;
};
Word split(std::uint32_t w) {
  return {static_cast<int>(w >> 27), static_cast<int>(w & 511), static_cast<int>(w >> 9 & 511),
          static_cast<int>(w >> 18 & 511)};
}

constexpr int kMost = 511;  // of a mantissa [layout]

int rounded(double v) { return static_cast<int>(std::min(std::floor(v + 0.5), double(kMost))); }

int greenFrom(const Word& before, int exponent) {
  return rounded(std::ldexp(before.green, before.exponent - exponent));
}
int otherFrom(int other, const Word& before, int green) {
  return before.green > 0 ? rounded(static_cast<double>(other) * green / before.green) : other;
}

}  // namespace

std::string differencePlanes(std::span<const std::int32_t> numbers) {
  const std::size_t count = numbers.size();
  std::string out(4 * count, '\0');
  std::int32_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t d = numbers[i] - before;
    before = numbers[i];
    for (std::size_t b = 0; b < 4; ++b) out[b * count + i] = static_cast<char>(folded(d) >> (8 * b) & 0xff);
  }
  return out;
}

std::string rgb9e5Planes(std::span<const std::uint32_t> words, std::span<const std::uint8_t> slack) {
  const std::size_t count = words.size();
  std::string out(5 * count, '\0');
  Word before;
  for (std::size_t i = 0; i < count; ++i) {
    const Word w = split(words[i]);
    const int step = 2 * (slack.empty() ? 0 : slack[i]) + 1;
    Word now{w.exponent, 0, 0, 0};
    std::uint32_t off[3];
    // What is read back is what the next word is told from: errors do not add up.
    const auto tell = [&](int value, int expected, std::size_t channel) {
      int d = (std::abs(value - expected) + step / 2) / step * step * (value < expected ? -1 : 1);
      if (expected + d < 0 || expected + d > kMost) d = value - expected;
      off[channel] = folded(d);
      return expected + d;
    };
    now.green = tell(w.green, greenFrom(before, w.exponent), 1);
    now.red = tell(w.red, otherFrom(before.red, before, now.green), 0);
    now.blue = tell(w.blue, otherFrom(before.blue, before, now.green), 2);
    out[i] = static_cast<char>((w.exponent - before.exponent) & 0xff);
    for (std::size_t k = 0; k < 3; ++k) out[(k + 1) * count + i] = static_cast<char>(off[k] & 0xff);
    out[4 * count + i] = static_cast<char>(off[0] >> 8 | off[1] >> 8 << 2 | off[2] >> 8 << 4);
    before = now;
  }
  return out;
}

}  // namespace deltalux::exporting
