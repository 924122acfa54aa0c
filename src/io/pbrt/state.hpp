#pragma once
// What statements of pbrt set for those that follow, and AttributeBegin and its like keep.
#include <map>
#include <memory>

#include "io/pbrt/entity.hpp"

namespace deltalux::io::pbrt {

/// Defaults of "shape", "light", "material", "medium" and "texture".
using DefaultsOf = std::map<std::string, std::shared_ptr<const Defaults>, std::less<>>;

struct State {
  Mat4 toWorld{1.0};                           // before WorldBegin from there to the camera
  bool transforms = true;                      // those of the start of motion
  bool reversed = false;                       // by ReverseOrientation
  const Entity* material = nullptr;            // diffuse without
  const Entity* areaLight = nullptr;           // none without
  std::shared_ptr<const DefaultsOf> defaults;  // null: none
};

/// A state that waits for its end.
struct Saved {
  enum class By { Attribute, Transform, Object };
  By by = By::Attribute;
  Place at;
  State state;
};

/// A statement's entity of that type, with the defaults of `target`.
Entity takeEntity(Tokens&, const State&, std::string type, std::string_view target);

/// Adds a target's defaults that follow in place of earlier ones. Throws InputError.
void takeDefaults(Tokens&, State&, const Place&);

}  // namespace deltalux::io::pbrt
