#pragma once
// --area or --surface: where a measuring grid lies, and how its points lie on it.
#include <CLI/CLI.hpp>
#include <deltalux/grid.hpp>
#include <string>

namespace deltalux::cli {

class GridPlace {
 public:
  GridSettings settings;

  void add(CLI::App&);  // --surface, --area, --spacing, --border
  bool given() const { return !area_.empty() || !surface_.empty(); }
  /// Throws CLI::ValidationError where neither or both are said, or the area is none.
  void validate() const;
  /// Precondition: validate(). Throws InputError for a surface that the scene does not have.
  MeasuringGrid grid(const Scene&) const;
  std::string name() const { return surface_.empty() ? "area" : surface_; }

 private:
  std::string area_, surface_;
};

}  // namespace deltalux::cli
