#pragma once
// One object of a Radiance scene description as the file has it: `modifier type name` and its arguments.
// [Radiance reference manual, "Scene description"]
#include <deltalux/error.hpp>
#include <deltalux/math.hpp>
#include <deltalux/shape.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io::radiance {

/// Where something stands, for error messages.
struct SourceLine {
  std::shared_ptr<const std::string> file;
  int line = 0;
};

/// An InputError at `where`.
InputError inputError(const SourceLine& where, std::string message, std::string hint = {});

enum class Type {
  // surfaces
  Polygon,
  Sphere,
  Bubble,
  Cylinder,
  Tube,
  Cone,
  Cup,
  Ring,
  Source,
  Instance,
  Mesh,
  GeneratedMesh,  // a smoothed surface of gensurf; its triangles are in RadObject::mesh
  // materials
  Plastic,
  Metal,
  Plastic2,
  Metal2,
  Trans,
  Trans2,
  Glass,
  Dielectric,
  Mirror,
  Light,
  Glow,
  Illum,
  Spotlight,
  Unsupported,  // a material of Radiance that has no counterpart here
  Alias,
  SkyBrightness,    // brightfunc skybr skybright.cal
  PerezBrightness,  // brightfunc skybright perezlum.cal
  // patterns, textures and mixtures: lights get the patterns that can be evaluated; else the modifier alone counts
  Pattern,
  Mixture
};

struct RadObject {
  Type type = Type::Polygon;
  std::string typeName;  // as written: "polygon", "brightfunc"
  std::string modifier;
  std::string name;
  std::vector<std::string> strings;
  std::vector<double> reals;
  std::shared_ptr<const Mesh> mesh;     // GeneratedMesh only
  std::shared_ptr<const Mat4> toWorld;  // Pattern only: of the xforms around it; null: none
  SourceLine where;
};

bool isSurface(Type);
/// Whether it is a pattern that says how bright the sky is.
bool isSkyPattern(const RadObject&);

/// The type that `word` names, or nullopt for a word that is no type of Radiance.
std::optional<Type> typeNamed(std::string_view word);
/// The word that names a type of surface, material or alias.
std::string nameOf(Type);
/// All words that name types, for near misses.
std::vector<std::string> typeNames();

/// Throws InputError unless the numbers of string and real arguments fit the type.
void checkArgumentCounts(const RadObject&);

}  // namespace deltalux::io::radiance
