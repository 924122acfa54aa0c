#include "picture_options.hpp"

#include <fmt/format.h>

#include <charconv>

namespace deltalux::cli {

namespace {
constexpr int kMaxSide = 32768;

/// "WxH" in pixels; nullopt when it does not read so or is out of range.
std::optional<glm::ivec2> parseSize(const std::string& text) {
  const char* const end = text.data() + text.size();
  glm::ivec2 size(0);
  const auto [x, widthError] = std::from_chars(text.data(), end, size.x);
  if (widthError != std::errc() || x == end || *x != 'x') return std::nullopt;
  const auto [rest, heightError] = std::from_chars(x + 1, end, size.y);
  if (heightError != std::errc() || rest != end) return std::nullopt;
  if (std::min(size.x, size.y) < 1 || std::max(size.x, size.y) > kMaxSide) return std::nullopt;
  return size;
}

std::string checkSize(const std::string& text) {
  return parseSize(text) ? "" : fmt::format("'{}' should read WIDTHxHEIGHT, each 1 to {}", text, kMaxSide);
}
}  // namespace

void PictureOptions::add(CLI::App& app, CLI::Option* view) {
  app.add_option("--size", size_, "The picture fits into this and keeps the view's shape")
      ->type_name("WxH")
      ->check(checkSize)
      ->capture_default_str()
      ->needs(view);
  app.add_option("--ev", ev_,
                 "Exposure of a .png in stops; at 0 a radiance of 1 W/(sr m2) counts as 1 (default: chosen)")
      ->type_name("N")
      ->check(CLI::Range(-100.0, 100.0))
      ->needs(view);
  app.add_option("--tonemap", toneOperator_, "Operator of a .png: reinhard (default) or linear")
      ->type_name("NAME")
      ->check(CLI::IsMember({"reinhard", "linear"}))
      ->needs(view);
  app.add_option("--falsecolor", falseColor_, "lux: illuminance of what is seen, in colours with a scale, as .png")
      ->type_name("lux")
      ->check(CLI::IsMember({"lux"}))
      ->needs(view);
}

void PictureOptions::validate(const std::string& output) const {
  const std::optional<ImageFormat> format = imageFormatOf(output);
  if (!format) throw CLI::ValidationError(fmt::format("-o {}: a picture's name ends in .exr, .hdr or .png", output));
  if (falseColor() && format != ImageFormat::Png)
    throw CLI::ValidationError(fmt::format("-o {}: false colour is written as .png", output));
  if ((ev_ || toneOperator_) && (falseColor() || format != ImageFormat::Png))
    throw CLI::ValidationError("--ev and --tonemap change only a .png without --falsecolor: leave them out");
}

glm::ivec2 PictureOptions::resolution(const View& view) const {
  const glm::ivec2 size = *parseSize(size_);
  return fitResolution(view, size.x, size.y);
}

void PictureOptions::save(const std::string& output, const Image& radiance, const Run& run) const {
  ToneMapping mapping;
  if (toneOperator_) mapping.toneOperator = *toneOperatorByName(*toneOperator_);
  if (imageFormatOf(output) == ImageFormat::Png) {
    mapping.ev = ev_ ? *ev_ : automaticEv(radiance);
    if (!ev_) run.say(fmt::format("exposure chosen: --ev {:.1f}", mapping.ev));
  }
  saveImage(output, radiance, mapping);
}

void PictureOptions::saveFalseColor(const std::string& output, const Image& irradiance) const {
  saveImage(output, deltalux::falseColor(irradiance));
}

}  // namespace deltalux::cli
