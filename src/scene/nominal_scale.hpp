#pragma once
// What lights count as where samples are decided: mesh, lines, rays and particles are the same however lamps are
// dimmed, so that dimming is a matter of weights. Light is linear in the lamps.
#include <deltalux/scene.hpp>

namespace deltalux::scene {

/// By light: 1, whatever it is dimmed to, or switched off; brighter, the next power of 16. Suns and skies that are
/// dimmed by more than 16 times count as less, by powers of 16, and as nothing when they are off: lamps at night are
/// not to be measured by the day. Those that stand by count as lamps do.
std::vector<Rgb> nominalScales(const Scene&);
/// By light: its scale at present.
std::vector<Rgb> scalesOf(const Scene&);
/// By light: its scale over the nominal one; 0 where that is none.
std::vector<Rgb> dimming(const Scene&);

}  // namespace deltalux::scene
