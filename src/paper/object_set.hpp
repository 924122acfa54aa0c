#pragma once
// A set of objects of a scene, told by 1024 bits, of which each object has four: whether it may hold one (a Bloom
// filter). Never false when it does. The rays of a row meet and lead to as many as a hundred objects in a large scene:
// then it is true for one in a hundred others. Objects count with all that is in the same top one: what is
// "container.lid" is of "container". Cost: 128 bytes.
#include <array>
#include <deltalux/scene.hpp>

#include "base/random.hpp"

namespace deltalux::paper {

class ObjectSet {
 public:
  static ObjectId top(const Scene& scene, PrimitiveId primitive) {
    ObjectId top = scene[primitive].object;
    while (top.valid() && scene[top].parent.valid()) top = scene[top].parent;
    return top;
  }

  void add(ObjectId top) {
    std::uint64_t key = mix64(top.value);
    for (int i = 0; i < kBits; ++i, key >>= 10) words[key >> 6 & 15] |= std::uint64_t{1} << (key & 63);
  }
  void add(const Scene& scene, PrimitiveId primitive) { add(top(scene, primitive)); }
  void add(const ObjectSet& more) {
    for (std::size_t i = 0; i < words.size(); ++i) words[i] |= more.words[i];
  }
  /// Of a set of one object: whether it may be in this one.
  bool holds(const ObjectSet& one) const {
    std::uint64_t missing = 0;
    for (std::size_t i = 0; i < words.size(); ++i) missing |= one.words[i] & ~words[i];
    return missing == 0;
  }

  bool operator==(const ObjectSet&) const = default;

  std::array<std::uint64_t, 16> words{};

 private:
  static constexpr int kBits = 4;
};

}  // namespace deltalux::paper
