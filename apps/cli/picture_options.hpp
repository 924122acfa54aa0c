#pragma once
// How a rendered view becomes a picture file: its size, and for the screen exposure, tone mapping or false colour.
#include <CLI/CLI.hpp>
#include <deltalux/image_io.hpp>
#include <optional>
#include <string>

#include "run_options.hpp"

namespace deltalux::cli {

class PictureOptions {
 public:
  /// Adds --size, --ev, --tonemap and --falsecolor; all need `view`.
  void add(CLI::App&, CLI::Option* view);
  /// Throws CLI::ValidationError when `output` is no picture name, or an option would not change it.
  void validate(const std::string& output) const;

  bool falseColor() const { return !falseColor_.empty(); }
  /// Width and height that fit --size and keep the view's shape.
  glm::ivec2 resolution(const View&) const;
  /// Writes radiance. Without --ev a .png's exposure is chosen from the picture, and said.
  void save(const std::string& output, const Image& radiance, const Run&) const;
  /// Writes irradiance in false colour.
  void saveFalseColor(const std::string& output, const Image& irradiance) const;

 private:
  std::string size_ = "640x640";
  std::optional<double> ev_;
  std::optional<std::string> toneOperator_;
  std::string falseColor_;
};

}  // namespace deltalux::cli
