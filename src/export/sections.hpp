#pragma once
// Named runs of bytes, one after the other, each from a multiple of 4 on.
#include <bit>
#include <map>
#include <span>
#include <string>
#include <utility>

namespace deltalux::exporting {

static_assert(std::endian::native == std::endian::little, "sections have the lowest byte first");

class Sections {
 public:
  void add(const std::string& name, std::string_view bytes) {
    table_[name] = {bytes_.size(), bytes.size()};
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
  }
  /// Numbers, or vectors of numbers.
  template <class T>
  void addArray(const std::string& name, const std::vector<T>& values) {
    add(name, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }

  /// Offset and size [bytes].
  const std::map<std::string, std::pair<std::size_t, std::size_t>>& table() const { return table_; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::map<std::string, std::pair<std::size_t, std::size_t>> table_;
  std::string bytes_;
};

}  // namespace deltalux::exporting
