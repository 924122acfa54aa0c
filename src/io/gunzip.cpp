#include "io/gunzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <memory>

#include "io/import_file.hpp"

namespace deltalux::io {

namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 31;  // unpacked [limit]
constexpr std::size_t kChunk = std::size_t{1} << 16;      // [task]
constexpr int kGzipWindow = 16 + MAX_WBITS;               // zlib's way to say gzip [layout]

}  // namespace

bool isGzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string gunzip(std::string_view bytes, const std::string& file) {
  z_stream stream{};
  if (inflateInit2(&stream, kGzipWindow) != Z_OK) throw InputError(file, 0, "cannot be unpacked", "unpack it yourself");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  std::string unpacked;
  std::string chunk(kChunk, '\0');
  for (int state = Z_OK; state != Z_STREAM_END;) {
    if (stream.avail_in == 0) {
      const std::string_view part = bytes.substr(0, kChunk);
      bytes.remove_prefix(part.size());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
      stream.avail_in = static_cast<uInt>(part.size());
    }
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = inflate(&stream, Z_NO_FLUSH);
    if (state != Z_OK && state != Z_STREAM_END)
      throw InputError(file, 0, "is damaged, or not wholly there: gzip does not unpack it", "make the file again");
    unpacked.append(chunk, 0, chunk.size() - stream.avail_out);
    if (unpacked.size() > kMostBytes) throw InputError(file, 0, "is too large when unpacked", "split it");
  }
  return unpacked;
}

std::string readUnpacked(const std::filesystem::path& file) {
  std::string bytes = readInputFile(file);
  return isGzip(bytes) ? gunzip(bytes, file.string()) : bytes;
}

}  // namespace deltalux::io
