#include "io/solution_file/container.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <deltalux/error.hpp>

namespace deltalux::io {

static_assert(std::endian::native == std::endian::little, "solution files are little-endian");

namespace {

constexpr std::string_view kMagic =
    "\x89"
    "DLX\r\n\x1a\n";
constexpr std::size_t kHead = 8 + 4 + 4 + 8 + 4, kTag = 4, kSectionFrame = kTag + 8 + 4;  // [layout]

std::uint32_t crc(std::uint32_t before, const void* data, std::size_t n) {
  const auto* at = static_cast<const unsigned char*>(data);
  uLong sum = before;
  for (constexpr std::size_t chunk = 1u << 30; n > 0;) {
    const std::size_t now = std::min(n, chunk);
    sum = crc32(sum, at, static_cast<uInt>(now));
    at += now, n -= now;
  }
  return static_cast<std::uint32_t>(sum);
}

template <class T>
T numberAt(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

template <class T>
void append(std::string& to, const T& number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

[[noreturn]] void refuse(const std::string& file, const std::string& what,
                         const std::string& hint = "solve the scene again") {
  throw InputError(file, 0, what, hint);
}

/// The number of sections, once the head is as it should be.
std::uint32_t checkHead(std::string_view bytes, const std::string& file) {
  const std::string_view start = bytes.substr(0, kMagic.size());
  if (start.empty() || start != kMagic.substr(0, start.size()))
    refuse(file, "is not a deltalux solution", "name a .dlx file");
  if (bytes.size() < kHead) refuse(file, "is truncated: not even its head is complete");
  if (numberAt<std::uint32_t>(bytes, kHead - 4) != crc(0, bytes.data(), kHead - 4))
    refuse(file, "is damaged in its head");
  const auto version = numberAt<std::uint32_t>(bytes, 8);
  if (version != kFormatVersion)
    refuse(file, fmt::format("is of solution format {}, and this deltalux reads format {}", version, kFormatVersion),
           version > kFormatVersion ? "use a newer deltalux, or solve the scene again" : "solve the scene again");
  const auto length = numberAt<std::uint64_t>(bytes, 16);
  if (length > bytes.size()) refuse(file, fmt::format("is truncated: {} of {} bytes are there", bytes.size(), length));
  if (length < bytes.size()) refuse(file, fmt::format("is damaged: {} bytes follow its end", bytes.size() - length));
  return numberAt<std::uint32_t>(bytes, 12);
}

}  // namespace

std::vector<Section> openContainer(std::string_view bytes, const std::string& file) {
  const std::uint32_t count = checkHead(bytes, file);
  std::string_view rest = bytes.substr(kHead);
  std::vector<Section> sections;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (rest.size() < kSectionFrame) refuse(file, "is damaged: a section is missing");
    const auto length = numberAt<std::uint64_t>(rest, kTag);
    if (length > rest.size() - kSectionFrame) refuse(file, "is damaged: a section is longer than the file");
    const std::size_t covered = kTag + 8 + length;
    const std::string_view tag = rest.substr(0, kTag);
    if (numberAt<std::uint32_t>(rest, covered) != crc(0, rest.data(), covered))
      refuse(file, fmt::format("is damaged: the checksum of section {} does not hold", i + 1));
    sections.push_back({tag, rest.substr(kTag + 8, length)});
    rest.remove_prefix(covered + 4);
  }
  if (!rest.empty()) refuse(file, "is damaged: there is more than its sections");
  return sections;
}

void writeContainer(const std::vector<Section>& sections, const ByteSink& sink) {
  std::uint64_t length = kHead;
  for (const Section& s : sections) length += kSectionFrame + s.payload.size();
  std::string head(kMagic);
  append(head, kFormatVersion);
  append(head, static_cast<std::uint32_t>(sections.size()));
  append(head, length);
  append(head, crc(0, head.data(), head.size()));
  sink(head);
  for (const Section& s : sections) {
    std::string frame(s.tag);
    append(frame, static_cast<std::uint64_t>(s.payload.size()));
    const std::uint32_t sum = crc(crc(0, frame.data(), frame.size()), s.payload.data(), s.payload.size());
    sink(frame);
    sink(s.payload);
    sink(std::string_view(reinterpret_cast<const char*>(&sum), sizeof sum));
  }
}

}  // namespace deltalux::io
