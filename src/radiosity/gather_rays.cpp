#include "radiosity/gather_rays.hpp"

#include <algorithm>

namespace deltalux::radiosity {

namespace {

constexpr int kMostDoubled = 6;  // where leaves are few
constexpr int kMostOfLeaf = 8;   // times the settings'

MeanLeaf held(hierarchy::ElementId leaf, const hierarchy::Elements& elements) {
  const double A = elements.shape(leaf).litArea();
  return {A, A * double(gray(elements.radiometry[leaf.index()].indirect))};
}

}  // namespace

MeanLeaf meanOf(std::span<const hierarchy::ElementId> leaves, const hierarchy::Elements& elements) {
  MeanLeaf mean;
  for (const hierarchy::ElementId leaf : leaves) {
    const MeanLeaf one = held(leaf, elements);
    mean.area += one.area / static_cast<double>(leaves.size());
    mean.light += one.light / static_cast<double>(leaves.size());
  }
  return mean;
}

GatherRays::GatherRays(const LeafTransferSettings& settings, std::size_t leaves, const MeanLeaf& mean)
    : fewest_(settings.gatherRays), most_(kMostOfLeaf * settings.gatherRays), mean_(mean) {
  const auto all = [&] { return static_cast<std::size_t>(fewest_) * leaves; };
  for (int i = 0; i < kMostDoubled && all() < static_cast<std::size_t>(settings.inAll); ++i) fewest_ *= 2;
}

int GatherRays::of(hierarchy::ElementId leaf, const hierarchy::Elements& elements) const {
  const MeanLeaf own = held(leaf, elements);
  const double most = std::max(own.area / std::max(mean_.area, 1e-30), own.light / std::max(mean_.light, 1e-30));
  int rays = fewest_;
  for (double share = 4; share <= most && 2 * rays <= most_; share *= 4) rays *= 2;
  return rays;
}

}  // namespace deltalux::radiosity
