#include "grid_place.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace deltalux::cli {

namespace {

constexpr double kRight = 1e-4;  // cosine between sides at right angles at most

/// In the coordinates of the scene's files.
GridArea areaIn(const std::string& text) {
  std::array<double, 9> n{};
  char rest = 0;
  const int count = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &n[3],
                                &n[4], &n[5], &n[6], &n[7], &n[8], &rest);
  const GridArea area{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
  const double u = glm::length(area.u), v = glm::length(area.v);
  if (count != 9 || !std::isfinite(u + v + glm::length(area.corner)))
    throw CLI::ValidationError("--area " + text + ": not X,Y,Z,UX,UY,UZ,VX,VY,VZ (a corner and two sides)");
  if (!(u > 0 && v > 0) || std::abs(glm::dot(area.u, area.v)) > kRight * u * v)
    throw CLI::ValidationError("--area " + text + ": its sides are not at right angles");
  return area;
}

}  // namespace

void GridPlace::validate() const {
  if (area_.empty() == surface_.empty()) throw CLI::ValidationError("say where: either --area or --surface");
  if (!area_.empty()) areaIn(area_);
}

MeasuringGrid GridPlace::grid(const Scene& scene) const {
  if (!surface_.empty()) return gridOn(scene, surface_, settings);
  GridArea area = areaIn(area_);
  area.corner -= scene.origin;
  return gridOf(area, scene.metresPerUnit, settings);
}

void GridPlace::add(CLI::App& app) {
  app.add_option("--surface", surface_, "On that object's largest level polygon or disc, or its largest")->type_name("NAME");
  app.add_option("--area", area_,
                 "On a rectangle: a corner, and two sides at right angles; measured where U x V points")
      ->type_name("X,Y,Z,UX,UY,UZ,VX,VY,VZ");
  app.add_option("--spacing", settings.spacing, "Distance of points at most, in place of the standard's [m]")
      ->check(CLI::PositiveNumber)
      ->type_name("M");
  app.add_option("--border", settings.border, "Left out along the rim, but no more than 15 % of the shorter side [m]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("M")
      ->capture_default_str();
}

}  // namespace deltalux::cli
