#include "io/import_file.hpp"
#include "io/radiance.hpp"
#include "io/radiance/scene_builder.hpp"

namespace deltalux::io {

namespace fs = std::filesystem;

ImportedScene loadRadiance(const std::vector<fs::path>& files, const ImportSettings& settings) {
  radiance::DiskAccess disk(files.empty() ? fs::path() : files.front().parent_path());
  radiance::Expander expander(disk);
  std::vector<radiance::RadObject> objects;
  for (const fs::path& file : files) {
    const auto expanded =
        expander.expand({file.string(), file.parent_path(), fs::weakly_canonical(file).string(), readInputFile(file)});
    objects.insert(objects.end(), expanded->begin(), expanded->end());
  }
  return radiance::buildScene(objects, disk, settings, {});
}

ImportedScene readRadiance(const radiance::SourceFile& file, radiance::FileAccess& files,
                           const ImportSettings& settings, const radiance::ExpansionLimits& limits) {
  return radiance::buildScene(*radiance::Expander(files, limits).expand(file), files, settings, limits);
}

}  // namespace deltalux::io
