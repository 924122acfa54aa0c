#include "io/pbrt/textures.hpp"

#include <algorithm>
#include <deltalux/image_io.hpp>

#include "io/import_file.hpp"
#include "io/import_texture.hpp"
#include "io/lower_case.hpp"

namespace deltalux::io::pbrt {

namespace {

/// The mean of an image's file; gray for one of a format that is not read.
Rgb meanOfImage(Context& context, const Entity& texture) {
  const Parameter* file = find(texture, "filename");
  if (!file) fail(texture.at, "the texture names no file");
  const std::filesystem::path path = fileOf(context, *file);
  const std::string extension = lowerCase(path.extension().string());
  if (extension == ".exr" || extension == ".hdr") {
    const Image image = loadImage(path);
    RgbSum sum(0);
    for (const Rgb& pixel : image.pixels) sum += RgbSum(glm::max(pixel, Rgb(0.0f)));
    return image.pixels.empty() ? Rgb(0.0f) : Rgb(sum / static_cast<double>(image.pixels.size()));
  }
  const bool linear = textOr(texture, "encoding", "sRGB") == "linear";
  const auto decoded =
      decodeTexture(readInputFile(path), path.string(), linear ? TexelEncoding::Linear : TexelEncoding::Srgb);
  if (decoded) return average(*decoded);
  ignore(context, "images of formats that are not read (gray instead)");
  return Rgb(0.5f);
}

Rgb meanOf(Context& context, const Entity& texture) {
  const auto part = [&](std::string_view name, float otherwise) {
    return colourOr(context, texture, name, Rgb(otherwise));
  };
  const std::string& kind = texture.type;
  if (kind == "constant") return part("value", 1);
  if (kind == "scale") return part("tex", 1) * part("scale", 1);
  if (kind == "mix")
    return glm::mix(part("tex1", 0), part("tex2", 1), glm::clamp(part("amount", 0.5f), Rgb(0.0f), Rgb(1.0f)));
  ignore(context, "textures (average used)");
  if (kind == "imagemap") {
    const Rgb mean = meanOfImage(context, texture);
    const Rgb shown = flagOr(texture, "invert", false) ? glm::max(Rgb(1.0f) - mean, Rgb(0.0f)) : mean;
    return shown * static_cast<float>(std::max(numberOr(texture, "scale", 1), 0.0));
  }
  if (kind == "checkerboard") return 0.5f * (part("tex1", 1) + part("tex2", 0));
  if (kind == "bilerp") return 0.25f * (part("v00", 0) + part("v01", 1) + part("v10", 0) + part("v11", 1));
  ignore(context, "texture " + kind.substr(0, 40) + " (gray instead)");
  return Rgb(0.5f);
}

}  // namespace

Rgb meanOfTexture(Context& context, const Parameter& parameter) {
  constexpr int kDeepest = 32;    // of textures made of textures [limit]
  constexpr float kMost = 1e15f;  // of a texture's mean [limit]
  if (parameter.texts.size() != 1) fail(parameter.at, "the parameter " + shown(parameter.name) + " names no texture");
  auto found = context.textures.find("spectrum " + parameter.texts[0]);
  if (found == context.textures.end()) found = context.textures.find("float " + parameter.texts[0]);
  if (found == context.textures.end())
    fail(parameter.at, "the texture " + shown(parameter.texts[0]) + " is not defined");
  NamedTexture& texture = found->second;
  if (texture.mean) return *texture.mean;
  if (context.textureDepth >= kDeepest) fail(parameter.at, "textures are made of each other without an end");
  ++context.textureDepth;
  texture.mean = glm::min(meanOf(context, texture.definition), Rgb(kMost));
  --context.textureDepth;
  return *texture.mean;
}

}  // namespace deltalux::io::pbrt
