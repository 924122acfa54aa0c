#pragma once
// Transforms as xform's options say them. [Radiance, xform(1)]
#include <deltalux/math.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// A similarity, and what else xform does to an object.
struct Transform {
  Mat4 matrix{1.0};
  double scale = 1;       // > 0
  bool mirrored = false;  // the matrix turns right hands into left hands

  Vec3 point(const Vec3& p) const { return Vec3(matrix * glm::dvec4(p, 1)); }
  Vec3 vector(const Vec3& v) const { return Vec3(matrix * glm::dvec4(v, 0)); }
};

/// Reads transform options (-t -s -rx -ry -rz -mx -my -mz -i) from the front of `words` as far as they go; `used` tells
/// how many words that were. They apply in order; `-i N` repeats what follows it, up to the next -i, N times.
Transform parseTransform(std::span<const std::string> words, std::size_t& used, const SourceLine& where);

/// What xform does to each object of its input.
struct Placement {
  Transform transform;
  bool invert = false;     // -I: turn surfaces inside out
  std::string modifier;    // -m: replaces the modifier of surfaces, unless empty
  std::string namePrefix;  // -n: put before the names of surfaces with a dot, unless empty
};

RadObject placed(const RadObject&, const Placement&);

}  // namespace deltalux::io::radiance
