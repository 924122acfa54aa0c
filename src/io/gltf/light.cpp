#include "io/gltf/light.hpp"

#include <algorithm>
#include <cmath>

#include "io/gltf/extension.hpp"
#include "io/ies.hpp"

namespace deltalux::io {

namespace {

constexpr double kSunRadius = 0.2665 * kPi / 180;  // mean angular radius of the sun's disc from the earth [defined]

SpotLight spotOf(const tinygltf::SpotLight& cone, const Vec3& position, const Vec3& direction, const Rgb& intensity) {
  SpotLight spot{position, direction, intensity};
  const double outer = std::clamp(cone.outerConeAngle, 0.0, kPi / 2);
  spot.cosInner = std::cos(std::clamp(cone.innerConeAngle, 0.0, outer));
  spot.cosOuter = std::cos(outer);
  return spot;
}

}  // namespace

glm::dmat3 rotationOf(const Mat4& toWorld) {
  const glm::dmat3 linear(toWorld);
  const auto isUsable = [](const Vec3& v) {
    const double length = glm::length(v);
    return std::isfinite(length) && length > 1e-150;
  };
  if (!isUsable(linear[0]) || !isUsable(linear[2])) return glm::dmat3(1.0);
  const Vec3 z = glm::normalize(linear[2]);
  const Vec3 across = glm::normalize(linear[0]) - glm::dot(glm::normalize(linear[0]), z) * z;
  if (glm::length(across) < 1e-12) return glm::dmat3(1.0);
  const Vec3 x = glm::normalize(across);
  return {x, glm::cross(z, x), z};
}

Light punctualLight(const tinygltf::Light& light, const Mat4& toWorld, double luminousEfficacy, std::string name) {
  const Vec3 position(toWorld[3]), backwards = rotationOf(toWorld)[2];
  const Rgb color = light.color.size() == 3 ? rgbOf(light.color) : Rgb(1.0f);
  const Rgb radiometric = color * static_cast<float>(light.intensity / luminousEfficacy);
  Light result{std::move(name), PointLight{position, radiometric}};
  if (light.type == "spot") result.emitter = spotOf(light.spot, position, -backwards, radiometric);
  if (light.type == "directional") {
    // A disc of radiance L makes E = pi L sin^2 r on a surface that faces it.
    const double sine = std::sin(kSunRadius);
    result.emitter = SunLight{backwards, kSunRadius, radiometric / static_cast<float>(kPi * sine * sine)};
  }
  return result;
}

std::vector<std::shared_ptr<const Photometry>> readProfiles(const GltfDocument& document,
                                                            std::vector<std::string>& warnings) {
  std::vector<std::shared_ptr<const Photometry>> profiles;
  const tinygltf::Value* extension = extensionOf(document.model.extensions, "EXT_lights_ies");
  if (!extension || !extension->Has("lights")) return profiles;
  const tinygltf::Value& lights = extension->Get("lights");
  for (std::size_t i = 0; i < lights.ArrayLen(); ++i) {
    const tinygltf::Value& profile = lights.Get(static_cast<int>(i));
    const std::string where = "/extensions/EXT_lights_ies/lights/" + std::to_string(i);
    const std::string text =
        profile.Has("uri") ? bytesOfUri(document.name, document.folder, profile.Get("uri").Get<std::string>(), where)
                           : std::string(bytesOfView(document, static_cast<int>(numberOf(&profile, "bufferView", 0))));
    PhotometryFile file = readPhotometry(text, document.name + where, document.folder);
    warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
    profiles.push_back(std::make_shared<const Photometry>(std::move(file.photometry)));
  }
  return profiles;
}

Light measuredLight(const tinygltf::Value& instance, const std::vector<std::shared_ptr<const Photometry>>& profiles,
                    const Mat4& toWorld, double luminousEfficacy, std::string name) {
  PhotometricLight light;
  light.position = Vec3(toWorld[3]);
  light.frame = rotationOf(toWorld);
  light.photometry = profiles[static_cast<std::size_t>(numberOf(&instance, "light", 0))];
  light.scale = rgbOf(numbersOf(&instance, "color", {1, 1, 1})) *
                static_cast<float>(numberOf(&instance, "multiplier", 1) * kLuminousEfficacy / luminousEfficacy);
  return {std::move(name), std::move(light)};
}

View viewOf(const tinygltf::Camera& camera, const Mat4& toWorld, std::string name) {
  const glm::dmat3 rotation = rotationOf(toWorld);
  View view;
  view.name = std::move(name);
  view.position = Vec3(toWorld[3]);
  view.direction = -rotation[2];
  view.up = rotation[1];
  if (camera.type == "orthographic") {
    view.kind = View::Kind::Parallel;
    view.horizontal = std::max(2 * std::abs(camera.orthographic.xmag), 1e-9);
    view.vertical = std::max(2 * std::abs(camera.orthographic.ymag), 1e-9);
    return view;
  }
  const double aspect = camera.perspective.aspectRatio > 0 ? camera.perspective.aspectRatio : 16.0 / 9;
  const double half = std::tan(camera.perspective.yfov / 2);
  view.vertical = camera.perspective.yfov * 180 / kPi;
  view.horizontal = 2 * std::atan(aspect * half) * 180 / kPi;
  return view;
}

}  // namespace deltalux::io
