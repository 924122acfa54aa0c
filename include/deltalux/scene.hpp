#pragma once
// A scene as plain values: what there is, not how it is solved.
#include <deltalux/ids.hpp>
#include <deltalux/light.hpp>
#include <deltalux/material.hpp>
#include <deltalux/shape.hpp>
#include <deltalux/view.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux {

struct Primitive {
  Shape shape;  // in world coordinates
  MaterialId material;
  ObjectId object;
};

/// A name in the object tree: in .rad every dot-separated prefix of an identifier, in glTF a node (path with '/').
struct Object {
  std::string name;  // full name: "dresser.drawer.0", "house/kitchen/lamp"
  ObjectId parent;   // invalid at the top
};

/// Linear RGB texture with repeat wrapping; texels row by row from the top (v = 0), as glTF has it.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<Rgb> texels;

  /// Bilinear lookup.
  Rgb sample(Vec2 texcoord) const;
};

/// Where edits have put a primitive: its shape as it was read, and the map from there to the world.
struct Placement {
  PrimitiveId primitive;
  Shape rest;
  Mat4 matrix{1.0};
  bool present = true;  // false: removed, its shape has no extent
};

/// A light that is switched off: its scale is 0, and this waits.
struct SwitchedOff {
  LightId light;
  Rgb scale{1.0f};
};

/// Positions are relative to `origin`: single precision, in which rays run, has no digits for a site's coordinates of
/// millions. Files have `origin` added: it is subtracted where they are read (io.hpp, points.hpp, edits), and added
/// where they are written.
struct Scene {
  double metresPerUnit = 1.0;
  Vec3 origin{0};                               // in the coordinates of the scene's files
  double luminousEfficacy = kLuminousEfficacy;  // by which it was read, and its light is told [lm/W]
  Vec3 up{0, 0, 1};
  std::vector<Material> materials;
  std::vector<Primitive> primitives;
  std::vector<Object> objects;
  std::vector<Light> lights;
  std::vector<DomeLight> backdrops;  // at infinity, seen by cameras and in mirrors, but sending no light
  std::vector<Texture> textures;
  std::vector<View> views;
  std::vector<Placement> placements;     // of primitives that were edited, ascending (edit.hpp)
  std::vector<SwitchedOff> switchedOff;  // by edits

  const Primitive& operator[](PrimitiveId id) const { return primitives[id.index()]; }
  const Material& operator[](MaterialId id) const { return materials[id.index()]; }
  const Object& operator[](ObjectId id) const { return objects[id.index()]; }
  const Light& operator[](LightId id) const { return lights[id.index()]; }
  const Material& materialOf(PrimitiveId id) const { return materials[primitives[id.index()].material.index()]; }
};

/// Finds or makes the object `name` and all its prefixes split at `separator`.
ObjectId internObject(Scene&, std::string_view name, char separator);

/// Objects that `name` means: the object of that full name, else (glTF) every node whose last path part it is.
std::vector<ObjectId> findObjects(const Scene&, std::string_view name);
/// Every primitive of the object and of the objects below it, ascending.
std::vector<PrimitiveId> primitivesOf(const Scene&, ObjectId);
/// Lights that `name` means: the light of that name and every `name.*`.
std::vector<LightId> findLights(const Scene&, std::string_view name);
/// Up to `count` existing names nearest to `name` by edit distance, for error messages.
std::vector<std::string> nearMisses(std::string_view name, const std::vector<std::string>& existing,
                                    std::size_t count = 3);

/// Bounds of all primitives (lights at infinity have none).
Box bounds(const Scene&);
/// Moves the scene's origin there, exactly as double precision has it; what the scene describes stays where it is.
void moveOrigin(Scene&, const Vec3& origin);
/// The origin that a scene wants: 0 as long as its coordinates are not large beside its extent, else a point in its
/// middle with few binary digits, so that subtracting it is exact.
Vec3 fittingOrigin(const Scene&);
/// A view in the coordinates of the scene's files as one in the scene's own.
View inScene(const Scene&, View);
/// Appends an AreaLight for every primitive that sends light and has none yet.
void addAreaLights(Scene&);

/// Checks every reference and number of the scene (ids in range, finite values, reflectances in [0,1], unit
/// directions); throws std::logic_error with the first thing that does not hold.
void validate(const Scene&);

}  // namespace deltalux
