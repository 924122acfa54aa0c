#pragma once
// Light gathered over all rows and particles of a solution until it no longer changes, with nothing taken over from how
// it was settled.
#include <algorithm>
#include <cmath>

#include "hierarchy/pull.hpp"
#include "particles/transfer.hpp"
#include "scene/nominal_scale.hpp"
#include "support/solved.hpp"

namespace deltalux::test {

inline hierarchy::Elements settledOverAll(const Solution& s) {
  hierarchy::Elements elements = s.elements;
  const particles::ParticleTransfer particles(s.particles, elements, s.scene);
  s.transfers.gatherDirect(elements);
  hierarchy::pull(elements);
  double first = 0;
  for (int i = 0; i < 200; ++i) {
    s.transfers.gatherIndirect(elements);
    particles.apply(elements, scene::scalesOf(s.scene));
    const double change = gray(hierarchy::pull(elements));
    first = std::max(first, change);
    if (change <= 1e-6 * first) break;
  }
  return elements;
}

struct Unsettled {
  double power = 0;  // share of all light that lies otherwise
  Spread relative;   // differences at leaves
};

/// How far the light of a solution is from settled.
inline Unsettled unsettled(const Solution& s) {
  const hierarchy::Elements all = settledOverAll(s);
  double difference = 0, power = 0;
  std::vector<double> relative;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all.isReceivingLeaf(hierarchy::ElementId(i)) || !(all.geometry[i].litArea() > 0)) continue;
    const hierarchy::ElementLight &a = s.elements.radiometry[i], &b = all.radiometry[i];
    const double is = gray(a.direct + a.indirect + a.particle), should = gray(b.direct + b.indirect + b.particle);
    difference += all.geometry[i].litArea() * std::abs(is - should), power += all.geometry[i].litArea() * should;
    if (should > 0) relative.push_back(std::abs(is - should) / should);
  }
  return {difference / power, spreadOf(std::move(relative))};
}

}  // namespace deltalux::test
