#include "engine/solve_lines.hpp"

#include <bit>
#include <chrono>
#include <deltalux/error.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "caustics/choice.hpp"
#include "direct/leaf_direct.hpp"
#include "direct/sky_light.hpp"
#include "engine/particle_count.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "lines/iterate.hpp"
#include "lines/leaf_scale.hpp"
#include "lines/line_counts.hpp"
#include "lines/tuning.hpp"
#include "particles/mesh_for_particles.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/transfer.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kPatches = 16;  // of a task

class Stopwatch {
 public:
  /// Seconds since the last lap, or the start.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// What is known of a patch before its lines: by element.
struct PatchSamples {
  std::vector<lines::LeafScale> scale;
  std::vector<direct::LeafDirect> direct;

  void resize(std::size_t elements) { scale.resize(elements), direct.resize(elements); }
};

/// Everything that the stages share.
struct LineSolve {
  LineSolve(Solution& solution)
      : s(solution),
        responses(s.scene, !s.settings.diffuseOnly),
        tracer(s.scene, *s.tracer, responses),
        cover(s.scene, *s.tracer),
        lamps(s.scene),
        skies(s.scene) {}

  Solution& s;
  lines::SurfaceResponses responses;
  lines::LineTracer tracer;
  lines::Cover cover;
  direct::Lamps lamps;
  direct::Skies skies;
  std::vector<char> enclosed;  // by element of the input level
  PatchSamples samples;

  bool takesPart(hierarchy::ElementId patch) const {
    return !enclosed[hierarchy::surfaceOf(s.elements, patch).index()];
  }
};

void checkInterrupted(Progress* progress) {
  if (progress && progress->stopRequested()) throw Interrupted();
}

/// Light of the leaves there are, over `base` lines each: writes direct and indirect irradiance of their elements.
/// Returns the lines.
lines::Lines lightLeaves(LineSolve& x, const hierarchy::LeafTable& leaves, std::uint32_t base, double converged,
                         std::vector<float>& deviation) {
  hierarchy::Elements& elements = x.s.elements;
  const std::size_t n = leaves.size();
  std::vector<float> power(n);
  parallelFor(n, 1024, [&](std::size_t i) {
    const hierarchy::ElementLight& l = elements.radiometry[leaves[i].index()];
    power[i] = elements.shape(leaves[i]).area * gray((l.rho + l.tau) * (x.samples.direct[leaves[i].index()].E + l.particle));
  });
  const std::vector<std::uint32_t> counts = lines::lineCounts(elements, leaves, power, x.enclosed, base);
  const hierarchy::LeafLocator locator(elements, x.s.scene, leaves);
  lines::TracedLines traced =
      lines::traceLines({elements, leaves, locator, x.tracer, x.cover, x.enclosed}, counts);
  DELTALUX_VALIDATED(validate(traced.lines));
  x.s.report.counts.raysVisibility += traced.rays;
  lines::Exchange exchange(traced.lines, elements, leaves, x.tracer, traced.covered);
  lines::LeafLight light = lines::leafLight(elements, leaves);

  // Sources: suns and lamps from before, skies now that lines tell where they are seen.
  std::vector<direct::SkyAtLeaf> sky(n);
  if (!x.skies.empty()) {
    const direct::Openness openness(elements, leaves, counts, [&](const auto& sink) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::uint64_t k = traced.lines.first[i]; k < traced.lines.first[i + 1]; ++k) {
          const std::uint32_t end = traced.lines.end[k];
          if (end != lines::kCovered)
            sink(static_cast<std::uint32_t>(i), direct::SkyCells::of(lines::direction(traced.lines.code[k])),
                 end == lines::kEscaped);
        }
    });
    std::vector<std::uint32_t> first(n + 1, 0);
    for (const lines::EscapedLine& e : traced.escaped) ++first[e.leaf + 1];
    for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];
    parallelFor(n, kPatches, [&](std::size_t i) {
      if (counts[i] == traced.covered[i]) return;
      std::vector<direct::EscapedView> escaped;
      for (std::uint32_t k = first[i]; k < first[i + 1]; ++k) {
        const lines::EscapedLine& e = traced.escaped[k];
        escaped.push_back({e.direction, e.cosine, e.weight, e.chance});
      }
      std::vector<std::uint32_t> points;
      for (std::uint32_t k = 0; k < counts[i] && points.size() < direct::tuning::kSkyRays; ++k)
        if (traced.lines.end[traced.lines.first[i] + k] != lines::kCovered) points.push_back(k);
      sky[i] = direct::skyLight(x.skies, openness, elements, x.s.scene, *x.s.tracer,
                                {static_cast<std::uint32_t>(i), leaves[i], counts[i] - traced.covered[i], escaped, points});
    });
  }
  parallelFor(n, 1024, [&](std::size_t i) {
    const std::size_t e = leaves[i].index();
    hierarchy::ElementLight& l = elements.radiometry[e];
    l.direct = exchange.area(i) > 0 ? x.samples.direct[e].E + sky[i].E : Rgb(0.0f);
    light.source[i] = l.direct + l.particle;
    light.indirect[i] = l.indirect;
  });
  for (const direct::SkyAtLeaf& a : sky) x.s.report.counts.raysVisibility += a.rays;
  const lines::IterationReport iterated =
      lines::iterate(exchange, light, converged, lines::tuning::kMostPasses);
  x.s.report.counts.iterations += static_cast<std::uint64_t>(iterated.passes);
  deviation.resize(n);
  exchange.deviation(light.B, deviation);
  parallelFor(n, 1024, [&](std::size_t i) {
    const std::size_t e = leaves[i].index();
    elements.radiometry[e].indirect = light.indirect[i], elements.radiometry[e].B = light.B[i];
    const double own = deviation[i], sun = x.samples.direct[e].deviation, dome = sky[i].deviation;
    deviation[i] = static_cast<float>(std::sqrt(own * own + sun * sun + dome * dome));
  });
  x.s.report.memory.links = exchange.memoryBytes() + traced.lines.memoryBytes();
  return std::move(traced.lines);
}

/// By the points that are known to be open; a little where none is, so that the leaf shows what is beside it.
void setExposed(LineSolve& x, hierarchy::ElementId patch) {
  const lines::LeafScale& scale = x.samples.scale[patch.index()];
  const int covered = std::popcount(scale.covered), known = static_cast<int>(scale.known);
  if (known == 0) return;
  x.s.elements.geometry[patch.index()].exposed =
      std::max(0.5f, static_cast<float>(known - covered)) / static_cast<float>(known);
}

void sample(LineSolve& x, std::span<const hierarchy::ElementId> patches, bool whole) {
  x.samples.resize(x.s.elements.size());
  const lines::ScaleMeter meter(x.s.elements, x.tracer, x.cover, x.enclosed);
  const direct::DirectSampler direct(x.s.elements, x.s.scene, *x.s.tracer, x.lamps);
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(patches.size(), kPatches, [&](std::size_t i) {
    const hierarchy::ElementId patch = patches[i];
    if (!x.takesPart(patch)) return std::uint64_t{0};
    lines::LeafScale& scale = x.samples.scale[patch.index()];
    if (scale.known == 0) scale = meter.measure(patch);
    setExposed(x, patch);
    x.samples.direct[patch.index()] = direct.at(patch, {scale.covered, scale.known}, whole);
    return std::uint64_t{scale.rays} + x.samples.direct[patch.index()].rays;
  });
}

/// Splits patches, from these down, until indirect and direct light vary over none by more than the error allows.
void refineMesh(LineSolve& x, std::vector<hierarchy::ElementId> patches, double floor) {
  hierarchy::Elements& elements = x.s.elements;
  const double error = x.s.settings.error;
  while (!patches.empty()) {
    x.samples.resize(elements.size());
    std::vector<char> splits(patches.size(), 0);
    {
      const lines::ScaleMeter meter(elements, x.tracer, x.cover, x.enclosed);
      const direct::DirectSampler direct(elements, x.s.scene, *x.s.tracer, x.lamps);
      x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(patches.size(), kPatches, [&](std::size_t i) {
        const hierarchy::ElementId patch = patches[i];
        if (!x.takesPart(patch)) return std::uint64_t{0};
        const hierarchy::ElementGeometry& g = elements.shape(patch);
        lines::LeafScale& scale = x.samples.scale[patch.index()];
        if (scale.known == 0) scale = meter.measure(patch);
        setExposed(x, patch);
        std::uint64_t rays = scale.rays;
        const double known = gray(elements.radiometry[patch.index()].indirect + elements.radiometry[patch.index()].direct);
        if (tooWide(g, scale, error, floor > 0 ? known / floor : 1.0)) {
          splits[i] = 1;
          return rays;
        }
        direct::LeafDirect& light = x.samples.direct[patch.index()];
        light = direct.at(patch, {scale.covered, scale.known}, true);
        rays += light.rays;
        const double level = std::max<double>(gray(light.E + elements.radiometry[patch.index()].indirect), floor);
        splits[i] = light.tooWideForBeam || variesTooMuch(light, g, g.meanFreePath, level, error) ||
                    (hierarchy::wallsAcross(elements, x.s.scene, patch) && g.radius > lines::tuning::kFinestWidth * g.meanFreePath);
        return rays;
      });
    }
    std::vector<hierarchy::ElementId> parts;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (!splits[i] || !hierarchy::subdivide(elements, x.s.scene, patches[i])) {
        if (splits[i]) sample(x, std::span(&patches[i], 1), true);
        continue;
      }
      for (std::size_t c = 0; c < elements.at(patches[i]).childCount; ++c)
        parts.push_back(elements.child(patches[i], c));
    }
    patches = std::move(parts);
  }
}

/// Into cells of which shadow rays to a point choose.
void divideSkies(hierarchy::Elements& elements, const Scene& scene) {
  constexpr int kLevels = 4;
  std::vector<hierarchy::ElementId> cells = elements.distant;
  for (int level = 0; level < kLevels; ++level) {
    std::vector<hierarchy::ElementId> parts;
    for (const hierarchy::ElementId e : cells)
      if (hierarchy::subdivide(elements, scene, e))
        for (std::size_t c = 0; c < elements.at(e).childCount; ++c) parts.push_back(elements.child(e, c));
    cells = std::move(parts);
  }
}

std::vector<hierarchy::ElementId> receivingInputs(const hierarchy::Elements& elements) {
  std::vector<hierarchy::ElementId> inputs;
  for (const hierarchy::ElementId e : elements.inputs)
    if (elements.receives(e)) inputs.push_back(e);
  return inputs;
}

/// Mean gray irradiance over all lit area [W/m2].
double meanIrradiance(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves) {
  double light = 0, area = 0;
  for (const hierarchy::ElementId leaf : leaves.leaves) {
    const hierarchy::ElementLight& l = elements.radiometry[leaf.index()];
    const double A = elements.shape(leaf).litArea();
    light += A * gray(l.direct + l.indirect + l.particle), area += A;
  }
  return area > 0 ? light / area : 0;
}

}  // namespace

void solveByLines(Solution& s, Progress* progress) {
  Stopwatch watch;
  LineSolve x(s);
  if (!s.settings.diffuseOnly) {
    particles::ParticleSettings settings{engine::particleCount(s.settings), s.settings.seed};
    settings.ofSurfaces = false;
    s.particles = particles::ParticleTracing(s.scene, *s.tracer, settings).trace();
    DELTALUX_VALIDATED(validate(s.particles, s.scene));
  }
  s.report.times.particles += watch.lap();
  if (progress) progress->report("particles", 1.0);
  checkInterrupted(progress);

  s.elements = hierarchy::buildElements(s.scene, hierarchy::surfaceSides(s.scene));
  if (!s.elements.sceneRoot.valid()) return;
  x.enclosed = lines::enclosedSides(s.elements, x.tracer, s.report.counts.raysVisibility);
  s.report.times.hierarchy += watch.lap();
  checkInterrupted(progress);

  std::vector<float> deviation;
  const std::vector<hierarchy::ElementId> inputs = receivingInputs(s.elements);
  sample(x, inputs, true);
  lines::setMeanFreePaths(s.elements, x.samples.scale);
  const hierarchy::LeafTable coarse(s.elements);
  lightLeaves(x, coarse, lines::tuning::kFirstLines, 1e-3, deviation);
  for (const hierarchy::ElementId e : inputs) {
    hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    l.typical = gray(l.direct + l.indirect);
  }
  const double floor = direct::tuning::kFloor * meanIrradiance(s.elements, coarse);
  s.report.times.visibility += watch.lap();
  if (progress) progress->report("coarse light", 1.0);
  checkInterrupted(progress);

  refineMesh(x, inputs, floor);
  radiosity::pull(s.elements);
  caustics::SurfaceSides shown(2 * s.scene.primitives.size(), false);
  if (s.particles.impacts() > 0 && s.settings.causticTextures)
    shown = caustics::sidesWithTextures(s.scene, s.elements, particles::impacts(s.particles, s.elements, s.scene),
                                        s.settings.error);
  const std::size_t before = s.elements.size();
  particles::subdivideForParticles(s.elements, s.scene, s.particles, shown);
  std::vector<hierarchy::ElementId> more;
  for (std::size_t i = before; i < s.elements.size(); ++i)
    if (s.elements.isReceivingLeaf(hierarchy::ElementId(i))) more.emplace_back(i);
  sample(x, more, true);
  const particles::ParticleTransfer transfer(s.particles, s.elements, s.scene);
  transfer.apply(s.elements, s.scene);
  s.report.times.refine += watch.lap();
  if (progress) progress->report("mesh", 1.0);
  checkInterrupted(progress);

  divideSkies(s.elements, s.scene);
  const hierarchy::LeafTable leaves(s.elements);
  s.lines = lightLeaves(x, leaves, lines::baseLines(s.settings.error), lines::tuning::kConverged, s.deviation);
  radiosity::pull(s.elements);
  DELTALUX_VALIDATED(validate(s.elements));
  s.report.times.gather += watch.lap();
  if (progress) progress->report("lines", 1.0);
}

}  // namespace deltalux::engine
