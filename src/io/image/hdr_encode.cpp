// Radiance RGBE: three mantissas of 8 bits and a common exponent; scanlines of 8 to 32767 pixels are run-length coded
// per component, others are flat. Mantissas are cut, not rounded: readers add one half (as hdr_decode.cpp does), so the
// mean error is zero. [Radiance, color.c]
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "io/image/formats.hpp"

namespace deltalux::io {

namespace {
using RgbePixel = std::array<std::uint8_t, 4>;

RgbePixel toRgbe(const Rgb& color) {
  const glm::dvec3 c = glm::max(glm::dvec3(color), 0.0);
  const double brightest = std::max({c.r, c.g, c.b});
  if (!(brightest > 1e-32)) return {0, 0, 0, 0};
  if (!std::isfinite(brightest) || brightest >= 0x1p127) return {255, 255, 255, 255};
  int exponent = 0;
  const double scale = std::frexp(brightest, &exponent) * 256.0 / brightest;
  return {static_cast<std::uint8_t>(c.r * scale), static_cast<std::uint8_t>(c.g * scale),
          static_cast<std::uint8_t>(c.b * scale), static_cast<std::uint8_t>(exponent + 128)};
}

/// Length of the run of equal bytes that starts at `begin`, at most 127.
std::size_t runLength(const std::vector<std::uint8_t>& row, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < row.size() && end - begin < 127 && row[end] == row[begin]) ++end;
  return end - begin;
}

/// Runs of 4 or more become a pair (128 + length, value), everything between literals of up to 128 bytes.
void appendRuns(std::string& bytes, const std::vector<std::uint8_t>& row) {
  constexpr std::size_t kWorthwhile = 4;  // [layout]
  for (std::size_t i = 0; i < row.size();) {
    const std::size_t run = runLength(row, i);
    if (run >= kWorthwhile) {
      bytes.push_back(static_cast<char>(128 + run));
      bytes.push_back(static_cast<char>(row[i]));
      i += run;
      continue;
    }
    std::size_t end = i + 1;
    while (end < row.size() && end - i < 128 && runLength(row, end) < kWorthwhile) ++end;
    bytes.push_back(static_cast<char>(end - i));
    bytes.append(row.begin() + static_cast<std::ptrdiff_t>(i), row.begin() + static_cast<std::ptrdiff_t>(end));
    i = end;
  }
}

void appendScanline(std::string& bytes, const std::vector<RgbePixel>& line) {
  if (line.size() < 8 || line.size() > 32767) {
    for (const RgbePixel& pixel : line) bytes.append(pixel.begin(), pixel.end());
    return;
  }
  bytes += {2, 2, static_cast<char>(line.size() >> 8), static_cast<char>(line.size() & 255)};
  std::vector<std::uint8_t> component(line.size());
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < line.size(); ++i) component[i] = line[i][c];
    appendRuns(bytes, component);
  }
}
}  // namespace

std::string encodeHdr(const Image& image) {
  std::string bytes = "#?RADIANCE\nSOFTWARE= deltalux " DELTALUX_VERSION "\n";
  if (!image.view.empty()) bytes += fmt::format("VIEW= {}\n", image.view);
  if (image.exposure != 1.0) bytes += fmt::format("EXPOSURE={:.9g}\n", image.exposure);
  bytes += fmt::format("FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
  std::vector<RgbePixel> line(static_cast<std::size_t>(image.width));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      line[static_cast<std::size_t>(x)] = toRgbe(image.at(x, y) * static_cast<float>(image.exposure));
    appendScanline(bytes, line);
  }
  return bytes;
}

}  // namespace deltalux::io
