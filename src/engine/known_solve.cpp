#include "engine/known_solve.hpp"

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"
#include "engine/scene_update.hpp"
#include "hierarchy/fold.hpp"
#include "hierarchy/input_level.hpp"
#include "lines/scene_widths.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kElementsOfTask = 4096;          // [task]
constexpr std::uint64_t kUnasked = ~std::uint64_t(0);  // of lamps: all [sentinel]

bool holds(const hierarchy::ElementGeometry& whole, const hierarchy::ElementGeometry& part) {
  return glm::all(glm::lessThanEqual(whole.lower, part.lower)) && glm::all(glm::lessThanEqual(part.upper, whole.upper));
}

bool sameSight(const direct::LampSight& a, const direct::LampSight& b) {
  return a.asked == b.asked && a.seen == b.seen && a.drawnAsked == b.drawnAsked;
}

/// Values by what elements were, in the order of what they are.
template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& was) {
  std::vector<T> now(was.size());
  for (std::size_t i = 0; i < was.size(); ++i)
    if (was[i] < values.size()) now[i] = std::move(values[was[i]]);
  values = std::move(now);
}

}  // namespace

KnownSolve::KnownSolve(SolveMemory memory, Solution& s, EditedScene edits,
                       std::optional<particles::ParticleTransfer> transfer)
    : memory_(std::move(memory)),
      elements_(std::exchange(s.elements, {})),
      there_(elements_.size(), true),
      wasLeaf_(elements_.size()),
      indirect_(elements_.size()),
      lines_{std::exchange(s.lines, {}), std::move(memory_.escaped), std::move(memory_.bends), 0},
      edits_(std::move(edits)),
      followed_(edits_.retraced),
      transfer_(std::move(transfer)) {
  for (std::size_t i = 0; i < indirect_.size(); ++i) {
    indirect_[i] = elements_.radiometry[i].indirect;
    wasLeaf_[i] = elements_.isReceivingLeaf(hierarchy::ElementId(i));
  }
}

hierarchy::Elements KnownSolve::takeMesh(const Scene& scene, const std::function<hierarchy::Elements()>& build) {
  holds_ = lines::widthsOf(scene, bounds(scene)) == lines::widthsOf(scene, elements_.sceneBox);
  if (!holds_) {
    memory_ = {}, lines_ = {}, elements_ = {}, transfer_.reset();
    return build();
  }
  const bool roomy = 2 * hierarchy::awayIn(elements_) > elements_.size();
  hierarchy::fold(elements_);
  bool inPlace = true;
  hierarchy::Elements mesh;
  if (edits_.stands && !roomy && hierarchy::bringTo(elements_, scene, edits_.moved)) {
    for (const hierarchy::ElementId e : paintedSurfaces(elements_, scene, edits_.painted))
      hierarchy::setReflectance(elements_, scene, e);
    hierarchy::reshape(elements_, scene, hierarchy::elementsOf(elements_, edits_.relit));
    mesh = std::move(elements_);
  } else {
    mesh = build();
    std::vector<char> stays(scene.primitives.size());
    for (std::size_t i = 0; i < stays.size(); ++i) stays[i] = !edits_.space.moved(PrimitiveId(i));
    renumber(hierarchy::carryOver(mesh, scene, elements_, stays));
    elements_ = {}, inPlace = false;
  }
  if (!inPlace || !followed_) transfer_.reset(), memory_.coarseTransfer.reset();
  through_.assign(mesh.size(), kUnasked);
  return mesh;
}

void KnownSolve::renumber(const std::vector<std::uint32_t>& was) {
  std::vector<std::uint32_t> now(indirect_.size(), kNone);
  for (std::uint32_t i = 0; i < was.size(); ++i)
    if (was[i] != kNone) now[was[i]] = i;
  PatchSamples& s = memory_.samples;
  reorder(s.scale, was), reorder(s.direct, was), reorder(s.first, was), reorder(s.evaluated, was);
  reorder(s.whole, was), reorder(s.coarse, was), s.walled.clear();
  reorder(memory_.walks, was), reorder(memory_.enclosed, was), reorder(memory_.details, was);
  reorder(wasLeaf_, was), reorder(indirect_, was);
  lines_ = lines::renumbered(lines_, now, was.size());
  memory_.coarse.traced = lines::renumbered(memory_.coarse.traced, now, was.size());
  if (memory_.exchange) memory_.exchange->renumber(now, was.size());
  reorder(memory_.sky.of, was), reorder(memory_.coarse.sky.of, was);
  there_.assign(was.size(), false);
  for (std::size_t i = 0; i < was.size(); ++i) there_[i] = was[i] != kNone;
  for (DimLeaf& dim : memory_.dim) dim.leaf = hierarchy::ElementId(now[dim.leaf.index()]);
  std::erase_if(memory_.dim, [](const DimLeaf& dim) { return dim.leaf.value == kNone; });
  std::ranges::sort(memory_.dim, {}, &DimLeaf::leaf);
}

particles::Details KnownSolve::takeDetails(const hierarchy::Elements& elements, const particles::Particles& p) {
  if (!holds_ || !followed_) return {};
  particles::forget(memory_.details, elements, p, *followed_);
  return std::move(memory_.details);
}

bool KnownSolve::known(const hierarchy::Elements& elements, hierarchy::ElementId e) const {
  return holds_ && e.index() < there_.size() && there_[e.index()] &&
         !edits_.space.moved(elements.domain[e.index()].primitive);
}

bool KnownSolve::holdsWalks(const hierarchy::Elements& elements, hierarchy::ElementId side,
                            const lines::LightWalks& walks) const {
  return edits_.sameLights && known(elements, side) && change::holdWalks(edits_.space, walks);
}

void KnownSolve::moveOpened(const hierarchy::Elements& elements, const std::vector<char>& enclosed) {
  if (!holds_) return;
  std::vector<hierarchy::ElementId> other;
  for (const hierarchy::ElementId e : elements.inputs) {
    if (!elements.receives(e) || edits_.space.moved(elements.domain[e.index()].primitive)) continue;
    if (!known(elements, e) || memory_.enclosed[e.index()] != enclosed[e.index()]) other.push_back(e);
  }
  for (const hierarchy::ElementId e : other)
    edits_.space.add(elements.domain[e.index()].primitive, {elements.shape(e).lower, elements.shape(e).upper});
}

bool KnownSolve::holdsScale(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId e,
                            const lines::FirstLines& first) const {
  return known(elements, e) && change::holdFirstLines(edits_.space, elements, scene, e, first);
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
  const std::uint64_t found = among == 0 ? 0 : change::lampsThrough(edits_.space, lamps, {g.lower, g.upper}, among);
  if (kept) through_[e.index()] = found;
  return found;
}

bool KnownSolve::holdsLight(const hierarchy::Elements& elements, const direct::DirectSampler& sampler,
                            hierarchy::ElementId e, const lines::LeafScale& scale, const direct::LampSight& before,
                            const direct::LampSight& above, const direct::LeafDirect& light, std::uint64_t& rays) {
  if (!edits_.lightsSame || !known(elements, e) || !sameSight(before, above)) return false;
  const direct::KnownPoints points{scale.covered, scale.known};
  const std::uint64_t lamps = through(elements, sampler.lamps(), e);
  if (edits_.lightsStay) return change::holdShadowRays(edits_.space, sampler, elements, e, points, above, light, lamps);
  bool drawn = false;
  return change::holdAskedRays(edits_.space, sampler, elements, e, points, light, lamps, drawn) &&
         sampler.stands(e, points, above, light, memory_.lampTree, edits_.movedLights, rays);
}

std::function<bool(const direct::Lamp&, const tracing::Ray&)> KnownSolve::shadowsThatHold(
    const hierarchy::Elements& elements, const direct::Lamps& lamps, hierarchy::ElementId e) {
  if (!known(elements, e)) return {};
  return [lampsThrough = through(elements, lamps, e), this](const direct::Lamp& lamp, const tracing::Ray& ray) {
    return !edits_.movedLights[lamp.id.index()] &&
           ((lampsThrough & direct::lampBit(lamp.id)) == 0 || !change::crosses(edits_.space, ray));
  };
}

const direct::DimDirect* KnownSolve::dim(const hierarchy::Elements& elements, const Scene& scene,
                                         const direct::Lamps& lamps, hierarchy::ElementId leaf, std::uint64_t key,
                                         std::span<const std::uint32_t> points) {
  if (!edits_.lightsSame || !edits_.lightsStay || !known(elements, leaf)) return nullptr;
  const auto at = std::ranges::lower_bound(memory_.dim, leaf, {}, &DimLeaf::leaf);
  if (at == memory_.dim.end() || at->leaf != leaf || at->points != key) return nullptr;
  const bool holds =
      change::holdDimRays(edits_.space, lamps, elements, scene, leaf, points, through(elements, lamps, leaf));
  return holds ? &at->light : nullptr;
}

std::optional<Rgb> KnownSolve::indirect(const hierarchy::Elements& elements, hierarchy::ElementId leaf) const {
  if (!known(elements, leaf)) return {};
  return indirect_[leaf.index()];
}

std::vector<char> KnownSolve::standing(const hierarchy::Elements& elements, const std::vector<char>& wasLeaf) const {
  std::vector<char> stands(elements.size(), false);
  parallelFor(std::min(stands.size(), wasLeaf.size()), kElementsOfTask, [&](std::size_t i) {
    const hierarchy::ElementId e(i);
    stands[i] = wasLeaf[i] && elements.isReceivingLeaf(e) && known(elements, e);
  });
  return stands;
}

std::optional<lines::KnownLines> KnownSolve::takeLines(const hierarchy::Elements& elements, lines::TracedLines& all) {
  if (!holds_) return {};
  all = std::exchange(lines_, {});
  return change::knownLines(edits_.space, all, standing(elements, wasLeaf_), elements);
}

std::optional<lines::KnownLines> KnownSolve::takeCoarseLines(const hierarchy::Elements& elements,
                                                             lines::TracedLines& all) {
  if (!holds_) return {};
  all = std::exchange(memory_.coarse.traced, {});
  std::vector<char> wasInput(elements.size(), false);
  for (const hierarchy::ElementId e : elements.inputs) wasInput[e.index()] = elements.receives(e);
  return change::knownLines(edits_.space, all, standing(elements, wasInput), elements);
}

bool KnownSolve::holdSkyRays(const hierarchy::Elements& elements, hierarchy::ElementId leaf, const LeafSky& sky,
                             std::span<direct::SkyRay> rays) const {
  for (std::size_t k = 0; k < rays.size(); ++k) rays[k].cell = sky.cells[k];
  return change::holdSkyRays(edits_.space, elements, leaf, std::span(sky.rays).first(rays.size()), rays);
}

}  // namespace deltalux::engine
