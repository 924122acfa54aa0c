#pragma once
// An edit, thought through before anything changes: what is appended to the scene, and the state to put things in.
#include <deltalux/edit.hpp>

namespace deltalux::scene::edits {

struct Plan {
  std::vector<Texture> textures;  // appended, in order
  std::vector<Material> materials;
  std::vector<Primitive> primitives;     // rest shapes; `object` is not set yet
  std::vector<std::string> objectNames;  // one per new primitive
  std::vector<Light> lights;
  Restore target;
};

Plan plan(const Scene&, const TransformObject&);
Plan plan(const Scene&, const AddObject&);
Plan plan(const Scene&, const RemoveObject&);
Plan plan(const Scene&, const ScaleLight&);
Plan plan(const Scene&, const ColourLight&);
Plan plan(const Scene&, const SwitchLight&);
Plan plan(const Scene&, const AimLight&);
Plan plan(const Scene&, const MoveLight&);
Plan plan(const Scene&, const SetMaterial&);
Plan plan(const Scene&, const SetDaylight&);
Plan plan(const Scene&, const Restore&);

/// Present states, as a Restore would have them.
Restore::PrimitiveState stateOf(const Scene&, PrimitiveId);
Restore::LightState stateOf(const Scene&, LightId);
/// The rest shape of a primitive: the present one where no edit has been.
const Shape& restShape(const Scene&, PrimitiveId);
/// What stands for a primitive that was removed: a surface without extent.
Shape removedShape();
/// Whether a light is one that sends nothing at all, as those of removed surfaces are.
bool isDark(const Light&);
/// The rest shape under the state's map. Throws InputError where that is no shape of its kind.
Shape shapeOf(const Scene&, const Restore::PrimitiveState&, const Shape& rest);
/// `matrix`, or the identity when it is that within the rounding of coordinates in the scene's files.
Mat4 withoutRounding(const Mat4& matrix, const Scene&);
/// A map between coordinates of files as one between coordinates relative to `from` and `to`.
Mat4 between(const Mat4& matrix, const Vec3& from, const Vec3& to);

/// Adds to the plan that `primitive` moves by `matrix` (of the scene), with the cone of its spot, if it has one.
void planMove(Plan&, const Scene&, PrimitiveId, const Mat4& matrix);
/// The same for a light at a place that is no surface.
Light movedLight(const Light&, const Mat4& matrix);

/// What a name means, or an InputError with near misses.
std::vector<ObjectId> objectsNamed(const Scene&, const std::string&);
std::vector<LightId> lightsNamed(const Scene&, const std::string&);
std::vector<MaterialId> materialsNamed(const Scene&, const std::string&);

[[noreturn]] void refuse(const std::string& message, const std::string& hint = {});

}  // namespace deltalux::scene::edits
