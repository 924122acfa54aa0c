#pragma once
// What samples from before an edit are still worth: all that they have found is what they would find now, where none of
// their rays starts or passes where something has moved.
#include "change/moved_space.hpp"
#include "direct/dim_direct.hpp"
#include "direct/leaf_direct.hpp"
#include "direct/sky_light.hpp"
#include "lines/enclosed_sides.hpp"
#include "lines/first_lines.hpp"

namespace deltalux::change {

/// Whether a patch's first lines, and what they tell of its surroundings, are as they were. `patch`: as it is now.
bool holdFirstLines(const MovedSpace&, const hierarchy::Elements&, const Scene&, hierarchy::ElementId patch,
                    const lines::FirstLines&);
/// Whether walks that looked for light are.
bool holdWalks(const MovedSpace&, const lines::LightWalks&);
/// Whether a ray may pass where something has moved, as far as it runs.
bool crosses(const MovedSpace&, const tracing::Ray&);
/// Whether a shadow ray from anywhere in a box to a sun or lamp may pass where something has moved.
bool mayShadow(const MovedSpace&, const direct::Lamp&, const BoxF& from);
/// Lamps of which mayShadow() is true, by their lampBit(), out of those in `among`: what is so of no patch is so of
/// none of its parts.
std::uint64_t lampsThrough(const MovedSpace&, const direct::Lamps&, const BoxF& from, std::uint64_t among);
/// Whether all shadow rays that these points of a leaf in the dark shoot at suns and lamps are, which all count for
/// what they did. `through`: lampsThrough() of it.
bool holdDimRays(const MovedSpace&, const direct::Lamps&, const hierarchy::Elements&, const Scene&,
                 hierarchy::ElementId leaf, std::span<const std::uint32_t> points, std::uint64_t through);
/// Whether shadow rays are that a patch's light has come about by, to those lamps that were asked; tells whether such
/// as were drawn may not be.
bool holdAskedRays(const MovedSpace&, const direct::DirectSampler&, const hierarchy::Elements&,
                   hierarchy::ElementId patch, const direct::KnownPoints&, const direct::LeafDirect&,
                   std::uint64_t through, bool& drawn);
/// The same of all of them; `above`: what was known of lamps then.
bool holdShadowRays(const MovedSpace&, const direct::DirectSampler&, const hierarchy::Elements&,
                    hierarchy::ElementId patch, const direct::KnownPoints&, const direct::LampSight& above,
                    const direct::LeafDirect&, std::uint64_t through);

/// Tells the visibility of those shadow rays of a patch to the sky that are as they were, by their codes in the order
/// of its sequence. Returns whether all of them are. Sizes must agree.
bool holdSkyRays(const MovedSpace&, const hierarchy::Elements&, hierarchy::ElementId patch,
                 std::span<const lines::LineCode>, std::span<direct::SkyRay>);

/// What lines from before are worth: marks those that are to be traced again, and takes away those of what does not
/// stand. `stands`: KnownLines::stands.
lines::KnownLines knownLines(const MovedSpace&, lines::TracedLines&, std::vector<char> stands,
                             const hierarchy::Elements&);

}  // namespace deltalux::change
