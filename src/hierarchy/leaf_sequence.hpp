#pragma once
// The points that a leaf is sampled at: a sequence of its own, keyed by what the leaf is, of which any number is a
// prefix. Its lines start at them and its shadow rays too, so that what is known of a point serves both.
#include <array>
#include <span>

#include "base/sobol.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::hierarchy {

class LeafSequence {
 public:
  static constexpr std::size_t kBatch = 16;  // [task]

  /// The elements and the scene must outlive this.
  LeafSequence(const Elements& elements, const Scene& scene, ElementId leaf)
      : elements_(elements),
        scene_(scene),
        leaf_(leaf),
        key_(elements.key[leaf.index()]),
        places_(combineKeys(key_, kPlaces)) {
    const PatchDomain& d = elements.domain[leaf.index()];
    if (!fillsItsRectangle(elements, leaf)) return;
    plane_ = &elements.frames[d.frame];
    normal_ = Vec3f(elements.at(leaf).front ? plane_->normal : -plane_->normal);
    lower_ = {d.u0, d.v0}, size_ = {d.u1 - d.u0, d.v1 - d.v0};
  }

  std::uint64_t key() const { return key_; }
  /// Where point `i` lies in the leaf's rectangle, in [0,1)^2: before what the outline cuts off is drawn again.
  UnitPair place(std::uint32_t i) const { return places_(i); }
  PatchPoint point(std::uint32_t i) const { return pointAt(place(i)); }
  PatchPoint pointAt(const UnitPair& place) const {
    if (plane_) return {Vec3f(plane_->at(lower_ + Vec2(place.x, place.y) * size_)), normal_};
    return samplePatch(elements_, scene_, leaf_, place.x, place.y);
  }

 private:
  static constexpr std::uint64_t kPlaces = 0x706c616365735f5full;  // [key]

  const Elements& elements_;
  const Scene& scene_;
  ElementId leaf_;
  std::uint64_t key_;
  ScrambledSobol places_;
  /// Of whole rectangles, whose points samplePatch would find in the same way, had it not to ask for the outline.
  const PlaneFrame* plane_ = nullptr;
  Vec3f normal_{0.0f};
  Vec2 lower_{0}, size_{0};
};

}  // namespace deltalux::hierarchy
