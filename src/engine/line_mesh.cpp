// The mesh of a solve over lines: top-down from the input level, by a patch's own first samples.
#include <algorithm>
#include <bit>

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "engine/line_solve.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/tuning.hpp"
#include "lines/scene_widths.hpp"

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
  LineSolve& x;
  lines::ScaleMeter meter;
  direct::DirectSampler direct;
  double room;  // see lines::tooWide()

  explicit Samplers(LineSolve& solve)
      : x(solve),
        meter(x.s.elements, x.tracer, x.cover, x.enclosed),
        direct(x.s.elements, x.s.scene, *x.s.tracer, x.lamps, x.s.settings.error),
        room(lines::widthsOf(x.s.scene, x.s.elements.sceneBox).room) {}

  /// Rays that were traced.
  std::uint64_t measure(hierarchy::ElementId patch) const {
    const std::size_t e = patch.index();
    if (std::exchange(x.measured[e], true)) return 0;
    lines::LeafScale& scale = x.samples.scale[e];
    std::unique_ptr<lines::FirstLines>& first = x.samples.first[e];
    if (x.known && first && x.known->holdsScale(x.s.elements, x.s.scene, patch, *first)) {
      setExposed(x, patch);
      return 0;
    }
    x.samples.walled[e] = PatchSamples::Walled::Unasked;
    const lines::LeafScale before = scale;
    first = std::make_unique<lines::FirstLines>();
    scale = meter.measure(patch, *first);
    if (before.covered != scale.covered || before.known != scale.known) x.samples.forgetLight(e);
    setExposed(x, patch);
    return scale.rays;
  }

  bool walled(hierarchy::ElementId patch) const {
    using enum PatchSamples::Walled;
    PatchSamples::Walled& walled = x.samples.walled[patch.index()];
    if (walled == Unasked) walled = hierarchy::wallsAcross(x.s.elements, x.s.scene, patch) ? Yes : No;
    return walled == Yes;
  }
  /// Direct light of what is not split.
  std::uint64_t light(hierarchy::ElementId patch) const {
    const std::size_t e = patch.index();
    const std::uint64_t rays = measureLight(patch, x.samples.whole[e]);
    x.samples.direct[e] = x.samples.whole[e]->light;
    return rays;
  }
  /// The same of the input level, for the coarse light.
  std::uint64_t coarseLight(hierarchy::ElementId patch) const {
    return measureLight(patch, x.samples.coarse[patch.index()]);
  }
  /// A patch is split whatever its light: its parts know of lamps what the coarse light has found.
  void leaveLight(hierarchy::ElementId patch) const {
    const std::size_t e = patch.index();
    x.samples.evaluated[e].reset(), x.samples.direct[e] = {};
    if (x.samples.coarse[e]) x.samples.direct[e].sight = x.samples.coarse[e]->light.sight;
  }
  /// Direct light, or what of it tells that the patch is to be split: by `choose`.
  std::uint64_t light(hierarchy::ElementId patch, const direct::DirectSampler::Splits& choose) const {
    using enum direct::DirectSampler::Choice;
    const std::size_t e = patch.index();
    const lines::LeafScale& scale = x.samples.scale[e];
    const direct::LampSight above = sightAbove(x.samples, x.s.elements, patch);
    std::unique_ptr<EvaluatedLight>& evaluated = x.samples.evaluated[e];
    direct::LeafDirect& light = x.samples.direct[e];
    std::uint64_t rays = 0;
    if (x.known && evaluated &&
        x.known->holdsLight(x.s.elements, direct, patch, scale, evaluated->above, above, light, rays)) {
      const auto choice = choose(evaluated->found);
      if (choice == evaluated->choice) {
        if (choice == Split) light.sight = evaluated->found.sight;
        return rays;
      }
      if (choice == Split) {  // by what was asked so far
        evaluated->choice = choice;
        const direct::LeafDirect& found = evaluated->found;
        light = {found.E,     found.deviation, found.variation, found.tooWideForBeam,  found.rays,
                 found.sight, light.drawn,     found.found,     std::move(light.lamps)};
        return rays;
      }
    }
    const direct::DirectSampler::KnownShadows shadows = evaluated ? shadowsBefore(patch, light) : shadowsOfCoarse(e);
    evaluated = std::make_unique<EvaluatedLight>(EvaluatedLight{{}, above, Whole});
    const auto chooseByFound = [&](const direct::LeafDirect& found) {
      evaluated->found = found;
      return evaluated->choice = choose(found);
    };
    light = direct.at(patch, {scale.covered, scale.known}, above, chooseByFound, shadows.holds ? &shadows : nullptr);
    return rays + light.rays;
  }

 private:
  /// Of shadow rays that came to some light before.
  direct::DirectSampler::KnownShadows shadowsBefore(hierarchy::ElementId patch, const direct::LeafDirect& light) const {
    if (!x.known) return {};
    return {light.lamps, x.known->shadowsThatHold(x.s.elements, direct.lamps(), patch)};
  }
  /// The same of the coarse light of this scene.
  direct::DirectSampler::KnownShadows shadowsOfCoarse(std::size_t e) const {
    if (!x.samples.coarse[e]) return {};
    return {x.samples.coarse[e]->light.lamps, [](const direct::Lamp&, const tracing::Ray&) { return true; }};
  }
  std::uint64_t measureLight(hierarchy::ElementId patch, std::unique_ptr<WholeLight>& whole) const {
    const lines::LeafScale& scale = x.samples.scale[patch.index()];
    const direct::LampSight above = sightAbove(x.samples, x.s.elements, patch);
    std::uint64_t rays = 0;
    const bool holds = x.known && whole &&
                       x.known->holdsLight(x.s.elements, direct, patch, scale, whole->above, above, whole->light, rays);
    if (!holds) {
      direct::DirectSampler::KnownShadows shadows;
      if (whole) shadows = shadowsBefore(patch, whole->light);
      whole = std::make_unique<WholeLight>(WholeLight{
          direct.at(patch, {scale.covered, scale.known}, above, {}, shadows.holds ? &shadows : nullptr), above});
    }
    return holds ? rays : rays + whole->light.rays;
  }
};

/// Asks memory for what is known of the patch that comes next, while one is looked at.
void fetch(const PatchSamples& samples, hierarchy::ElementId patch) {
  if (const lines::FirstLines* first = samples.first[patch.index()].get()) prefetch(std::span(first, 1));
  if (const EvaluatedLight* light = samples.evaluated[patch.index()].get()) prefetch(std::span(light, 1));
}

/// Whether a patch is to be split; adds the rays that tell.
bool splits(const Samplers& samplers, hierarchy::ElementId patch, std::uint64_t& rays) {
  LineSolve& x = samplers.x;
  const hierarchy::ElementGeometry& g = x.s.elements.shape(patch);
  const double error = x.s.settings.error;
  const hierarchy::ElementLight& coarse = x.s.elements.radiometry[patch.index()];
  rays += samplers.measure(patch);
  const double dim = x.floor > 0 ? gray(coarse.indirect + coarse.direct) / x.floor : 1.0;
  // Where a wall crosses a patch, light of one side would come out on the other.
  if (lines::tooWide(g, x.samples.scale[patch.index()], error, dim, samplers.room) || samplers.walled(patch)) {
    samplers.leaveLight(patch);
    return true;
  }
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

void sampleInputs(LineSolve& x, std::span<const hierarchy::ElementId> inputs) {
  x.resizeSamples();
  const Samplers samplers(x);
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(inputs.size(), kPatches, [&](std::size_t i) {
    if (x.takesPart(inputs[i])) return samplers.measure(inputs[i]) + samplers.coarseLight(inputs[i]);
    x.samples.forget(inputs[i].index());
    return std::uint64_t(0);
  });
}

void samplePatches(LineSolve& x, std::span<const hierarchy::ElementId> patches) {
  x.resizeSamples();
  const Samplers samplers(x);
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(patches.size(), kPatches, [&](std::size_t i) {
    return x.takesPart(patches[i]) ? samplers.measure(patches[i]) + samplers.light(patches[i]) : 0;
  });
}

bool refineMesh(LineSolve& x, std::vector<hierarchy::ElementId> patches, const std::function<bool()>& stop) {
  hierarchy::Elements& elements = x.s.elements;
  while (!patches.empty()) {
    x.resizeSamples();
    std::vector<char> split(patches.size(), 0);
    {
      const Samplers samplers(x);
      x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(patches.size(), kPatches, [&](std::size_t i) {
        std::uint64_t rays = 0;
        if (i + 1 < patches.size()) fetch(x.samples, patches[i + 1]);
        if (x.takesPart(patches[i])) split[i] = splits(samplers, patches[i], rays);
        return rays;
      });
    }
    const bool stopped = stop();
    std::vector<hierarchy::ElementId> chosen, parts, whole;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (split[i])
        chosen.push_back(patches[i]);
      else
        x.samples.whole[patches[i].index()].reset();  // nobody has asked for that
    }
    const std::vector<char> done =
        stopped ? std::vector<char>(chosen.size(), false) : hierarchy::subdivide(elements, x.s.scene, chosen);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!done[i]) {
        whole.push_back(chosen[i]);
        continue;
      }
      x.samples.whole[chosen[i].index()].reset();
      // Corners of what sees far are no narrow places.
      const float wide = hierarchy::tuning::kNarrowPlace * x.samples.scale[chosen[i].index()].mean;
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
