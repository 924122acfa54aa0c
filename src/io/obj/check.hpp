#pragma once
// What tinyobjloader passes over: it reads anything as a number (0 if need be), splits file names at blanks, and says
// nothing of lines. So every line is looked at before it gets the text.
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

struct ObjSurvey {
  std::vector<std::string> materialLines;  // what stands behind each mtllib
  std::vector<int> materialLineNumbers;
  std::size_t faces = 0;
  std::map<std::string, std::size_t> ignored;
};

/// Throws InputError with the line of the first vertex or face that is malformed.
ObjSurvey surveyObj(std::string_view text, const std::string& name);

}  // namespace deltalux::io
