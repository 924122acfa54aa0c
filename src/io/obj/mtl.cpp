#include "io/obj/mtl.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deltalux/error.hpp>

#include "io/lower_case.hpp"
#include "io/number.hpp"
#include "io/obj/lines.hpp"
#include "io/obj/words.hpp"
#include "io/plain_text.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io {

namespace {

using Words = std::vector<std::string_view>;

// The words of a line before a comment.
Words wordsOf(std::string_view line) {
  Words words;
  for (std::string_view word = takeWord(line); !word.empty() && word[0] != '#'; word = takeWord(line))
    words.push_back(word);
  return words;
}

// The file of a map statement, behind its options; it may hold blanks.
std::string mapFile(std::string_view line, bool& hasOptions) {
  struct Option {
    std::string_view name;
    int least, most;  // arguments; those beyond the least are numbers
  };
  static constexpr std::array<Option, 13> kOptions{{{"-blendu", 1, 1},
                                                    {"-blendv", 1, 1},
                                                    {"-boost", 1, 1},
                                                    {"-bm", 1, 1},
                                                    {"-cc", 1, 1},
                                                    {"-clamp", 1, 1},
                                                    {"-imfchan", 1, 1},
                                                    {"-mm", 2, 2},
                                                    {"-o", 1, 3},
                                                    {"-s", 1, 3},
                                                    {"-t", 1, 3},
                                                    {"-texres", 1, 1},
                                                    {"-type", 1, 1}}};  // [defined]
  for (;;) {
    std::string_view rest = line;
    const std::string_view word = takeWord(rest);
    const auto* const option =
        std::find_if(kOptions.begin(), kOptions.end(), [&](const Option& o) { return o.name == lowerCase(word); });
    if (option == kOptions.end()) return std::string(trimmed(line));
    hasOptions = true;
    for (int i = 0; i < option->most; ++i) {
      std::string_view behind = rest;
      const std::string_view argument = takeWord(behind);
      if (i >= option->least && (!parseDecimal(argument) || trimmed(behind).empty())) break;
      rest = behind;
    }
    line = rest;
  }
}

class MtlReader {
 public:
  MtlReader(std::string_view text, const std::string& file, std::map<std::string, std::size_t>& ignored)
      : lines_(text), file_(file), ignored_(ignored) {}

  std::vector<tinyobj::material_t> read() {
    for (std::string_view line; lines_.advance(line);) {
      const std::string_view keyword = takeWord(line);
      if (keyword.empty() || keyword[0] == '#') continue;
      keyword_ = keyword;
      const std::string lower = lowerCase(keyword);
      if (lower == "newmtl") {
        begin(std::string(trimmed(line)));
      } else if (materials_.empty()) {
        count("MTL statements before newmtl");
      } else if (lower.starts_with("map_") || isMapWithoutPrefix(lower)) {
        map(lower, line);
      } else {
        parameter(lower, wordsOf(line));
      }
    }
    return std::move(materials_);
  }

 private:
  static bool isMapWithoutPrefix(std::string_view keyword) {
    return keyword == "bump" || keyword == "disp" || keyword == "decal" || keyword == "refl" || keyword == "norm";
  }

  tinyobj::material_t& material() { return materials_.back(); }
  void count(const std::string& kind) { ++ignored_[kind]; }

  [[noreturn]] void fail(const std::string& message,
                         const std::string& hint = "correct it, or export the materials again") const {
    throw InputError(file_, lines_.line(), keyword_ + " " + message, hint);
  }

  void begin(std::string name) {
    tinyobj::material_t fresh{};
    fresh.name = std::move(name);
    fresh.dissolve = fresh.ior = fresh.shininess = 1;
    materials_.push_back(std::move(fresh));
    hasDiffuse_ = hasDissolve_ = hasTransparency_ = false;
  }

  void parameter(const std::string& keyword, const Words& words) {
    tinyobj::material_t& m = material();
    if (keyword == "kd") {
      reflectance(words, m.diffuse), hasDiffuse_ = true;
    } else if (keyword == "ks") {
      reflectance(words, m.specular);
    } else if (keyword == "tf" || keyword == "kt") {
      reflectance(words, m.transmittance);
    } else if (keyword == "ke") {
      emission(words);
    } else if (keyword == "d") {
      dissolve(words);
    } else if (keyword == "tr") {
      transparency(words);
    } else if (keyword == "ns") {
      m.shininess = within(number(words), 0, kLargest);
    } else if (keyword == "ni") {
      m.ior = number(words);
    } else if (keyword == "illum") {
      m.illum = static_cast<int>(within(number(words), 0, 10));
    } else if (keyword == "pr") {
      m.roughness = number(words);
    } else if (keyword == "pm") {
      m.metallic = number(words);
    } else if (keyword != "ka" && keyword != "sharpness") {  // these have no light of their own
      count("MTL statements not known");
    }
  }

  double number(std::string_view word) const {
    if (const auto value = parseDecimal(word)) return *value;
    fail(notANumber(word));
  }
  double number(const Words& words) {
    if (words.empty()) fail("has no number behind it");
    if (words.size() > 1) count("numbers too many in MTL statements");
    return number(words[0]);
  }

  double within(double value, double low, double high) {
    if (value >= low && value <= high) return value;
    count("MTL parameters out of range (the nearest value in it taken)");
    return std::clamp(value, low, high);
  }

  // One number is grey.
  std::array<double, 3> colour(const Words& words) {
    if (words.empty()) fail("has no numbers behind it");
    const std::string form = lowerCase(words[0]);
    if (form == "spectral") fail("gives its colour as a spectral curve, which is not read", "give it as three numbers");
    if (form == "xyz") fail("gives its colour in CIE XYZ, which is not read", "give it as red, green and blue");
    if (words.size() == 2) fail("has two numbers, not one (grey) or three");
    if (words.size() > 3) count("numbers too many in MTL statements");
    const double first = number(words[0]);
    if (words.size() == 1) return {first, first, first};
    return {first, number(words[1]), number(words[2])};
  }

  void reflectance(const Words& words, tinyobj::real_t (&values)[3]) {
    const std::array<double, 3> given = colour(words);
    const auto [low, high] = std::minmax_element(given.begin(), given.end());
    if (*high > 1) count("colours above 1 (cut to 1: nothing sends back more light than it gets)");
    if (*low < 0) count("colours below 0 (taken as 0)");
    for (std::size_t c = 0; c < 3; ++c) values[c] = std::clamp(given[c], 0.0, 1.0);
  }

  void emission(const Words& words) {
    const std::array<double, 3> given = colour(words);
    for (std::size_t c = 0; c < 3; ++c) {
      if (given[c] < 0) fail("is negative", "radiance is 0 or more");
      if (given[c] > kLargest) fail("is too large", "it is radiance in W/(sr m2)");
      material().emission[c] = given[c];
    }
  }

  void dissolve(Words words) {
    if (!words.empty() && lowerCase(words[0]) == "-halo") {
      count("-halo of d (taken the same at every angle)");
      words.erase(words.begin());
    }
    const double d = within(number(words), 0, 1);
    if (hasTransparency_) compare(d, material().dissolve);
    material().dissolve = d, hasDissolve_ = true;
  }

  void transparency(const Words& words) {
    // Some write a colour here, as for Tf.
    const std::array<double, 3> given = words.size() == 3 ? colour(words) : std::array<double, 3>{number(words), 0, 0};
    if (words.size() == 3 && (given[0] != given[1] || given[0] != given[2]))
      fail("has three numbers that differ", "give one number, or a colour by Tf");
    const double d = 1 - within(given[0], 0, 1);
    if (hasDissolve_) return compare(material().dissolve, d);
    material().dissolve = d, hasTransparency_ = true;
  }

  void compare(double byD, double byTr) {
    constexpr double kRounding = 1e-3;  // of decimals as they are written [rounding]
    if (std::abs(byD - byTr) > kRounding) count("Tr that contradict d (d counts)");
  }

  void map(const std::string& keyword, std::string_view line) {
    tinyobj::material_t& m = material();
    bool hasOptions = false;
    std::string file = mapFile(line, hasOptions);
    if (file.empty()) fail("names no file");
    if (keyword == "map_kd") {
      if (hasOptions) count("options of map_Kd");
      if (!hasDiffuse_) std::fill(m.diffuse, m.diffuse + 3, 0.6);  // as tinyobjloader has it
      m.diffuse_texname = std::move(file);
    } else if (keyword != "map_ka") {
      count("material maps other than map_Kd");
    }
  }

  static constexpr double kLargest = 1e15;  // [limit]

  LineStreambuf lines_;
  const std::string& file_;
  std::map<std::string, std::size_t>& ignored_;
  std::vector<tinyobj::material_t> materials_;
  std::string keyword_;
  bool hasDiffuse_ = false, hasDissolve_ = false, hasTransparency_ = false;  // of the last material
};

}  // namespace

std::vector<tinyobj::material_t> readMtl(std::string_view text, const std::string& file,
                                         std::map<std::string, std::size_t>& ignored) {
  if (text.find('\0') != std::string_view::npos) throw InputError(file, 0, "is not text", "give an MTL file");
  const PlainText plain(text, file);
  return MtlReader(plain.view(), file, ignored).read();
}

}  // namespace deltalux::io
