#include "io/obj/check.hpp"

#include <charconv>
#include <cmath>
#include <deltalux/error.hpp>

#include "io/number.hpp"
#include "io/obj/lines.hpp"
#include "io/obj/words.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io {

namespace {

constexpr double kLargestVertex = 1e15;  // coordinate [limit]

bool parses(std::string_view word, int& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

// `required` numbers; more may follow (weights, colours).
void checkNumbers(std::string_view line, int required, const auto& fail) {
  for (int count = 0;; ++count) {
    const std::string_view word = takeWord(line);
    if (word.empty() && count < required)
      fail("has " + std::to_string(count) + " numbers, not " + std::to_string(required));
    if (word.empty() || word.starts_with('#')) return;
    const auto value = parseDecimal(word);
    if (!value) fail(notANumber(word));
    if (std::abs(*value) > kLargestVertex) fail("'" + std::string(word.substr(0, 40)) + "' is too large");
  }
}

// Corners v, v/vt, v//vn, v/vt/vn; the last two parts may be empty.
void checkCorners(std::string_view line, const auto& fail) {
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
    if (word.starts_with('#')) fail("has a comment behind it, which OBJ does not know");
    const std::string_view whole = word;
    for (int part = 0; part < 3; ++part) {
      const std::string_view index = word.substr(0, word.find('/'));
      int value = 0;
      if ((part == 0 || !index.empty()) && !parses(index, value)) {
        fail("corner '" + std::string(whole.substr(0, 40)) + "' is not of the form v, v/vt, v//vn or v/vt/vn");
      }
      if (index.size() == word.size()) break;
      if (part == 2) fail("corner '" + std::string(whole.substr(0, 40)) + "' has too many parts");
      word.remove_prefix(index.size() + 1);
    }
  }
}

}  // namespace

ObjSurvey surveyObj(std::string_view text, const std::string& name) {
  if (text.find('\0') != std::string_view::npos) throw InputError(name, 0, "is not text", "give a Wavefront OBJ file");
  ObjSurvey survey;
  LineStreambuf lines(text);
  for (std::string_view line; lines.advance(line);) {
    const std::string_view keyword = takeWord(line);
    const auto fail = [&](const std::string& what) {
      throw InputError(name, lines.line(), std::string(keyword) + ": " + what, "export the file again");
    };
    if (keyword == "v" || keyword == "vn") checkNumbers(line, 3, fail);
    if (keyword == "vt") checkNumbers(line, 1, fail);
    if (keyword == "f") checkCorners(line, fail), ++survey.faces;
    if (keyword == "l" || keyword == "p") ++survey.ignored["points or lines"];
    if (keyword == "curv" || keyword == "curv2" || keyword == "surf") ++survey.ignored["free-form curves or surfaces"];
    if (keyword == "mtllib") {
      survey.materialLines.emplace_back(trimmed(line));
      survey.materialLineNumbers.push_back(lines.line());
    }
  }
  return survey;
}

}  // namespace deltalux::io
