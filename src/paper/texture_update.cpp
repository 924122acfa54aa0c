#include "paper/texture_update.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "paper/caustic_textures.hpp"
#include "particles/side_index.hpp"

namespace deltalux::paper {

namespace {

constexpr double kSameFlux = 1e-6;  // relative, of the same deposits in another order [rounding]

/// By side: whether deposits on it were taken back, or are new.
std::vector<char> changedSides(const Scene& scene, const particles::Particles& p,
                               const particles::ParticleUpdate& update) {
  std::vector<char> sides(2 * scene.primitives.size(), 0);
  const auto mark = [&](const particles::PathRange& range) {
    for (std::uint32_t i = range.impact; i < range.impact + range.impacts; ++i) sides[particles::sideIndex(p, i)] = 1;
  };
  for (const particles::RetracedPath& r : update.paths) mark(r.range), mark(p.range[r.path]);
  return sides;
}

}  // namespace

std::size_t followTextures(caustics::Caustics& textures, const Scene& scene, const hierarchy::Elements& elements,
                           const particles::Particles& p, const particles::ParticleUpdate& update, double error) {
  DELTALUX_CHECK(!update.all, "the particles of before");
  const std::vector<char> changed = changedSides(scene, p, update);
  std::vector<particles::Impact> impacts = particles::impacts(p, elements, scene);
  std::vector<RgbSum> flux(changed.size(), RgbSum(0.0));
  for (const particles::Impact& i : impacts) flux[particles::sideIndex(i.primitive, i.front)] += RgbSum(i.flux);
  for (caustics::SurfaceCaustics& s : textures.surfaces)
    if (const std::size_t side = particles::sideIndex(s.primitive, s.front); !changed[side])
      caustics::rescale(s, flux[side], kSameFlux);
  std::erase_if(impacts,
                [&](const particles::Impact& i) { return !changed[particles::sideIndex(i.primitive, i.front)]; });
  return caustics::remakeCaustics(textures, scene, elements, std::move(impacts), error, changed, textureRule());
}

}  // namespace deltalux::paper
