#pragma once
// One fuzzer input as a Radiance scene: texts separated by the byte 1e, the scene first, then the files "a", "b", "c"
// ... that it may include. The disk is out of reach.
#include <deltalux/error.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/radiance.hpp"

namespace deltalux::io::radiance {

class TextFiles : public FileAccess {
 public:
  explicit TextFiles(std::string_view input) {
    for (std::size_t end = 0; end != std::string_view::npos && texts_.size() < 8;) {
      end = input.find('\x1e');
      texts_.emplace_back(input.substr(0, end));
      if (end != std::string_view::npos) input.remove_prefix(end + 1);
    }
  }

  SourceFile scene() const { return {"scene", {}, "scene", texts_[0]}; }

  std::optional<SourceFile> open(const std::string& name, const std::filesystem::path&) override {
    const std::size_t index = name.size() == 1 ? static_cast<std::size_t>(name[0] - 'a' + 1) : texts_.size();
    if (index < 1 || index >= texts_.size()) return std::nullopt;
    return SourceFile{name, {}, name, texts_[index]};
  }

 private:
  std::vector<std::string> texts_;
};

/// Reads `input`: a scene that holds together, or an InputError with a message. Anything else is a defect.
inline bool readsCleanly(std::string_view input) {
  TextFiles files(input);
  ExpansionLimits limits;
  limits.objects = 3000, limits.numbers = 100000, limits.patternCalls = 5000;
  try {
    const ImportedScene imported = io::readRadiance(files.scene(), files, {}, limits);
    validate(imported.scene);
    return imported.report.warnings.size() <= 2;
  } catch (const InputError& error) {
    return !error.message().empty();
  }
}

}  // namespace deltalux::io::radiance
