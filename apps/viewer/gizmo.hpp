#pragma once
// Handles that move and turn what is selected: three axes, three planes and three rings about a centre. Plain functions
// from rays through pixels to maps; nothing here knows a window.
#include <deltalux/math.hpp>
#include <deltalux/view.hpp>
#include <optional>
#include <vector>

namespace deltalux::viewer {

enum class Handle { None, MoveX, MoveY, MoveZ, MoveYZ, MoveZX, MoveXY, TurnX, TurnY, TurnZ };
inline constexpr Handle kHandles[] = {Handle::MoveX,  Handle::MoveY, Handle::MoveZ, Handle::MoveYZ, Handle::MoveZX,
                                      Handle::MoveXY, Handle::TurnX, Handle::TurnY, Handle::TurnZ};

/// 0, 1 or 2: the axis along which a handle moves, about which it turns, or across which its plane lies.
int axisOf(Handle);
bool moves(Handle);       // along an axis or in a plane
bool movesAlong(Handle);  // along an axis

/// Where the handles are.
struct Gizmo {
  Vec3 centre{0};
  glm::dmat3 axes{1.0};  // columns: unit vectors
  double size = 1;       // of an axis [scene units]
};

/// Of a size that looks the same at every distance.
Gizmo gizmoAt(const Vec3& centre, const glm::dmat3& axes, const View&);

/// How a handle is drawn: a line through these points; planes and rings are closed.
std::vector<Vec3> outline(const Gizmo&, Handle);
/// The handle within `reach` pixels of a pixel, the nearest; None.
Handle handleAt(const Gizmo&, const View&, int width, int height, double x, double y, double reach);

/// Steps in which a drag moves on; 0: any amount.
struct Snap {
  double length = 0;   // [scene units]
  double degrees = 0;  // of a turn
};

/// What a drag has come to.
struct GizmoDrag {
  Mat4 matrix{1.0};  // from where it began, in the coordinates of the gizmo
  Vec3 offset{0};    // moved by, along the gizmo's axes [scene units]
  double degrees = 0;
};

/// From the ray on which a handle was taken hold of to the ray where it is now. nullopt where the second says nothing:
/// it never meets the handle's plane, or runs along the handle's axis.
std::optional<GizmoDrag> dragged(const Gizmo&, Handle, const ViewRay& from, const ViewRay& to, const Snap&);

/// The map that turns about an axis through a point [degrees].
Mat4 rotationAbout(const Vec3& point, const Vec3& axis, double degrees);
/// The same map in the coordinates of a scene's files (Scene::origin).
Mat4 inFiles(const Mat4& inScene, const Vec3& origin);

/// How far along a line the point is that is nearest to a ray [units of `direction`]; nullopt where they are parallel.
std::optional<double> alongLine(const ViewRay&, const Vec3& point, const Vec3& direction);
/// Where a ray meets a plane, in front of its origin.
std::optional<Vec3> onPlane(const ViewRay&, const Vec3& point, const Vec3& normal);

}  // namespace deltalux::viewer
