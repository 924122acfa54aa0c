#include "io/pbrt/colours.hpp"

#include <algorithm>

#include "io/gunzip.hpp"
#include "io/import_file.hpp"
#include "io/pbrt/textures.hpp"
#include "io/plain_text.hpp"
#include "io/spectrum.hpp"

namespace deltalux::io::pbrt {

namespace {

bool isType(const Parameter& p, std::initializer_list<std::string_view> types) {
  return std::ranges::find(types, std::string_view(p.type)) != types.end();
}

[[noreturn]] void failColour(const Parameter& p) {
  fail(p.at, "the parameter " + shown(p.name) + " is no colour, or one of a type that it cannot have");
}

/// Wavelengths and values, by turns.
Spectrum spectrumOf(const std::vector<double>& numbers, const Place& at) {
  Spectrum spectrum;
  if (numbers.empty() || numbers.size() % 2 != 0) fail(at, "a spectrum is no list of wavelengths and values by turns");
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (!spectrum.empty() && !(numbers[i] > spectrum.back().first)) fail(at, "a spectrum's wavelengths do not ascend");
    if (numbers[i + 1] < 0) fail(at, "a spectrum is negative");
    spectrum.emplace_back(numbers[i], numbers[i + 1]);
  }
  return spectrum;
}

Spectrum spectrumOfFile(const std::filesystem::path& path) {
  const std::string name = path.string(), text = readUnpacked(path);
  const PlainText plain(text, name);
  Tokens tokens(plain.view(), name);
  std::vector<double> numbers;
  while (tokens.peek()) numbers.push_back(tokens.takeNumber());
  return spectrumOf(numbers, {&name, 0});
}

/// nullopt for a spectrum that pbrt knows by name.
std::optional<Spectrum> spectrumOf(const Context& context, const Parameter& p) {
  if (p.texts.empty()) return spectrumOf(p.numbers, p.at);
  if (p.texts.size() != 1) failColour(p);
  if (p.texts[0].find('.') == std::string::npos) return std::nullopt;
  return spectrumOfFile(fileOf(context, p));
}

/// One that is written in numbers; nullopt for other types.
std::optional<Rgb> plainColour(const Parameter& p) {
  if (!isType(p, {"rgb", "color", "float", "integer"})) return std::nullopt;
  if (p.numbers.size() != (isType(p, {"rgb", "color"}) ? 3u : 1u)) failColour(p);
  if (*std::ranges::min_element(p.numbers) < 0) fail(p.at, "the colour " + shown(p.name) + " is negative");
  return p.numbers.size() == 1 ? Rgb(static_cast<float>(p.numbers[0]))
                               : Rgb(Vec3(p.numbers[0], p.numbers[1], p.numbers[2]));
}

Rgb blackBody(const Parameter& p) {
  if (p.numbers.size() != 1 || !(p.numbers[0] > 0)) fail(p.at, "a black body has not one temperature above 0");
  return colourOfBlackBody(p.numbers[0]);
}

/// Temperatures of the illuminants that are black bodies, or next to one.
Rgb illuminant(Context& context, const std::string& name) {
  static const std::map<std::string_view, double> kTemperatures{
      {"stdillum-A", 2856}, {"stdillum-D50", 5003}, {"illum-acesD60", 6000}, {"stdillum-D65", 6504}};
  const auto found = kTemperatures.find(name);
  if (found != kTemperatures.end()) return colourOfBlackBody(found->second);
  ignore(context, "spectra known by name (gray instead)");
  return Rgb(1.0f);
}

}  // namespace

void ignore(Context& context, const std::string& what) { ++context.report.ignored[what]; }

std::filesystem::path fileOf(const Context& context, const Parameter& p) {
  if (p.texts.size() != 1) fail(p.at, "the parameter " + shown(p.name) + " names no file");
  return resolveReference(p.texts[0], context.folder, *p.at.file, p.at.line, false);
}

Rgb colourOr(Context& context, const Entity& entity, std::string_view name, const Rgb& otherwise) {
  const Parameter* p = find(entity, name);
  if (!p) return otherwise;
  if (const auto plain = plainColour(*p)) return *plain;
  if (p->type == "texture") return meanOfTexture(context, *p);
  if (p->type == "blackbody") return blackBody(*p);
  if (p->type != "spectrum") failColour(*p);
  if (const auto spectrum = spectrumOf(context, *p)) return colourOfReflectance(*spectrum);
  ignore(context, "spectra known by name (gray instead)");
  return otherwise;
}

double scalarOr(Context& context, const Entity& entity, std::string_view name, double otherwise) {
  const Parameter* p = find(entity, name);
  return p && p->type == "texture" ? gray(RgbSum(meanOfTexture(context, *p))) : numberOr(entity, name, otherwise);
}

Rgb lightColourOf(Context& context, const Entity& light, std::string_view name) {
  const Parameter* p = find(light, name);
  if (!p) return Rgb(1.0f);
  if (const auto plain = plainColour(*p)) return *plain;
  if (p->type == "blackbody") return blackBody(*p);
  if (p->type != "spectrum") failColour(*p);
  const auto spectrum = spectrumOf(context, *p);
  return spectrum ? colourOfLight(*spectrum) : illuminant(context, p->texts[0]);
}

}  // namespace deltalux::io::pbrt
