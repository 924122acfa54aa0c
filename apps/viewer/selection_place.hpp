#pragma once
// Where in the scene the thing is that is selected.
#include <deltalux/scene.hpp>
#include <optional>
#include <string>
#include <vector>

namespace deltalux::viewer {

struct SelectionPlace {
  Box box;                              // of its surfaces and lamps
  glm::dmat3 axes{1.0};                 // its own, as edits have turned it; unit columns
  std::vector<PrimitiveId> primitives;  // ascending
  std::vector<LightId> lights;
};

/// nullopt: there is no such thing, or it is nowhere, as the sky.
std::optional<SelectionPlace> placeOf(const Scene&, const std::string& objectOrLight);

}  // namespace deltalux::viewer
