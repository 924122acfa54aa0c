#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace deltalux::viewer {

namespace {

constexpr double kSteepest = glm::radians(89.0);  // of the view direction above or below the horizon

/// The camera's own axes, unit.
struct CameraAxes {
  Vec3 right, upward, forward;
};

CameraAxes axesOf(const View& view) {
  const Vec3 forward = glm::normalize(view.direction);
  const Vec3 right = glm::normalize(glm::cross(forward, view.up));
  return {right, glm::cross(right, forward), forward};
}

/// Half of what the picture shows: at unit distance, or in scene units (parallel).
Vec2 halfSize(const View& view) {
  if (view.kind == View::Kind::Parallel) return {view.horizontal / 2, view.vertical / 2};
  return {std::tan(glm::radians(view.horizontal) / 2), std::tan(glm::radians(view.vertical) / 2)};
}

void setHalfSize(View& view, const Vec2& half) {
  if (view.kind == View::Kind::Parallel)
    view.horizontal = 2 * half.x, view.vertical = 2 * half.y;
  else
    view.horizontal = 2 * glm::degrees(std::atan(half.x)), view.vertical = 2 * glm::degrees(std::atan(half.y));
}

glm::dmat3 rotation(double angle, const Vec3& axis) { return glm::dmat3(glm::rotate(Mat4(1.0), angle, axis)); }

/// The pitch that may still be turned by without passing straight up or down.
double allowedPitch(const View& view, double pitch) {
  const double now =
      std::asin(std::clamp(glm::dot(glm::normalize(view.direction), glm::normalize(view.up)), -1.0, 1.0));
  // A view that is steeper to begin with may come down, and not go on.
  return std::clamp(now + pitch, std::min(-kSteepest, now), std::max(kSteepest, now)) - now;
}

/// Yaw about `up`, then pitch about what is to the right.
glm::dmat3 turning(const View& view, double yaw, double pitch) {
  return rotation(yaw, glm::normalize(view.up)) * rotation(allowedPitch(view, pitch), axesOf(view).right);
}

}  // namespace

bool sameView(const View& a, const View& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction && a.up == b.up &&
         a.horizontal == b.horizontal && a.vertical == b.vertical;
}

void turn(View& view, double yaw, double pitch) { view.direction = turning(view, yaw, pitch) * view.direction; }

void move(View& view, const Vec3& rightForwardUp, bool level) {
  CameraAxes axes = axesOf(view);
  if (level) {
    axes.upward = glm::normalize(view.up);
    axes.forward = glm::cross(axes.upward, axes.right);
  }
  view.position += rightForwardUp.x * axes.right + rightForwardUp.y * axes.forward + rightForwardUp.z * axes.upward;
}

void orbit(View& view, const Vec3& about, double yaw, double pitch) {
  const glm::dmat3 turned = turning(view, yaw, pitch);
  view.position = about + turned * (view.position - about);
  view.direction = turned * view.direction;
}

void dolly(View& view, const Vec3& towards, double factor) {
  if (view.kind == View::Kind::Parallel) {  // distance does not show: the picture is scaled about the point
    const CameraAxes axes = axesOf(view);
    const Vec3 beside = (view.position - towards) - glm::dot(view.position - towards, axes.forward) * axes.forward;
    view.position += (factor - 1) * beside;
    view.horizontal *= factor, view.vertical *= factor;
    return;
  }
  view.position = towards + factor * (view.position - towards);
}

void focus(View& view, const Box& box) {
  if (box.empty()) return;
  const CameraAxes axes = axesOf(view);
  const double radius = std::max(0.5 * box.diagonal(), 1e-6);
  const Vec2 half = halfSize(view);
  const double least = std::min(half.x, half.y);
  double distance = 2 * radius;
  if (view.kind == View::Kind::Parallel)
    setHalfSize(view, half * (radius / least));
  else
    distance = radius / std::sin(std::atan(least));  // the sphere about the box touches the nearer edges
  view.position = box.center() - distance * axes.forward;
}

View fitted(View view, int width, int height) {
  if (width <= 0 || height <= 0) return view;
  Vec2 half = halfSize(view);
  const double largest = std::max(half.x, half.y), larger = std::max(width, height);
  half = {largest * width / larger, largest * height / larger};
  setHalfSize(view, half);
  return view;
}

ViewRay rayThrough(const View& view, int width, int height, double x, double y) {
  return viewRay(view, x / width, y / height);
}

Vec3 project(const View& view, int width, int height, const Vec3& p) {
  const CameraAxes axes = axesOf(view);
  const Vec3 to = p - view.position;
  const double depth = glm::dot(to, axes.forward);
  const Vec2 half = halfSize(view) * (view.kind == View::Kind::Parallel ? 1.0 : depth);
  return {0.5 * width * (1 + glm::dot(to, axes.right) / half.x),
          0.5 * height * (1 - glm::dot(to, axes.upward) / half.y), depth};
}

View firstView(const Scene& scene) {
  constexpr double kEyeHeight = 1.6;  // metres
  View view;
  view.horizontal = 60, view.vertical = 45;
  view.up = glm::normalize(scene.up);
  const Box box = bounds(scene);
  if (box.empty()) return view;
  // A tenth inwards from the corner with the least coordinates.
  view.position = box.lower + 0.1 * box.extent();
  const double floor = glm::dot(box.lower, glm::abs(view.up)), height = glm::dot(box.extent(), glm::abs(view.up));
  const double eye = floor + std::min(kEyeHeight / scene.metresPerUnit, 0.5 * height);
  view.position += (eye - glm::dot(view.position, view.up)) * view.up;
  view.direction = box.center() - view.position;
  const Vec3 sideways = view.direction - glm::dot(view.direction, view.up) * view.up;
  if (!(glm::length(sideways) > 1e-6 * box.diagonal())) view.direction = Frame(view.up).tangent;
  return view;
}

}  // namespace deltalux::viewer
