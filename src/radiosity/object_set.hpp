#pragma once
// A small set of objects of a scene, told by 128 bits: whether two sets may have one in common. Never false when they
// have. Objects count with all that is in the same top one: what is "container.lid" is of "container".
#include <array>
#include <deltalux/scene.hpp>

#include "base/random.hpp"

namespace deltalux {

class ObjectSet {
 public:
  void add(const Scene& scene, PrimitiveId primitive) {
    ObjectId top = scene[primitive].object;
    while (top.valid() && scene[top].parent.valid()) top = scene[top].parent;
    const std::uint64_t key = mix64(top.value);
    words[key >> 6 & 1] |= std::uint64_t{1} << (key & 63);
  }
  void add(const ObjectSet& more) { words[0] |= more.words[0], words[1] |= more.words[1]; }
  bool meets(const ObjectSet& o) const { return (words[0] & o.words[0]) | (words[1] & o.words[1]); }

  std::array<std::uint64_t, 2> words{};
};

}  // namespace deltalux
