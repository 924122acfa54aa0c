#pragma once
// How hands move the camera: walking, orbiting about the point under the cursor, flying. Plain functions over a View.
#include <deltalux/scene.hpp>
#include <deltalux/view.hpp>

namespace deltalux::viewer {

/// Whether both show the same, whatever their names.
bool sameView(const View&, const View&);
/// Turns the camera in place [radians]; positive yaw to the left, positive pitch upwards, which stays short of straight
/// up and down.
void turn(View&, double yaw, double pitch);
/// Moves it along its own axes, or with `level` forward in the horizontal plane and up along the scene's `up` [units].
void move(View&, const Vec3& rightForwardUp, bool level);
/// Turns it about a point, which stays where it is in the picture.
void orbit(View&, const Vec3& about, double yaw, double pitch);
/// Moves it towards a point: factor 0.5 halves the distance.
void dolly(View&, const Vec3& towards, double factor);
/// Keeps the direction, so that the box fills the picture.
void focus(View&, const Box&);
/// Angles that fit a window: the larger side keeps its angle, pixels stay square.
View fitted(View, int width, int height);
/// The ray through a pixel, from the top left.
ViewRay rayThrough(const View&, int width, int height, double x, double y);
/// Where a point appears [pixels]; z is the depth along the view direction, negative behind the camera.
Vec3 project(const View&, int width, int height, const Vec3& p);
/// A first view of a scene without any: from a corner of its bounds, at eye height, towards the middle.
View firstView(const Scene&);

}  // namespace deltalux::viewer
