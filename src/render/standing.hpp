#pragma once
// What of a scene can stand between two places, to tell where something has moved since.
#include <deltalux/scene.hpp>
#include <utility>
#include <vector>

#include "base/box_tree.hpp"

namespace deltalux::rendering {

class Standing {
 public:
  Standing() = default;
  explicit Standing(const Scene&);
  /// By primitive: whether it came, went, moved or was changed since.
  std::vector<char> changedSince(const Standing& before) const;
  /// Where these were and are: boxes.
  std::vector<BoxF> movedSince(const Standing& before) const;

 private:
  std::vector<BoxF> boxes_;                           // by primitive
  std::vector<MaterialId> materials_;                 // the same
  std::vector<std::pair<PrimitiveId, Mat4>> placed_;  // ascending
};

}  // namespace deltalux::rendering
