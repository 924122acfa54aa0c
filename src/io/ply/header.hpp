#pragma once
// The header of a PLY file: what its body holds, and how. [PLY]
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io::ply {

enum class Encoding { Text, LittleEndian, BigEndian };

enum class Number { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
  std::string name;
  Number number = Number::Float32;
  std::optional<Number> count;  // of a list, how many there are
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  int line = 0;  // of the header
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes to the body
  int lines = 0;
};

/// Throws InputError with the line.
Header readHeader(std::string_view bytes, const std::string& file);

}  // namespace deltalux::io::ply
