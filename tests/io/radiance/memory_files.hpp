#pragma once
// Scene descriptions from strings, with the files that they include.
#include <deltalux/error.hpp>
#include <map>
#include <string>

#include "io/radiance.hpp"
#include "io/radiance/expander.hpp"

namespace deltalux::io::radiance::test {

class MemoryFiles : public FileAccess {
 public:
  std::map<std::string, std::string> files;

  std::optional<SourceFile> open(const std::string& name, const std::filesystem::path&) override {
    const auto found = files.find(name);
    if (found == files.end()) return std::nullopt;
    return SourceFile{name, {}, name, found->second};
  }
};

inline SourceFile sourceFile(const std::string& text) { return {"test.rad", {}, "test.rad", text}; }

inline ImportedScene read(const std::string& text, std::map<std::string, std::string> files = {}) {
  MemoryFiles access;
  access.files = std::move(files);
  return io::readRadiance(sourceFile(text), access, {});
}

/// The flat list of objects of `text`.
inline std::vector<RadObject> expand(const std::string& text, std::map<std::string, std::string> files = {},
                                     ExpansionLimits limits = {}) {
  MemoryFiles access;
  access.files = std::move(files);
  return *Expander(access, limits).expand(sourceFile(text));
}

/// what() of the InputError that reading `text` throws; empty when it throws none.
inline std::string errorOf(const std::string& text, std::map<std::string, std::string> files = {}) {
  try {
    read(text, std::move(files));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Volume enclosed by the polygons, by the divergence theorem: positive when all face outwards and leave no gap.
inline double enclosedVolume(const std::vector<RadObject>& objects) {
  double volume = 0;
  for (const RadObject& object : objects) {
    const auto vertex = [&](std::size_t i) {
      return Vec3(object.reals[3 * i], object.reals[3 * i + 1], object.reals[3 * i + 2]);
    };
    for (std::size_t i = 1; i + 1 < object.reals.size() / 3; ++i) {
      volume += glm::dot(vertex(0), glm::cross(vertex(i), vertex(i + 1))) / 6;
    }
  }
  return volume;
}

}  // namespace deltalux::io::radiance::test
