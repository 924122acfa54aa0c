#pragma once
// The modifiers of a scene by name, resolved as they are defined: a name means its last definition before the use.
#include <deltalux/io.hpp>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

struct Mixture;

/// What a modifier amounts to at the end of its chain of patterns, textures, mixtures and aliases.
struct Modifier {
  MaterialId material;                     // invalid: none, or an unsupported one
  Type materialType = Type::Plastic;       // as defined
  std::string unsupported;                 // type word of the unsupported material that ends the chain
  std::vector<const RadObject*> patterns;  // on the way
  std::shared_ptr<const Mixture> mixture;  // at the end of it; `material` is that of one of its parts then
};

/// A mixfunc of two modifiers.
struct Mixture {
  const RadObject* object;
  Modifier first, second;
};

class ModifierTable {
 public:
  ModifierTable(Scene& scene, ImportReport& report) : scene_(scene), report_(report) {}

  /// Takes a definition; the object must outlive the table. Throws InputError for undefined references.
  void define(const RadObject&);
  using Asked = std::function<bool(const RadObject&)>;
  /// Counts the patterns that had no effect, by which a light took and which a surface.
  void noteUnread(const Asked& byLights, const Asked& bySurfaces);
  /// The modifier of `object` ("void" is an empty one). Throws InputError when it is not defined.
  Modifier modifierOf(const RadObject& object) const { return lookUp(object.modifier, object); }

 private:
  struct Made {
    const RadObject* source;
    MaterialId alternate, material;
  };

  Modifier lookUp(const std::string& name, const RadObject& user) const;
  Modifier resolve(const RadObject&);
  Modifier patterned(Modifier, const Modifier& base);
  void noteSimplifications(const RadObject&);
  MaterialId alternateOf(const RadObject&) const;
  MaterialId materialFor(const RadObject&);

  Scene& scene_;
  ImportReport& report_;
  std::unordered_map<std::string, Modifier> byName_;
  std::vector<const RadObject*> patterns_;                   // as defined, those of skies aside
  std::unordered_set<const RadObject*> onSurfaces_;          // patterns of what does not emit
  std::unordered_map<std::string, std::vector<Made>> made_;  // equal definitions of a name share one material
};

}  // namespace deltalux::io::radiance
