#pragma once
// What a page holds, read back.
#include <zlib.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace deltalux::test {

inline std::string fromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, word = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) break;
    word = word << 6 | static_cast<unsigned>(digit), bits += 6;
    if (bits >= 8) out += static_cast<char>(word >> (bits -= 8) & 255);
  }
  return out;
}

inline std::string gunzip(const std::string& bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::runtime_error("zlib");
  std::string out, part(1 << 16, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  int end = Z_OK;
  while (end == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(part.data()), stream.avail_out = static_cast<uInt>(part.size());
    end = inflate(&stream, Z_NO_FLUSH);
    out.append(part, 0, part.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (end != Z_STREAM_END) throw std::runtime_error("not gzip");
  return out;
}

struct Payload {
  nlohmann::json header;
  std::string sections, later;

  std::string section(const std::string& name) const {
    const bool first = header.at("sections").contains(name);
    const auto& at = header.at(first ? "sections" : "later").at(name);
    return (first ? sections : later).substr(at.at(0), at.at(1));
  }
  template <class T>
  std::vector<T> array(const std::string& name) const {
    const std::string bytes = section(name);
    std::vector<T> out(bytes.size() / sizeof(T));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
};

/// What an element of the page holds.
inline std::string unpacked(const std::string& html, const std::string& id) {
  const std::string begin = "<script id=\"" + id + "\" type=\"text/plain\">";
  const std::size_t at = html.find(begin) + begin.size();
  return gunzip(fromBase64(html.substr(at, html.find('<', at) - at)));
}

inline Payload payloadOfPage(const std::string& html) {
  const std::string bytes = unpacked(html, "solution");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  return {nlohmann::json::parse(bytes.substr(4, length)), bytes.substr((4 + length + 3) / 4 * 4),
          unpacked(html, "later")};
}

}  // namespace deltalux::test
