#include "engine/line_motion.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "change/known_samples.hpp"
#include "engine/clock.hpp"
#include "engine/line_solve.hpp"
#include "engine/tuning.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/pull.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kMotionLeaves = 256, kLightLeaves = 8;  // of a task [task]

/// What suns and lamps may bring to a leaf [W/m2, gray].
double potentialOf(const direct::Lamps& lamps, const hierarchy::ElementGeometry& g) {
  double sum = 0;
  for (const std::uint32_t i : lamps.suns()) sum += direct::potential(lamps.all()[i], g);
  lamps.tree().reaching(g, [&](std::uint32_t, double most) { sum += most; });
  return sum;
}

/// Lights that shine from elsewhere by these edits, or count for something else: by light.
std::vector<char> otherLights(const Solution& s, const SceneUpdate& edits) {
  const std::vector<Rgb> nominal = scene::nominalScales(s.scene);
  std::vector<char> others = lightsThatMoved(s.scene, edits);
  for (std::size_t i = 0; i < others.size(); ++i)
    others[i] |= i >= s.memory->nominal.size() || nominal[i] != s.memory->nominal[i];
  return others;
}

/// Finds leaves whose shadow rays edits may have led elsewhere, from the top of the hierarchy down.
class ShadowSearch {
 public:
  ShadowSearch(const Solution& s, const SceneUpdate& edits, const direct::Lamps& lamps)
      : elements_(s.elements), lamps_(lamps.all()), others_(otherLights(s, edits)), space_(s.scene, edits.moved) {
    for (std::uint32_t i = 0; i < lamps_.size(); ++i) all_.push_back(i);
  }

  std::vector<hierarchy::ElementId> find() {
    for (const hierarchy::ElementId root : elements_.sceneRoots()) visit(root, all_);
    return std::move(found_);
  }

 private:
  /// `lamps`: those whose rays to what is above may be others.
  void visit(hierarchy::ElementId e, const std::vector<std::uint32_t>& lamps) {
    const hierarchy::ElementGeometry& g = elements_.shape(e);
    const BoxF box{g.lower, g.upper};
    const bool moved = space_.touches(box), leaf = elements_.isReceivingLeaf(e);
    std::vector<std::uint32_t> left;
    for (const std::uint32_t i : lamps)
      if ((moved || mayDiffer(lamps_[i], box)) && (!leaf || direct::potential(lamps_[i], g) > 0)) left.push_back(i);
    if (left.empty()) return;
    if (leaf) found_.push_back(e);
    for (std::size_t c = 0; c < elements_.at(e).childCount; ++c) visit(elements_.child(e, c), left);
  }
  bool mayDiffer(const direct::Lamp& lamp, const BoxF& box) const {
    return others_[lamp.id.index()] || change::mayShadow(space_, lamp, box);
  }

  const hierarchy::Elements& elements_;
  std::span<const direct::Lamp> lamps_;
  std::vector<char> others_;
  change::MovedSpace space_;
  std::vector<std::uint32_t> all_;
  std::vector<hierarchy::ElementId> found_;
};

}  // namespace

LineMotion::LineMotion(const Solution& s)
    : leaves_(s.elements),
      light_(lines::leafLight(s.elements, leaves_)),
      dimming_(Dimming::of(s.scene, direct::Skies(s.scene))) {
  lamps_.resize(leaves_.size()), direct_.resize(leaves_.size()), worth_.resize(leaves_.size(), 0.0f);
  const LampsOfLeaves lamps = lampsOf(s.memory->samples, s.memory->dim, leaves_);
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    const hierarchy::ElementLight& l = s.elements.radiometry[leaves_[i].index()];
    light_.source[i] = l.direct + l.particle, light_.indirect[i] = l.indirect, light_.B[i] = l.B;
    lamps_[i].assign(lamps[i].begin(), lamps[i].end());
    direct_[i] = l.direct - dimming_.skies * s.memory->sky.at[i].E;
  }
}

/// Lights' light as it is dimmed now.
void LineMotion::dim(Solution& s, const particles::ParticleTransfer* particles) {
  const direct::Skies skies(s.scene);
  const Rgb before = dimming_.skies;
  dimming_ = Dimming::of(s.scene, skies);
  if (skies.key() != s.memory->sky.skies) dimming_.skies = before;  // waits
  if (particles) particles->apply(s.elements, scene::scalesOf(s.scene));
  parallelFor(leaves_.size(), kMotionLeaves, [&](std::size_t i) {
    if (!(s.memory->exchange->area(i) > 0)) return;
    hierarchy::ElementLight& l = s.elements.radiometry[leaves_[i].index()];
    direct_[i] = direct::dimmed(lamps_[i], dimming_.lights).E;
    l.direct = direct_[i] + dimming_.skies * s.memory->sky.at[i].E;
    light_.source[i] = l.direct + l.particle;
  });
}

void LineMotion::note(Solution& s, const SceneUpdate& edits, const particles::ParticleTransfer* particles) {
  if (!edits.dimmed.empty()) {
    for (const hierarchy::ElementId e : hierarchy::elementsOf(s.elements, edits.dimmed))
      hierarchy::setEmission(s.elements, s.scene, e);
    dim(s, particles);
  }
  hierarchy::reshape(s.elements, s.scene, hierarchy::elementsOf(s.elements, edits.primitives()));
  if (!edits.materials.empty()) {
    for (const hierarchy::ElementId e : paintedSurfaces(s.elements, s.scene, edits.materials))
      hierarchy::setReflectance(s.elements, s.scene, e);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      const hierarchy::ElementLight& l = s.elements.radiometry[leaves_[i].index()];
      light_.rho[i] = l.rho, light_.tau[i] = l.tau;
    }
  }
  const direct::Lamps lamps(s.scene, scene::nominalScales(s.scene));
  for (const hierarchy::ElementId e : ShadowSearch(s, edits, lamps).find()) {
    const std::uint32_t i = leaves_.indexOf[e.index()];
    if (worth_[i] > 0 || !(s.memory->exchange->area(i) > 0)) continue;
    const hierarchy::ElementGeometry& g = s.elements.shape(e);
    worth_[i] = static_cast<float>(g.area * std::max<double>(potentialOf(lamps, g), gray(direct_[i])));
    waiting_ += worth_[i] > 0;
  }
}

std::vector<std::uint32_t> LineMotion::mostWorth(std::size_t count) const {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < worth_.size(); ++i)
    if (worth_[i] > 0) all.push_back(i);
  count = std::min(count, all.size());
  std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(count), std::greater{},
                           [&](std::uint32_t i) { return worth_[i]; });
  all.resize(count);
  return all;
}

void LineMotion::light(Solution& s, const direct::Lamps& lamps, std::span<const std::uint32_t> leaves) {
  const direct::DirectSampler sampler(s.elements, s.scene, *s.tracer, lamps, s.settings.error);
  const PatchSamples& samples = s.memory->samples;
  parallelFor(leaves.size(), kLightLeaves, [&](std::size_t n) {
    const std::uint32_t i = leaves[n];
    const hierarchy::ElementId leaf = leaves_[i];
    const lines::LeafScale& scale = samples.scale[leaf.index()];
    lamps_[i] = sampler.at(leaf, {scale.covered, scale.known}, sightAbove(samples, s.elements, leaf)).lamps;
    const Rgb E = direct::dimmed(lamps_[i], dimming_.lights).E;
    light_.source[i] += E - direct_[i], s.elements.radiometry[leaf.index()].direct += E - direct_[i];
    direct_[i] = E, worth_[i] = 0;
  });
  waiting_ -= leaves.size();
}

void LineMotion::follow(Solution& s, const std::function<double()>& secondsLeft) {
  constexpr auto kFewest = std::size_t{deltalux::tuning::kPilots};  // in any frame, so that it gets on
  const direct::Lamps lamps(s.scene, scene::nominalScales(s.scene));
  bool fewest = true;
  while (waiting_ > 0) {
    const Clock lighting;
    const double seconds = secondsLeft() - tuning::kPassesOfFrame * pass_.seconds();
    // Not all at once, so that what a leaf takes is learned while there is time.
    const auto fit = static_cast<std::size_t>(std::max(0.0, 0.5 * seconds) / leaf_.seconds());
    if (fit < kFewest && !fewest) break;
    const std::vector<std::uint32_t> next = mostWorth(std::max(kFewest, fit));
    light(s, lamps, next);
    leaf_.learn(lighting.seconds(), static_cast<double>(next.size()));
    fewest = false;
  }
  do {
    const Clock passing;
    const lines::IterationReport report = lines::iterate(*s.memory->exchange, light_, deltalux::tuning::kConverged, 1);
    pass_.learn(passing.seconds());
    if (gray(report.residual) <= deltalux::tuning::kConverged * gray(report.emitted)) break;
  } while (secondsLeft() > tuning::kPassesOfFrame * pass_.seconds());
  parallelFor(leaves_.size(), kMotionLeaves, [&](std::size_t i) {
    hierarchy::ElementLight& l = s.elements.radiometry[leaves_[i].index()];
    l.indirect = light_.indirect[i], l.B = light_.B[i];
  });
  hierarchy::pull(s.elements);
}

double LineMotion::stale(const Solution& s) const {
  double sum = 0;
  for (std::size_t i = 0; i < worth_.size(); ++i)
    if (worth_[i] > 0) sum += s.elements.shape(leaves_[i]).area * gray(direct_[i]);
  return sum;
}

}  // namespace deltalux::engine
