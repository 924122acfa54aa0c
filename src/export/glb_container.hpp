#pragma once
// The outer form of a .glb: one JSON document and one buffer of bytes, with views into it. [glTF 2.0, 4.4]
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace deltalux::exporting {

using GlbJson = nlohmann::ordered_json;

class GlbContainer {
 public:
  GlbJson json = GlbJson::object();

  /// Adds an array of elements of `stride` bytes (a multiple of 4); the number of its view. `target`: 34962 for
  /// vertices, 34963 for indices, 0 for neither.
  std::size_t addView(std::string_view bytes, std::size_t stride, int target);
  /// The same packed, without loss; `target` 34963 are triangles of 32-bit indices. [EXT_meshopt_compression]
  std::size_t addPackedView(std::string_view bytes, std::size_t stride, int target);
  /// Appends to an array of the document; the number of the member.
  std::size_t add(const char* array, GlbJson member);
  /// Notes an extension as used, or as required, once.
  void use(const char* extension, bool required = false);

  /// The file. Throws std::length_error when it is beyond the 4 GB that the format can tell.
  std::string bytes() const;

 private:
  std::size_t append(std::string_view bytes);

  std::string buffer_;
  std::size_t unpacked_ = 0;  // bytes of the buffer that only unpacking makes
};

template <class T>
std::string_view bytesOf(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace deltalux::exporting
