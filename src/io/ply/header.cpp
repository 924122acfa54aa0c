#include "io/ply/header.hpp"

#include <algorithm>
#include <charconv>
#include <deltalux/error.hpp>
#include <map>

#include "io/obj/words.hpp"

namespace deltalux::io::ply {

namespace {

constexpr int kMostLines = 1000;                  // of a header [limit]
constexpr std::uint64_t kMost = 1'000'000'000;    // of one element [limit]
constexpr std::size_t kShown = 40;                // [shown]
constexpr const char* kHint = "export it again";  // what to do

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  Header read() {
    if (line() != "ply") fail("is no PLY file: it does not begin with the line 'ply'");
    for (bool known = false;;) {
      if (header_.lines >= kMostLines) fail("the header has no end");
      std::string_view rest = line();
      const std::string_view word = takeWord(rest);
      if (word == "end_header") {
        if (!known) fail("the header says no format");
        header_.size = at_;
        return std::move(header_);
      }
      if (word == "format") {
        header_.encoding = encoding(takeWord(rest)), known = true;
      } else if (word == "element") {
        addElement(rest);
      } else if (word == "property") {
        addProperty(rest);
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        fail("'" + std::string(word.substr(0, kShown)) + "' is no word of a header");
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, header_.lines, message, kHint); }

  std::string_view line() {
    if (at_ >= bytes_.size()) fail("the file ends within its header");
    std::string_view text = bytes_.substr(at_, bytes_.find('\n', at_) - at_);
    at_ = std::min(at_ + text.size() + 1, bytes_.size());
    ++header_.lines;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  Encoding encoding(std::string_view word) const {
    if (word == "ascii") return Encoding::Text;
    if (word == "binary_little_endian") return Encoding::LittleEndian;
    if (word == "binary_big_endian") return Encoding::BigEndian;
    fail("'" + std::string(word.substr(0, kShown)) + "' is no format of PLY");
  }

  Number number(std::string_view word) const {
    static const std::map<std::string_view, Number> kNumbers{
        {"char", Number::Int8},      {"uchar", Number::Uint8},    {"short", Number::Int16},
        {"ushort", Number::Uint16},  {"int", Number::Int32},      {"uint", Number::Uint32},
        {"float", Number::Float32},  {"double", Number::Float64}, {"int8", Number::Int8},
        {"uint8", Number::Uint8},    {"int16", Number::Int16},    {"uint16", Number::Uint16},
        {"int32", Number::Int32},    {"uint32", Number::Uint32},  {"float32", Number::Float32},
        {"float64", Number::Float64}};
    const auto found = kNumbers.find(word);
    if (found == kNumbers.end()) fail("'" + std::string(word.substr(0, kShown)) + "' is no type of number");
    return found->second;
  }

  void addElement(std::string_view rest) {
    Element element;
    element.name = takeWord(rest);
    element.line = header_.lines;
    const std::string_view count = takeWord(rest);
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || count.empty() || error != std::errc() || end != count.data() + count.size() ||
        element.count > kMost)
      fail("the element has no name, or no usable count");
    header_.elements.push_back(std::move(element));
  }

  void addProperty(std::string_view rest) {
    if (header_.elements.empty()) fail("the property belongs to no element");
    Property property;
    std::string_view type = takeWord(rest);
    if (type == "list") {
      property.count = number(takeWord(rest));
      if (*property.count >= Number::Float32) fail("the list's count is no integer");
      type = takeWord(rest);
    }
    property.number = number(type);
    property.name = takeWord(rest);
    if (property.name.empty()) fail("the property has no name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  Header header_;
};

}  // namespace

Header readHeader(std::string_view bytes, const std::string& file) { return HeaderReader(bytes, file).read(); }

}  // namespace deltalux::io::ply
