#include "frame_lines.hpp"

#include <algorithm>

#include "lamps.hpp"

namespace deltalux::viewer {

namespace {

const glm::vec4 kLampColour(1.0f, 0.85f, 0.3f, 1.0f), kSurfaceColour(0.4f, 0.8f, 1.0f, 1.0f),
    kPathColour(1.0f, 0.45f, 0.7f, 1.0f), kMeterColour(0.3f, 1.0f, 0.5f, 1.0f);

/// As opaque as its share of the strongest, and never quite gone.
glm::vec4 faded(glm::vec4 colour, double E, double strongest) {
  constexpr double kFaintest = 0.2;
  colour.a = static_cast<float>(strongest > 0 ? std::clamp(E / strongest, kFaintest, 1.0) : 1.0);
  return colour;
}

template <class Senders>
double strongestOf(const Senders& senders) {
  double most = 0;
  for (const auto& s : senders) most = std::max(most, gray(s.E));
  return most;
}

}  // namespace

void addExplanation(std::vector<Line>& lines, const Scene& scene, const ProbePoint& point, const Contributions& why,
                    bool paths) {
  const double most = std::max({strongestOf(why.lamps), strongestOf(why.surfaces), strongestOf(why.paths)});
  const Vec3f here(point.position);
  for (const Contributions::Lamp& lamp : why.lamps)
    if (const std::optional<Vec3> place = placeOf(scene, lamp.light))
      lines.push_back({Vec3f(*place), here, faded(kLampColour, gray(lamp.E), most), true});
  for (const Contributions::Surface& surface : why.surfaces)
    lines.push_back({Vec3f(surface.centre), here, faded(kSurfaceColour, gray(surface.E), most), true});
  if (!paths) return;
  for (const Contributions::Path& path : why.paths)
    for (std::size_t i = 0; i + 1 < path.corners.size(); ++i)
      lines.push_back(
          {Vec3f(path.corners[i]), Vec3f(path.corners[i + 1]), faded(kPathColour, gray(path.E), most), true});
}

void addMeter(std::vector<Line>& lines, const ProbePoint& point, double size) {
  const deltalux::Frame axes(point.normal);
  const Vec3 at = point.position;
  lines.push_back({Vec3f(at), Vec3f(at + size * axes.normal), kMeterColour, true});
  for (const Vec3& side : {axes.tangent, axes.bitangent})
    lines.push_back({Vec3f(at - 0.5 * size * side), Vec3f(at + 0.5 * size * side), kMeterColour, true});
}

void addField(std::vector<Line>& lines, const MeterField& field) {
  const auto at = [&](double u, double v) { return Vec3f(field.corner + u * field.across + v * field.along); };
  for (int i = 0; i <= field.columns; ++i) {
    const double u = double(i) / field.columns;
    lines.push_back({at(u, 0), at(u, 1), kMeterColour, false});
  }
  for (int j = 0; j <= field.rows; ++j) {
    const double v = double(j) / field.rows;
    lines.push_back({at(0, v), at(1, v), kMeterColour, false});
  }
}

}  // namespace deltalux::viewer
