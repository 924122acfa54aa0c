#include <fmt/format.h>

#include <deltalux/io.hpp>

namespace deltalux {

namespace {

/// Aimed against the scene's up, the 0 plane along +x, or along +y where up is x.
glm::dmat3 hangingFrame(const Vec3& up) {
  const Vec3 axis = glm::normalize(up);
  const Vec3 hint = std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 zeroPlane = glm::normalize(hint - glm::dot(hint, axis) * axis);
  return {zeroPlane, glm::cross(axis, zeroPlane), axis};
}

/// The file's name, made different from every light's: "flood", "flood-2" ...
std::string freeLightName(const Scene& scene, const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::string name = stem;
  for (int i = 2; !findLights(scene, name).empty(); ++i) name = fmt::format("{}-{}", stem, i);
  return name;
}

}  // namespace

void addLuminaire(Scene& scene, const Luminaire& luminaire) {
  PhotometricLight light;
  light.position = luminaire.position - scene.origin;
  light.frame = hangingFrame(scene.up);
  light.photometry = std::make_shared<const Photometry>(loadPhotometry(luminaire.file));
  // I / d^2 is W/m2 for d in metres; transport measures d in scene units. Candelas become watts as the scene's own did.
  light.scale =
      Rgb(static_cast<float>(kLuminousEfficacy / scene.luminousEfficacy / (scene.metresPerUnit * scene.metresPerUnit)));
  scene.lights.push_back({freeLightName(scene, luminaire.file), std::move(light), Rgb(1.0f)});
}

}  // namespace deltalux
