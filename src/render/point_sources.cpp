#include "render/point_sources.hpp"

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "solution/sky_visibility.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::uint64_t kLeafKey = 0x61696d5f5f5full;  // [key]

}  // namespace

PointSources::PointSources(const Solution& s) : s_(s), leaves_(s.elements), light_(s.scene, *s.tracer) {}

const direct::SkyVisibility& PointSources::visibility() const {
  std::call_once(
      counted_, [&] { withoutOtherWork([&] { visibility_.emplace(skyVisibility(s_.elements, leaves_, s_.lines)); }); });
  return *visibility_;
}

std::vector<direct::Source> PointSources::at(hierarchy::ElementId leaf) const {
  const std::uint32_t i = leaves_.indexOf[leaf.index()];
  return light_.sources(s_.elements.shape(leaf), [&](int cell) { return visibility().at(i, cell); });
}

std::vector<direct::Source> PointSources::at(hierarchy::ElementId leaf, const direct::Receiver& x) const {
  const std::uint32_t i = leaves_.indexOf[leaf.index()];
  return light_.sources(direct::pointPatch(x), [&](int cell) { return visibility().at(i, cell); });
}

float PointSources::lightAt(hierarchy::ElementId leaf) const {
  const hierarchy::ElementLight& l = s_.elements.radiometry[leaf.index()];
  return gray(l.direct + l.indirect + l.particle);
}

direct::Aim PointSources::aimAt(hierarchy::ElementId leaf, int rays) const {
  const hierarchy::LeafSequence points(s_.elements, s_.scene, leaf);
  std::vector<direct::Receiver> places;
  for (std::uint32_t k = 0; k < deltalux::tuning::kPilots; ++k) {
    const hierarchy::PatchPoint p = points.point(k);
    places.push_back({Vec3(p.position), Vec3(p.normal)});
  }
  const std::vector<direct::Source> sources = at(leaf);
  direct::Aim aim(sources);
  aim.learn(light_, places, direct::kLearnAtPoint, combineKeys(points.key(), kLeafKey));
  return aim.at(sources, lightAt(leaf), rays);
}

}  // namespace deltalux::rendering
