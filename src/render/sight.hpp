#pragma once
// What the places of a part of a picture see of the lights, so that their shadow rays go where light comes from
// (direct/aim.hpp): learnt from the very points that will be shaded, by rays of their own.
#include <unordered_map>
#include <vector>

#include "render/point_sources.hpp"

namespace deltalux::rendering {

/// By leaf: places are noted, learnt from, and then looked up. The leaves of one side of a surface learn together, from
/// what all of the picture's part has learnt before.
class Sights {
 public:
  /// Both must outlive this.
  Sights(const hierarchy::Elements& elements, const PointSources& sources) : elements_(elements), sources_(sources) {}

  void note(hierarchy::ElementId leaf, const direct::Receiver& place) { places_.push_back({leaf, place}); }
  /// For `rays` shadow rays a sample, by so many rays a place that was noted; places are forgotten then.
  void learn(int raysOfPlace, int rays, std::uint64_t key);

  /// visit(arrival) for each of about `rays` shadow rays from a point of a leaf that is not blocked: the sum of all is
  /// the estimate. `index` and `key` name the stratified numbers to use.
  template <class Visit>
  void sample(hierarchy::ElementId leaf, const direct::Receiver& x, int rays, std::uint32_t index, std::uint64_t key,
              const Visit& visit) {
    aimAt(leaf, rays).sample(sources_.light(), x, index, key, visit);
  }

 private:
  struct Place {
    hierarchy::ElementId leaf;
    direct::Receiver at;
  };

  std::uint64_t sideOf(hierarchy::ElementId leaf) const;
  const direct::Aim& aimAt(hierarchy::ElementId leaf, int rays);

  const hierarchy::Elements& elements_;
  const PointSources& sources_;
  std::vector<Place> places_;
  direct::Aim around_;  // of all that the picture's part shows
  std::unordered_map<hierarchy::ElementId, direct::Aim> aims_;
};

}  // namespace deltalux::rendering
