#include "io/pbrt/camera.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::io::pbrt {

std::optional<View> viewOf(Context& context, const Entity& camera, const Entity* film, const Mat4& fromWorld) {
  if (camera.type != "perspective") {
    ignore(context, "camera " + camera.type.substr(0, 40));
    return std::nullopt;
  }
  const double determinant = glm::determinant(glm::dmat3(fromWorld));
  const Mat4 toWorld = glm::inverse(fromWorld);
  View view;
  view.name = "camera0";
  view.position = Vec3(toWorld[3]), view.direction = Vec3(toWorld[2]), view.up = Vec3(toWorld[1]);
  const double sum = glm::dot(view.position, view.position) + glm::dot(view.direction, view.direction);
  if (!std::isfinite(sum) || !(glm::length(glm::cross(view.direction, view.up)) > 0))
    fail(camera.at, "the camera's transforms flatten it");
  if (determinant > 0)
    context.report.warnings.push_back("the scene is left-handed: pbrt's pictures of it are mirrored");

  // pbrt's own, where nothing is said
  double width = 1280, height = 720;
  if (film) width = numberOr(*film, "xresolution", width), height = numberOr(*film, "yresolution", height);
  if (!(width >= 1 && height >= 1)) fail(film->at, "the film has no size");
  const double aspect = numberOr(camera, "frameaspectratio", width / height);
  if (!(aspect >= 1e-3 && aspect <= 1e3)) fail(camera.at, "the picture is too narrow");
  if (find(camera, "screenwindow")) ignore(context, "screenwindow");
  const double fov = std::clamp(numberOr(camera, "fov", 90), 0.1, 179.0);  // of the shorter side
  const double tangent = std::tan(glm::radians(fov) / 2), longer = std::max(aspect, 1 / aspect);
  const double other = 2 * glm::degrees(std::atan(tangent * longer));
  view.horizontal = aspect > 1 ? other : fov;
  view.vertical = aspect > 1 ? fov : other;
  return view;
}

}  // namespace deltalux::io::pbrt
