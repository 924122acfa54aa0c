#pragma once
// Turns files with their `!` lines into one flat list of objects. Commands are evaluated natively on parsed objects, no
// text is printed and read again: xform of 10^5 polygons costs a copy each. Expanded files are kept, so a file that is
// placed many times is read once. No shell is ever run.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/radiance/file_access.hpp"
#include "io/radiance/rad_parser.hpp"
#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

struct ExpansionLimits {
  std::size_t objects = 5'000'000;    // of one list; beyond it the input is taken for a mistake
  std::size_t numbers = 200'000'000;  // in their argument lists
  std::size_t depth = 32;             // of files that include files
  long patternCalls = 100'000'000;    // of functions that patterns of lights call: some 20 s
};

class Expander {
 public:
  using Objects = std::vector<RadObject>;

  explicit Expander(FileAccess& files, ExpansionLimits limits = {}) : files_(files), limits_(limits) {}

  /// The objects of a file. Throws InputError.
  std::shared_ptr<const Objects> expand(const SourceFile&);

 private:
  Objects expandItems(std::vector<RadItem>, const std::filesystem::path& folder);
  /// What an instance or mesh stands for; nullopt where its source is not there.
  std::optional<Objects> compound(const RadObject&, const std::filesystem::path& folder, const Objects& before);
  std::shared_ptr<const Objects> include(const SourceFile&, const SourceLine&);
  Objects run(const RadCommand&, const std::filesystem::path& folder);
  Objects generate(const std::vector<std::string>& words, const SourceLine&, const std::filesystem::path& folder);
  Objects transformed(const std::vector<std::string>& words, const Objects* piped, const SourceLine&,
                      const std::filesystem::path& folder);
  SourceFile open(const std::string& name, const SourceLine&, const std::filesystem::path& folder);
  void appendPlaced(Objects& list, const Objects& source, const Placement&, const SourceLine&) const;
  void checkSize(double objects, double numbers, const SourceLine&) const;

  FileAccess& files_;
  ExpansionLimits limits_;
  std::map<std::string, std::shared_ptr<const Objects>> expanded_;  // by identity
  std::vector<std::string> open_;                                   // identities of the files being expanded
};

}  // namespace deltalux::io::radiance
