// The mesh of a solve over lines: top-down from the input level, by a patch's own first samples.
#include <algorithm>
#include <bit>

#include "base/parallel.hpp"
#include "engine/line_solve.hpp"
#include "hierarchy/patch.hpp"
#include "lines/tuning.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kPatches = 16;  // of a task [task]

/// By the points that are known to be open; a little where none is, so that the leaf shows what is beside it.
void setExposed(LineSolve& x, hierarchy::ElementId patch) {
  const lines::LeafScale& scale = x.samples.scale[patch.index()];
  if (scale.known == 0) return;
  const auto open = static_cast<float>(static_cast<int>(scale.known) - std::popcount(scale.covered));
  x.s.elements.geometry[patch.index()].exposed = std::max(0.5f, open) / static_cast<float>(scale.known);
}

/// The samplers of one state of the elements.
struct Samplers {
  explicit Samplers(LineSolve& solve)
      : x(solve),
        meter(x.s.elements, x.tracer, x.cover, x.enclosed),
        direct(x.s.elements, x.s.scene, *x.s.tracer, x.lamps, x.s.settings.error),
        slot(lines::slotWidth(x.s.scene, x.s.elements.sceneBox.diagonal())) {}

  /// Rays that were traced.
  std::uint64_t measure(hierarchy::ElementId patch) const {
    lines::LeafScale& scale = x.samples.scale[patch.index()];
    if (scale.known > 0) return 0;
    if (x.known && x.known->takeScale(x.s.elements, x.s.scene, patch, x.samples)) {
      setExposed(x, patch);
      return 0;
    }
    auto& first = x.samples.first[patch.index()] = std::make_unique<lines::FirstLines>();
    scale = meter.measure(patch, *first);
    setExposed(x, patch);
    return scale.rays;
  }

  /// Direct light of what is not split.
  std::uint64_t light(hierarchy::ElementId patch) const {
    const std::size_t e = patch.index();
    const lines::LeafScale& scale = x.samples.scale[e];
    const direct::LampSight above = sightAbove(x.samples, x.s.elements, patch);
    x.samples.evaluated[e].reset();
    std::unique_ptr<WholeLight> light =
        x.known ? x.known->takeWhole(x.s.elements, direct, patch, scale, above) : nullptr;
    const bool known = light != nullptr;
    if (!known)
      light = std::make_unique<WholeLight>(WholeLight{direct.at(patch, {scale.covered, scale.known}, above), above});
    x.samples.direct[e] = light->light;
    x.samples.whole[e] = std::move(light);
    return known ? 0 : x.samples.direct[e].rays;
  }
  /// Direct light, or what of it tells that the patch is to be split: by `choose`.
  std::uint64_t light(hierarchy::ElementId patch, const direct::DirectSampler::Splits& choose) const {
    using enum direct::DirectSampler::Choice;
    const std::size_t e = patch.index();
    const lines::LeafScale& scale = x.samples.scale[e];
    const direct::LampSight above = sightAbove(x.samples, x.s.elements, patch);
    std::unique_ptr<EvaluatedLight>& evaluated = x.samples.evaluated[e];
    if (x.known) {
      const KnownSolve::Evaluated before = x.known->evaluated(x.s.elements, direct, patch, scale, above);
      const auto choice = before.how ? choose((*before.how)->found) : Whole;
      if (before.how && choice == (*before.how)->choice) {
        evaluated = std::move(*before.how), x.samples.direct[e] = std::move(*before.light);
        return 0;
      }
      if (before.how && choice == Split) {  // by what was asked so far
        evaluated = std::move(*before.how), evaluated->choice = choice;
        const direct::LeafDirect& found = evaluated->found;
        x.samples.direct[e] = {found.E,    found.deviation, found.variation,     found.tooWideForBeam,
                               found.rays, found.sight,     before.light->drawn, std::move(before.light->lamps)};
        return 0;
      }
    }
    evaluated = std::make_unique<EvaluatedLight>(EvaluatedLight{{}, above, Whole});
    x.samples.direct[e] = direct.at(patch, {scale.covered, scale.known}, above, [&](const direct::LeafDirect& found) {
      evaluated->found = found;
      return evaluated->choice = choose(found);
    });
    return x.samples.direct[e].rays;
  }

  LineSolve& x;
  lines::ScaleMeter meter;
  direct::DirectSampler direct;
  double slot;  // see lines::tooWide()
};

/// Whether a patch is to be split; adds the rays that tell.
bool splits(const Samplers& samplers, hierarchy::ElementId patch, std::uint64_t& rays) {
  LineSolve& x = samplers.x;
  const hierarchy::ElementGeometry& g = x.s.elements.shape(patch);
  const double error = x.s.settings.error;
  const hierarchy::ElementLight& coarse = x.s.elements.radiometry[patch.index()];
  rays += samplers.measure(patch);
  const double dim = x.floor > 0 ? gray(coarse.indirect + coarse.direct) / x.floor : 1.0;
  if (lines::tooWide(g, x.samples.scale[patch.index()], error, dim, samplers.slot)) return true;
  // Where a wall crosses a patch, light of one side would come out on the other.
  if (hierarchy::wallsAcross(x.s.elements, x.s.scene, patch)) return true;
  bool split = false;
  rays += samplers.light(patch, [&](const direct::LeafDirect& light) {
    const double level = std::max<double>(gray(light.E + coarse.indirect), x.floor);
    const auto choice = direct::choiceOf(light, g, g.meanFreePath, level, error);
    split = choice == direct::DirectSampler::Choice::Split;
    return choice;
  });
  return split;
}

}  // namespace

direct::LampSight sightAbove(const PatchSamples& samples, const hierarchy::Elements& elements,
                             hierarchy::ElementId patch) {
  const hierarchy::ElementId above = elements.at(patch).parent;
  return above.valid() ? samples.direct[above.index()].sight : direct::LampSight{};
}

void samplePatches(LineSolve& x, std::span<const hierarchy::ElementId> patches) {
  x.samples.resize(x.s.elements.size());
  const Samplers samplers(x);
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(patches.size(), kPatches, [&](std::size_t i) {
    return x.takesPart(patches[i]) ? samplers.measure(patches[i]) + samplers.light(patches[i]) : 0;
  });
}

bool refineMesh(LineSolve& x, std::vector<hierarchy::ElementId> patches, const std::function<bool()>& stop) {
  hierarchy::Elements& elements = x.s.elements;
  while (!patches.empty()) {
    x.samples.resize(elements.size());
    std::vector<char> split(patches.size(), 0);
    {
      const Samplers samplers(x);
      x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(patches.size(), kPatches, [&](std::size_t i) {
        std::uint64_t rays = 0;
        if (x.takesPart(patches[i])) split[i] = splits(samplers, patches[i], rays);
        return rays;
      });
    }
    const bool stopped = stop();
    std::vector<hierarchy::ElementId> chosen, parts, whole;
    for (std::size_t i = 0; i < patches.size(); ++i)
      if (split[i]) chosen.push_back(patches[i]);
    const std::vector<char> done = stopped ? std::vector<char>(chosen.size(), false)
                                           : hierarchy::subdivide(elements, x.s.scene, chosen,
                                                                  x.known ? x.known->parts(elements, chosen) : nullptr);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!done[i]) {
        whole.push_back(chosen[i]);
        continue;
      }
      // Corners of what sees far are no narrow places.
      const float wide = static_cast<float>(lines::tuning::kSurroundings) * x.samples.scale[chosen[i].index()].mean;
      for (std::size_t c = 0; c < elements.at(chosen[i]).childCount; ++c) {
        const hierarchy::ElementId part = elements.child(chosen[i], c);
        float& path = elements.geometry[part.index()].meanFreePath;
        path = std::max(path, wide);
        parts.push_back(part);
      }
    }
    samplePatches(x, whole);
    if (stopped) return false;
    patches = std::move(parts);
  }
  return true;
}

}  // namespace deltalux::engine
