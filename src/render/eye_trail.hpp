#pragma once
// Notes where a path from the eye goes and which leaves it reads, as a PixelSample keeps it.
#include <deltalux/pixel_sample.hpp>

#include "hierarchy/element.hpp"
#include "tracing/ray.hpp"

namespace deltalux::rendering {

class EyeTrail {
 public:
  /// `sample` must outlive this. Paths that leave the scene end after `far` [scene units].
  EyeTrail(PixelSample& sample, float far) : sample_(sample), far_(far) {}

  /// The corner where the ray ends, which came from the corner `before`; its number.
  std::uint8_t add(const tracing::Ray& ray, const tracing::Hit& hit, std::uint8_t before) {
    return add({hit ? hit.position : tracing::at(ray, far_), hit.primitive, PixelSample::Corner{}.patch, before});
  }
  /// The path goes on by chance.
  void chooses() { sample_.noisy = true; }
  /// Light was read from the leaf, at the corner that was added last.
  void read(hierarchy::ElementId leaf) {
    if (sample_.corners == 0 || !sample_.complete) return;
    PixelSample::Corner& last = sample_.path[sample_.corners - 1u];
    if (last.patch == PixelSample::Corner{}.patch)
      last.patch = leaf.value;
    else
      add({last.position, last.primitive, leaf.value, static_cast<std::uint8_t>(sample_.corners - 1)});
  }

 private:
  std::uint8_t add(const PixelSample::Corner& corner) {
    if (sample_.corners == PixelSample::kMost) {
      sample_.complete = false;
      return PixelSample::kEye;
    }
    sample_.path[sample_.corners] = corner;
    return sample_.corners++;
  }

  PixelSample& sample_;
  float far_;
};

}  // namespace deltalux::rendering
