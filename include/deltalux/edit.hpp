#pragma once
// Edits: changes of a scene as plain values, with an exact inverse each.
//
// A primitive that an edit moves is built anew from its rest shape (as it was read) under the accumulated map, in
// double precision: however often it moves, its shape depends on where it is and not on the way there. A map that
// returns to the identity within rounding is the identity, so that an edit and the opposite edit give back the very
// same scene. What is removed stays as a surface without extent, so that ids stay good; its lights stay as dark points.
#include <deltalux/daylight.hpp>
#include <deltalux/scene.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace deltalux {

// Matrices are in the coordinates of the scene's files (Scene::origin).

/// Moves an object, all below it, and the lights named after it, by a map applied after their present one.
struct TransformObject {
  std::string object;
  Mat4 matrix{1.0};
};

/// Puts all of a scene file but its sky, sun and views into the scene, as the object `object`. The matrix goes from the
/// coordinates of that file; light keeps its photometric value.
struct AddObject {
  std::string object;
  std::string file;  // where `part` came from, for messages and recordings
  std::shared_ptr<const Scene> part;
  Mat4 matrix{1.0};
};

struct RemoveObject {
  std::string object;
};

/// Multiplies the present scale of a light (and of all lights below its name).
struct ScaleLight {
  std::string light;
  float factor = 1;
};

/// Sets the scale of a light, per channel: 1 1 1 is how it was read.
struct ColourLight {
  std::string light;
  Rgb rgb{1.0f};
};

/// Off, a light keeps its scale for when it is on again.
struct SwitchLight {
  std::string light;
  bool on = true;
};

/// Turns a light that has a direction: spots, measured lights, surfaces with a spot cone, the sun.
struct AimLight {
  std::string light;
  Vec3 direction{0, 0, -1};  // in which it shines; any length
};

/// Moves a light; area lights with their surface.
struct MoveLight {
  std::string light;
  Vec3 offset{0};
};

/// Sets what is given. Reflectance is a mirror's or the diffuse one; of a metal without any diffuse part its lobe's.
struct SetMaterial {
  std::string material;
  std::optional<Rgb> reflectance;
  std::optional<float> roughness;
};

/// Puts the sun and the sky of a daylight over the scene: its first sun and its first sky become them, all others go
/// black. A scene without them gets them as "sun" and "sky".
struct SetDaylight {
  Daylighting daylight;
};

/// Things of a scene in an exact state: what undoing an edit means, and redoing it.
struct Restore {
  struct PrimitiveState {
    PrimitiveId primitive;
    MaterialId material;
    Mat4 matrix{1.0};  // from the rest shape to the scene
    bool present = true;
  };
  struct LightState {
    LightId light;
    Light value;
    std::optional<Rgb> offScale;  // the scale that waits while it is switched off
  };
  struct MaterialState {
    MaterialId material;
    Material value;
  };
  std::vector<PrimitiveState> primitives;
  std::vector<LightState> lights;
  std::vector<MaterialState> materials;
};

using Edit = std::variant<TransformObject, AddObject, RemoveObject, ScaleLight, ColourLight, SwitchLight, AimLight,
                          MoveLight, SetMaterial, SetDaylight, Restore>;

/// What an edit did to a scene.
struct SceneChange {
  struct Moved {
    PrimitiveId primitive;
    Box before, after;  // empty where it is not there
  };
  std::vector<Moved> moved;
  std::vector<LightId> lights;        // sends otherwise, or from elsewhere
  std::vector<MaterialId> materials;  // reflects otherwise
};

struct AppliedEdit {
  SceneChange change;
  Restore inverse;
};

/// Changes the scene, or throws InputError and leaves it as it was: unknown names (with near misses), a curved shape
/// that would be sheared, a property that the thing has not got, or a value that is none. The scene needs its area
/// lights.
AppliedEdit applyEdit(Scene&, const Edit&);
/// applyEdit's errors without its effects.
void validateEdit(const Scene&, const Edit&);

/// "transform", "light" ... as edits files have it, and the name of what is edited (empty for Restore).
std::string editOperation(const Edit&);
std::string editSubject(const Edit&);

/// Applies edits and takes them back, as often as wanted.
class EditHistory {
 public:
  AppliedEdit apply(Scene&, const Edit&);
  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  /// What to apply next, exactly: precondition canUndo().
  AppliedEdit undo(Scene&);
  AppliedEdit redo(Scene&);

 private:
  std::vector<Restore> undo_, redo_;
};

}  // namespace deltalux
