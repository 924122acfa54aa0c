#pragma once
// What edits since the last update come to, for the solution: surfaces and lights that moved, with their bounds before;
// lights and materials that are otherwise where they were.
#include <deltalux/edit.hpp>

#include "hierarchy/element.hpp"

namespace deltalux::engine {

struct SceneUpdate {
  SceneChange whole;  // of all edits, one after the other
  std::vector<SceneChange::Moved> moved;
  std::vector<LightId> movedLights;  // stand or aim elsewhere
  std::vector<LightId> dimmed;       // send another power
  std::vector<MaterialId> materials;
  std::string op, subject;

  /// What came later.
  void add(const SceneUpdate&);
  /// Those that moved.
  std::vector<PrimitiveId> primitives() const;
  /// Nothing but lights that send another power, if those.
  bool dimsAlone() const { return moved.empty() && movedLights.empty() && materials.empty(); }
  bool empty() const { return dimsAlone() && dimmed.empty(); }
};

/// The same where of all the places that something has been at only the first and the last count.
SceneUpdate endToEnd(SceneUpdate);

/// Whether all lights of the edits have elements to send from: new ones have none. Surfaces can get theirs
/// (growth.hpp).
bool haveElements(const hierarchy::Elements&, const Scene&, const SceneUpdate&);

/// By light: whether it stands or aims elsewhere by these edits, or came with them.
std::vector<char> lightsThatMoved(const Scene&, const SceneUpdate&);

/// Input-level patches of surfaces of these materials, lamps left out.
std::vector<hierarchy::ElementId> paintedSurfaces(const hierarchy::Elements&, const Scene&,
                                                  std::span<const MaterialId>);

/// Applies the edit, adds what it did, and returns its inverse.
Restore applyInto(SceneUpdate&, Scene&, const Edit&);

}  // namespace deltalux::engine
