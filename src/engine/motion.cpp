#include "engine/motion.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "hierarchy/input_level.hpp"

namespace deltalux::engine {

void Backlog::add(const SceneUpdate& more) {
  std::unordered_set<PrimitiveId> known;
  for (const SceneChange::Moved& m : links.moved) known.insert(m.primitive);
  for (const SceneChange::Moved& m : more.moved)
    if (known.insert(m.primitive).second) links.moved.push_back(m);
  const auto join = [](auto& to, const auto& from) {
    for (const auto& x : from)
      if (std::find(to.begin(), to.end(), x) == to.end()) to.push_back(x);
  };
  join(links.movedLights, more.movedLights);
}

bool Backlog::linksAreDue() const {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - linksFollowed;
  return linksWait() && rows.moves() < kMostMoves && framesSinceLinks >= kFramesBetween &&
         follow.seconds() < kLinksShare * since.count();
}

void Backlog::addSeen(const Scene& scene) {
  for (SceneChange::Moved& m : links.moved)
    if (const Box now = bounds(scene[m.primitive].shape); !now.empty()) m.before.extend(now);
}

void Backlog::add(const particles::ParticleUpdate& more) {
  if (more.all) landed = {};
  landed.all |= more.all;
  if (landed.all) return;
  std::vector<particles::RetracedPath> all;
  const auto earlier = [](const particles::RetracedPath& a, const particles::RetracedPath& b) {
    return a.path < b.path;
  };
  all.reserve(landed.paths.size() + more.paths.size());
  std::merge(landed.paths.begin(), landed.paths.end(), more.paths.begin(), more.paths.end(), std::back_inserter(all),
             earlier);
  const auto same = [](const particles::RetracedPath& a, const particles::RetracedPath& b) { return a.path == b.path; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  landed.paths = std::move(all);
}

double deposited(const Solution& s, const particles::ParticleTransfer& transfer, std::size_t path) {
  const particles::Particles& p = s.particles;
  if (p.range[path].impacts == 0) return 0;
  const Rgb power = p.links[p.link[path]].scale * transfer.power(path, s.elements, s.scene);
  double sum = 0;
  for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) sum += gray(power * p.throughput[i]);
  return sum;
}

double lightOn(const Solution& s, const SceneUpdate& edits) {
  std::vector<char> of(s.elements.size(), 0);
  for (const hierarchy::ElementId e : hierarchy::elementsOf(s.elements, edits.primitives())) of[e.index()] = 1;
  double light = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    const hierarchy::ElementTopology& t = s.elements.topology[i];
    if (t.depth > 0 && t.parent.valid() && of[t.parent.index()]) of[i] = 1;
    if (!of[i] || t.emitter || t.childCount > 0) continue;
    const hierarchy::ElementLight& l = s.elements.radiometry[i];
    light += 2.0 * s.elements.geometry[i].litArea() * gray(l.direct + l.indirect);
  }
  return light;
}

void TextureFlux::add(const particles::PathRange& range, const Rgb& power) {
  const particles::Particles& p = solution_.particles;
  for (std::uint32_t i = range.impact; i < range.impact + range.impacts; ++i) {
    const caustics::SurfaceCaustics* at = solution_.caustics.of(p.primitive[i], (p.triangleAndSide[i] & 1) == 0);
    if (at)
      change_[static_cast<std::size_t>(at - solution_.caustics.surfaces.data())] += RgbSum(power * p.throughput[i]);
  }
}

void TextureFlux::takeOut(const particles::ParticleUpdate& update, const particles::ParticleTransfer& transfer) {
  const Solution& s = solution_;
  for (const particles::RetracedPath& r : update.paths)
    if (r.range.impacts > 0)
      add(r.range, -s.particles.links[s.particles.link[r.path]].scale * transfer.power(r.path, s.elements, s.scene));
}

void TextureFlux::putIn(const particles::ParticleUpdate& update, const particles::ParticleTransfer& transfer) {
  const Solution& s = solution_;
  for (const particles::RetracedPath& r : update.paths)
    if (s.particles.range[r.path].impacts > 0)
      add(s.particles.range[r.path],
          s.particles.links[s.particles.link[r.path]].scale * transfer.power(r.path, s.elements, s.scene));
}

std::size_t TextureFlux::apply(caustics::Caustics& caustics,
                               const std::vector<caustics::SurfaceCaustics>& still) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < change_.size(); ++i) {
    if (change_[i] == RgbSum(0.0)) continue;
    caustics::SurfaceCaustics& side = caustics.surfaces[i];
    const RgbSum flux = glm::max(side.flux() + change_[i], RgbSum(0.0));
    side.textures = still[i].textures;  // one that went dark can be bright again
    caustics::rescale(side, flux, 0.0);
    ++count;
  }
  return count;
}

}  // namespace deltalux::engine
