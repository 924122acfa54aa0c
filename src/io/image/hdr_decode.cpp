// Radiance RGBE: header lines, a resolution line that also gives the orientation, scanlines flat or in the old or new
// run lengths. Hostile bytes end in an InputError. [Radiance, "The RADIANCE Picture File Format"; Radiance, color.c]
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <deltalux/error.hpp>

#include "io/image/formats.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io {

namespace {
using Rgbe = std::array<std::uint8_t, 4>;
constexpr int kMaxSide = 65536;  // [limit]

Rgb toRgb(const Rgbe& v) {
  if (v[3] == 0) return Rgb(0.0f);
  const float scale = std::ldexp(1.0f, static_cast<int>(v[3]) - (128 + 8));
  return scale * Rgb(static_cast<float>(v[0]) + 0.5f, static_cast<float>(v[1]) + 0.5f, static_cast<float>(v[2]) + 0.5f);
}

/// Numbers at the front of `text`, as many as there are.
std::vector<double> numbersOfLine(std::string_view text) {
  std::vector<double> numbers;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) break;
    numbers.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return numbers;
}

/// One step of the resolution line, e.g. "-Y 480": which axis, which way, how many.
struct Axis {
  char letter = 'Y';
  bool ascending = false;
  int count = 0;
};

class Decoder {
 public:
  Decoder(std::string_view bytes, const std::string& file) : rest_(bytes), file_(file) {}

  Image decode() {
    readHeader();
    readResolution();
    const bool rowsAreLines = major_.letter == 'Y';
    image_.width = rowsAreLines ? minor_.count : major_.count;
    image_.height = rowsAreLines ? major_.count : minor_.count;
    // The smallest coding of a pixel is a share of a run: refuse sizes that the bytes cannot hold before reserving
    // room.
    const std::size_t total = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height);
    if (total / 64 > rest_.size() + 64) fail("the picture ends too early");
    image_.pixels.resize(total);
    std::vector<Rgbe> line(static_cast<std::size_t>(minor_.count));
    for (int i = 0; i < major_.count; ++i) {
      readScanline(line);
      store(line, i);
    }
    return std::move(image_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, line_, message); }

  std::string_view nextLine() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) fail("the header does not end");
    const std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    ++line_;
    return text;
  }

  void readHeader() {
    const std::string_view magic = nextLine();
    if (magic.substr(0, 2) != "#?") fail("this is no Radiance picture (it should start with #?RADIANCE)");
    for (std::string_view text = trimmed(nextLine()); !text.empty(); text = trimmed(nextLine())) readVariable(text);
  }

  void readVariable(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return;
    const std::string_view name = trimmed(text.substr(0, equals)), value = trimmed(text.substr(equals + 1));
    if (name == "FORMAT" && value != "32-bit_rle_rgbe")
      fail("pictures of format " + std::string(value) + " cannot be read");
    if (name == "VIEW") image_.view += (image_.view.empty() ? "" : " ") + std::string(value);
    if (name == "EXPOSURE") {
      const std::vector<double> numbers = numbersOfLine(value);
      if (numbers.size() != 1 || !(numbers[0] > 0)) fail("EXPOSURE should be one positive number");
      image_.exposure *= numbers[0];
    }
    if (name == "COLORCORR") {
      const std::vector<double> numbers = numbersOfLine(value);
      if (numbers.size() != 3 || !(std::min({numbers[0], numbers[1], numbers[2]}) > 0))
        fail("COLORCORR should be three positive numbers");
      correction_ *= glm::dvec3(numbers[0], numbers[1], numbers[2]);
    }
  }

  void readResolution() {
    std::string_view text = trimmed(nextLine());
    major_ = readAxis(text);
    minor_ = readAxis(text);
    if (major_.letter == minor_.letter || !trimmed(text).empty()) failResolution();
  }

  [[noreturn]] void failResolution() const { fail("the resolution line should look like: -Y 480 +X 640"); }

  Axis readAxis(std::string_view& text) const {
    text = trimmed(text);
    if (text.size() < 4 || (text[0] != '-' && text[0] != '+') || (text[1] != 'X' && text[1] != 'Y')) failResolution();
    Axis axis{text[1], text[0] == '+', 0};
    text = trimmed(text.substr(2));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), axis.count);
    if (error != std::errc() || axis.count < 1 || axis.count > kMaxSide) failResolution();
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return axis;
  }

  std::uint8_t next() {
    if (rest_.empty()) fail("the picture ends too early");
    const auto byte = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return byte;
  }

  void readScanline(std::vector<Rgbe>& line) {
    Rgbe first{next(), next(), next(), next()};
    const bool newRuns = line.size() >= 8 && line.size() <= 32767 && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!newRuns) return readOldRuns(line, first);
    if (static_cast<std::size_t>(first[2] << 8 | first[3]) != line.size()) fail("a scanline has a wrong length");
    for (std::size_t component = 0; component < 4; ++component) readComponent(line, component);
  }

  void readComponent(std::vector<Rgbe>& line, std::size_t component) {
    for (std::size_t i = 0; i < line.size();) {
      const std::uint8_t code = next();
      const bool run = code > 128;
      const std::size_t count = run ? code - 128u : code;
      if (count == 0 || count > line.size() - i) fail("a run of pixels leaves its scanline");
      const std::uint8_t value = run ? next() : std::uint8_t{0};
      for (std::size_t k = 0; k < count; ++k) line[i++][component] = run ? value : next();
    }
  }

  /// A pixel 1 1 1 n repeats the one before n times; several in a row form a longer number, lowest byte first.
  void readOldRuns(std::vector<Rgbe>& line, Rgbe pixel) {
    int shift = 0;
    for (std::size_t i = 0;; pixel = {next(), next(), next(), next()}) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
        if (i == 0 || shift > 16 || count > line.size() - i) fail("a run of pixels leaves its scanline");
        std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(i), count, line[i - 1]);
        i += count;
        shift += 8;
      } else {
        line[i++] = pixel;
        shift = 0;
      }
      if (i == line.size()) return;
    }
  }

  void store(const std::vector<Rgbe>& line, int i) {
    const int lineAt = major_.ascending == (major_.letter == 'X') ? i : major_.count - 1 - i;
    const glm::dvec3 divisor = image_.exposure * correction_;
    for (int k = 0; k < minor_.count; ++k) {
      const int pixelAt = minor_.ascending == (minor_.letter == 'X') ? k : minor_.count - 1 - k;
      const Rgb radiance(glm::dvec3(toRgb(line[static_cast<std::size_t>(k)])) / divisor);
      if (major_.letter == 'Y')
        image_.at(pixelAt, lineAt) = radiance;
      else
        image_.at(lineAt, pixelAt) = radiance;
    }
  }

  std::string_view rest_;
  std::string file_;
  int line_ = 0;
  Image image_;
  glm::dvec3 correction_{1.0};
  Axis major_, minor_;
};
}  // namespace

Image decodeHdr(std::string_view bytes, const std::string& file) { return Decoder(bytes, file).decode(); }

}  // namespace deltalux::io
