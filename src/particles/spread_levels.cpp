#include "particles/spread_levels.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "hierarchy/most_returned.hpp"
#include "particles/tuning.hpp"

namespace deltalux::particles {

namespace {

constexpr std::size_t kElementBlock = 64;  // [task]

/// By which what comes back exceeds what a patch of that area may get.
double excess(const Feedback& f, double area, const hierarchy::ElementLight& light) {
  const double byReturn = f.flux / std::max<double>(hierarchy::mostReturned(light) - 1, 1e-6);
  return std::min(f.once, std::max(f.often, byReturn)) / std::max(area, 1e-30);
}

}  // namespace

void PatchTree::list(const hierarchy::Elements& elements, hierarchy::ElementId top) {
  places.assign(1, {top, 0});
  if (elements.isLeaf(top)) return;
  places.clear();
  std::vector<Place> stack{{top, 0}};
  while (!stack.empty()) {
    const auto here = static_cast<std::uint32_t>(places.size());
    places.push_back(stack.back());
    stack.pop_back();
    const hierarchy::ElementId e = places[here].element;
    for (std::size_t i = elements.at(e).childCount; i-- > 0;) stack.push_back({elements.child(e, i), here});
  }
}

/// Of a patch, from all that lies on it and below it.
struct SpreadLevels::Cut {
  DepositSums sums;
  double lit = 0;        // area
  double parts = 0;      // least error of what is below
  bool whole = true;     // its particles are spread over all of it
  bool tooMuch = false;  // for so small a patch, or one below
};

void SpreadLevels::choose(std::span<const hierarchy::ElementId> surfaces, const hierarchy::Elements& elements,
                          const std::vector<DepositSums>& sums) {
  of_.resize(elements.size(), kNone);
  damping_.resize(elements.size(), 1.0f);
  parallelBlocks(surfaces.size(), kElementBlock, [&](std::size_t begin, std::size_t end) {
    PatchTree tree;
    std::vector<Cut> cuts;
    for (std::size_t i = begin; i < end; ++i) {
      tree.list(elements, surfaces[i]);
      choose(elements, sums, tree, cuts);
    }
  });
}

void SpreadLevels::choose(const hierarchy::Elements& elements, const std::vector<DepositSums>& sums,
                          const PatchTree& tree, std::vector<Cut>& cuts) {
  cuts.assign(tree.places.size(), {});
  for (std::size_t i = cuts.size(); i-- > 0;) {
    const hierarchy::ElementId e = tree.places[i].element;
    Cut& cut = cuts[i];
    const bool split = !elements.isLeaf(e) && sums[e.index()].count == 0;
    cut.sums += sums[e.index()];
    const double A = std::max<double>(elements.shape(e).area, 1e-30);
    const double J = (2 * cut.sums.squares - cut.sums.weight * cut.sums.weight) / A;  // [Rudemo82 (2.8)]
    cut.whole = !split || cut.tooMuch || J <= cut.parts;
    if (elements.isLeaf(e)) cut.lit = elements.shape(e).litArea();
    const double times = excess(cut.sums.feedback, cut.lit, elements.radiometry[e.index()]);
    cut.tooMuch = times > 1;
    // Counts where not even the whole surface is enough to spread it on.
    damping_[e.index()] = cut.tooMuch ? static_cast<float>(1 / times) : 1.0f;
    if (i == 0) continue;
    Cut& up = cuts[tree.places[i].parent];
    up.sums += cut.sums, up.lit += cut.lit, up.parts += cut.whole ? J : cut.parts, up.tooMuch |= cut.tooMuch;
  }
  // From above: once a patch is whole, so is everything in it.
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const hierarchy::ElementId e = tree.places[i].element;
    const std::uint32_t above = i == 0 ? kNone : of_[tree.places[tree.places[i].parent].element.index()];
    of_[e.index()] = above != kNone ? above : cuts[i].whole ? e.value : kNone;
  }
}

}  // namespace deltalux::particles
