#include "engine/known_solve.hpp"

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kLeavesOfTask = 1024;  // [task]
constexpr std::size_t kSkyRays = direct::tuning::kManyRays;
constexpr std::uint64_t kUnasked = ~std::uint64_t(0);  // of lamps: all [sentinel]

bool holds(const hierarchy::ElementGeometry& whole, const hierarchy::ElementGeometry& part) {
  return glm::all(glm::lessThanEqual(whole.lower, part.lower)) && glm::all(glm::lessThanEqual(part.upper, whole.upper));
}

bool sameSight(const direct::LampSight& a, const direct::LampSight& b) {
  return a.asked == b.asked && a.seen == b.seen && a.drawnAsked == b.drawnAsked && a.drawnSeen == b.drawnSeen;
}

bool samePlace(const hierarchy::Elements& a, std::uint32_t i, const hierarchy::Elements& b, std::size_t j) {
  const hierarchy::PatchDomain &x = a.domain[i], &y = b.domain[j];
  const hierarchy::ElementGeometry &g = a.geometry[i], &h = b.geometry[j];
  return x.primitive == y.primitive && x.triangle == y.triangle && x.u0 == y.u0 && x.v0 == y.v0 && x.u1 == y.u1 &&
         x.v1 == y.v1 && x.address == y.address && a.topology[i].front == b.topology[j].front && g.center == h.center &&
         g.area == h.area && g.radius == h.radius && g.lower == h.lower && g.upper == h.upper && g.normal == h.normal;
}

}  // namespace

KnownSolve::KnownSolve(SolveMemory memory, Solution& s, change::MovedSpace space, Lights lights)
    : memory_(std::move(memory)),
      elements_(std::exchange(s.elements, {})),
      leaves_(elements_),
      lines_(std::exchange(s.lines, {})),
      space_(std::move(space)),
      lights_(lights) {
  for (std::uint32_t i = 0; i < elements_.size(); ++i)
    if (elements_.isInputLevel(hierarchy::ElementId(i)) && elements_.receives(hierarchy::ElementId(i)))
      byKey_.emplace_back(elements_.key[i], i);
  std::sort(byKey_.begin(), byKey_.end());
}

std::uint32_t KnownSolve::find(const hierarchy::Elements& elements, hierarchy::ElementId e) const {
  if (!holds_ || space_.moved(elements.domain[e.index()].primitive)) return kNone;
  if (e.index() < parts_.of.size() && parts_.of[e.index()] != kNone) return parts_.of[e.index()];
  if (elements.at(e).depth > 0) return findPart(elements, e);
  const std::uint64_t key = elements.key[e.index()];
  const auto at = std::lower_bound(byKey_.begin(), byKey_.end(), std::pair(key, std::uint32_t(0)));
  if (at == byKey_.end() || at->first != key || !samePlace(elements_, at->second, elements, e.index())) return kNone;
  return at->second;
}

std::uint32_t KnownSolve::findPart(const hierarchy::Elements& elements, hierarchy::ElementId e) const {
  const std::uint32_t whole = find(elements, elements.at(e).parent);
  if (whole == kNone) return kNone;
  const hierarchy::ElementId old(whole);
  for (std::size_t i = 0; i < elements_.at(old).childCount; ++i)
    if (const std::uint32_t part = elements_.child(old, i).value; samePlace(elements_, part, elements, e.index()))
      return part;
  return kNone;
}

void KnownSolve::holdTo(const hierarchy::Elements& elements) {
  const Box &now = elements.sceneBox, &before = elements_.sceneBox;
  holds_ = now.lower == before.lower && now.upper == before.upper;
  parts(elements, elements.inputs);
}

lines::LightWalks* KnownSolve::walks(const hierarchy::Elements& elements, hierarchy::ElementId side) {
  const std::uint32_t old = lights_.stay ? find(elements, side) : kNone;
  if (old == kNone || !change::holdWalks(space_, memory_.walks[old])) return nullptr;
  return &memory_.walks[old];
}

void KnownSolve::moveOpened(const hierarchy::Elements& elements, const std::vector<char>& enclosed) {
  std::vector<hierarchy::ElementId> other;
  for (const hierarchy::ElementId e : elements.inputs) {
    if (!elements.receives(e) || space_.moved(elements.domain[e.index()].primitive)) continue;
    const std::uint32_t old = find(elements, e);
    if (old == kNone || memory_.enclosed[old] != enclosed[e.index()]) other.push_back(e);
  }
  for (const hierarchy::ElementId e : other)
    space_.add(elements.domain[e.index()].primitive, {elements.shape(e).lower, elements.shape(e).upper});
}

bool KnownSolve::takeScale(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId e,
                           PatchSamples& to) {
  const std::uint32_t old = find(elements, e);
  if (old == kNone || old >= memory_.samples.first.size() || !memory_.samples.first[old]) return false;
  if (!change::holdFirstLines(space_, elements, scene, e, *memory_.samples.first[old])) return false;
  to.scale[e.index()] = memory_.samples.scale[old];
  to.first[e.index()] = std::move(memory_.samples.first[old]);
  return true;
}

std::uint32_t KnownSolve::findLit(const hierarchy::Elements& elements, hierarchy::ElementId e,
                                  const lines::LeafScale& scale) const {
  if (!lights_.same) return kNone;
  const std::uint32_t old = find(elements, e);
  if (old == kNone || old >= memory_.samples.direct.size()) return kNone;
  const lines::LeafScale& before = memory_.samples.scale[old];
  return before.covered == scale.covered && before.known == scale.known ? old : kNone;
}

std::uint64_t KnownSolve::through(const hierarchy::Elements& elements, const direct::Lamps& lamps,
                                  hierarchy::ElementId e) {
  const bool kept = e.index() < through_.size();
  if (kept && through_[e.index()] != kUnasked) return through_[e.index()];
  const hierarchy::ElementGeometry& g = elements.shape(e);
  std::uint64_t among = kUnasked;
  if (const hierarchy::ElementId whole = elements.at(e).parent;
      elements.at(e).depth > 0 && whole.index() < through_.size() && holds(elements.shape(whole), g))
    among = through_[whole.index()];
  const std::uint64_t found = change::lampsThrough(space_, lamps, {g.lower, g.upper}, among);
  if (kept) through_[e.index()] = found;
  return found;
}

std::unique_ptr<WholeLight> KnownSolve::takeWhole(const hierarchy::Elements& elements,
                                                  const direct::DirectSampler& sampler, hierarchy::ElementId e,
                                                  const lines::LeafScale& scale, const direct::LampSight& above) {
  const std::uint32_t old = findLit(elements, e, scale);
  if (old == kNone) return nullptr;
  std::unique_ptr<WholeLight>& whole = memory_.samples.whole[old];
  if (!whole || !sameSight(whole->above, above)) return nullptr;
  const bool holds = change::holdShadowRays(space_, sampler, elements, e, {scale.covered, scale.known}, above,
                                            whole->light, through(elements, sampler.lamps(), e));
  return holds ? std::move(whole) : nullptr;
}

KnownSolve::Evaluated KnownSolve::evaluated(const hierarchy::Elements& elements, const direct::DirectSampler& sampler,
                                            hierarchy::ElementId e, const lines::LeafScale& scale,
                                            const direct::LampSight& above) {
  const std::uint32_t old = findLit(elements, e, scale);
  if (old == kNone || !memory_.samples.evaluated[old] || !sameSight(memory_.samples.evaluated[old]->above, above))
    return {};
  direct::LeafDirect& light = memory_.samples.direct[old];
  const bool holds = change::holdShadowRays(space_, sampler, elements, e, {scale.covered, scale.known}, above, light,
                                            through(elements, sampler.lamps(), e));
  return holds ? Evaluated{&memory_.samples.evaluated[old], &light} : Evaluated{};
}

const direct::DimDirect* KnownSolve::dim(const hierarchy::Elements& elements, const direct::Lamps& lamps,
                                         hierarchy::ElementId leaf, std::uint64_t points) {
  const std::uint32_t old = lights_.same ? find(elements, leaf) : kNone;
  if (old == kNone) return nullptr;
  const auto at = std::ranges::lower_bound(memory_.dim, hierarchy::ElementId(old), {}, &DimLeaf::leaf);
  if (at == memory_.dim.end() || at->leaf != hierarchy::ElementId(old) || at->points != points) return nullptr;
  const bool holds = change::holdAllShadowRays(space_, lamps, elements, leaf, through(elements, lamps, leaf));
  return holds ? &at->light : nullptr;
}

hierarchy::KnownParts* KnownSolve::parts(const hierarchy::Elements& elements,
                                         std::span<const hierarchy::ElementId> patches) {
  parts_.before = &elements_;
  parts_.of.resize(elements.size(), kNone), through_.resize(elements.size(), kUnasked);
  parallelFor(patches.size(), kLeavesOfTask, [&](std::size_t i) {
    if (elements.receives(patches[i])) parts_.of[patches[i].index()] = find(elements, patches[i]);
  });
  return &parts_;
}

std::optional<Rgb> KnownSolve::indirect(const hierarchy::Elements& elements, hierarchy::ElementId leaf) const {
  const std::uint32_t old = find(elements, leaf);
  if (old == kNone) return {};
  return elements_.radiometry[old].indirect;
}

std::vector<std::uint32_t> KnownSolve::leavesBefore(const hierarchy::Elements& elements,
                                                    const hierarchy::LeafTable& leaves) const {
  std::vector<std::uint32_t> of(leaves.size(), kNone);
  parallelFor(leaves.size(), kLeavesOfTask, [&](std::size_t i) {
    if (const std::uint32_t old = find(elements, leaves[i]); old != kNone) of[i] = leaves_.indexOf[old];
  });
  return of;
}

std::optional<lines::KnownLines> KnownSolve::takeLines(const hierarchy::Elements& elements,
                                                       const hierarchy::LeafTable& leaves) {
  if (!holds_) return {};
  lines::TracedLines all{std::exchange(lines_, {}), std::move(memory_.escaped), std::move(memory_.bends), {}, 0};
  return change::knownLines(space_, std::move(all), leavesBefore(elements, leaves), elements_, leaves_);
}

std::span<const lines::LineCode> KnownSolve::skyRays(std::uint32_t before) const {
  return {memory_.sky.rays.data() + before * kSkyRays, kSkyRays};
}

const direct::SkyAtLeaf* KnownSolve::sky(const hierarchy::Elements& elements, hierarchy::ElementId leaf,
                                         std::uint32_t before, const direct::SkyKey& key,
                                         std::span<direct::SkyRay> rays) const {
  if (before >= memory_.sky.key.size() || memory_.sky.key[before].points != key.points) return nullptr;
  for (std::size_t k = 0; k < rays.size(); ++k) rays[k].cell = memory_.sky.cells[before * kSkyRays + k];
  const bool hold = change::holdSkyRays(space_, elements, leaf, skyRays(before).first(rays.size()), rays);
  return hold && memory_.sky.key[before].light == key.light ? &memory_.sky.at[before] : nullptr;
}

}  // namespace deltalux::engine
