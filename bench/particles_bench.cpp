// particles_bench NAME SCENE COUNT [MIRROR-FLUX.csv]
//
// The particles of a scene, as CSV rows: scene, particles asked for, measure, value, unit. Times are the least of
// several, in turns with the same rays traced raw in batches: processor time of all threads, and what a clock on the
// wall says; "rays" counts those that decided about links, too. With a file of fluxes, the flux from the sun over a
// mirror onto the wall behind x = 0.06, against the file's line of the sum.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deltalux/io.hpp>
#include <deltalux/report.hpp>
#include <exception>
#include <fstream>
#include <sstream>

#include "base/parallel.hpp"
#include "particles/particles.hpp"
#include "stopwatch.hpp"

namespace deltalux {
namespace {

constexpr int kRounds = 3;
constexpr std::size_t kBlock = 1024;

/// The segments of all paths as rays.
std::vector<tracing::Ray> raysOf(const particles::Particles& p) {
  std::vector<tracing::Ray> rays;
  for (std::size_t i = 0; i < p.paths(); ++i) {
    const auto path = p.verticesOf(i);
    for (std::size_t v = 0; v + 1 < path.size(); ++v) {
      const Vec3f d = path[v + 1] - path[v];
      const float length = glm::length(d);
      if (!(length > 0)) continue;
      tracing::Ray ray;
      ray.direction = d / length;
      ray.origin = path[v] + 1e-5f * length * ray.direction;
      rays.push_back(ray);
    }
  }
  return rays;
}

double rawSeconds(const tracing::RayTracer& tracer, const std::vector<tracing::Ray>& rays) {
  std::vector<tracing::Hit> hits(rays.size());
  const double start = bench::processorSeconds();
  parallelBlocks(rays.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    tracer.closestHits(std::span(rays).subspan(begin, end - begin), std::span(hits).subspan(begin, end - begin));
  });
  return bench::processorSeconds() - start;
}

/// Flux of first impacts, beyond x = 0.06, of paths from a sun over a Mirror.
RgbSum mirrorFlux(const particles::Particles& p, const Scene& scene, const tracing::RayTracer& tracer) {
  RgbSum sum(0.0);
  for (std::size_t i = 0; i < p.paths(); ++i) {
    if (p.senderCells[p.sender[i]].kind != particles::SenderKind::Sun || p.range[i].impacts == 0) continue;
    const auto v = p.verticesOf(i);
    const Vec3f from = v[0], to = v[1];
    tracing::Ray ray;
    ray.direction = glm::normalize(from - to);
    ray.origin = to + 0.01f * ray.direction;
    ray.direction = -ray.direction;
    const tracing::Hit hit = tracer.closestHit(ray);
    if (!hit || !std::holds_alternative<Mirror>(scene.materialOf(hit.primitive).surface)) continue;
    const std::uint32_t first = p.firstImpact(i);
    if (std::abs(v[2].x) < 0.06f) sum += double(p.links[p.link[i]].scale) * RgbSum(p.throughput[first]);
  }
  return sum;
}

RgbSum expectedFlux(const char* file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("WESTWALL_sum")) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::string name;
    RgbSum flux(0.0);
    fields >> name >> flux.r >> flux.g >> flux.b;
    return flux;
  }
  throw std::runtime_error(std::string(file) + " has no line WESTWALL_sum");
}

/// Of as many impacts of one flux, how many would make the same relative variance of their sum.
double effectiveShare(const particles::Particles& p) {
  double sum = 0, squares = 0;
  for (std::size_t path = 0; path < p.paths(); ++path)
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      const double w = p.weight(path) * gray(p.throughput[i]);
      sum += w, squares += w * w;
    }
  return sum * sum / squares / static_cast<double>(p.impacts());
}

void run(int argc, char** argv) {
  Scene scene = loadScene({argv[2]}).scene;
  addAreaLights(scene);
  const auto tracer = tracing::makeEmbreeTracer(scene);
  particles::ParticleSettings settings;
  settings.count = std::strtoull(argv[3], nullptr, 10);
  const auto row = [&](const char* measure, double value, const char* unit) {
    fmt::print("{},{},{},{:.6g},{}\n", argv[1], settings.count, measure, value, unit);
  };
  double seconds = 1e30, wall = 1e30, raw = 1e30;
  particles::Particles p;
  std::size_t segments = 0;
  for (int round = 0; round < kRounds; ++round) {
    p = {};  // not what it takes to free it
    const bench::Stopwatch watch;
    p = particles::traceParticles(scene, *tracer, settings);
    seconds = std::min(seconds, watch.processor()), wall = std::min(wall, watch.wall());
    const std::vector<tracing::Ray> rays = raysOf(p);
    segments = rays.size();
    raw = std::min(raw, rawSeconds(*tracer, rays));
  }
  validate(p, scene);
  const auto all = static_cast<double>(p.rays + p.pilots);
  const double rawOfAll = raw * all / static_cast<double>(segments);
  row("links", static_cast<double>(p.links.size()), "");
  row("samples", static_cast<double>(p.paths()), "");
  row("particles", static_cast<double>(p.arrived()), "");
  row("deposited", static_cast<double>(p.deposited()), "");
  row("impacts", static_cast<double>(p.impacts()), "");
  row("effective share of impacts", 100 * effectiveShare(p), "%");
  row("rays", all, "");
  row("processor time", seconds, "s");
  row(fmt::format("wall time on {} threads", tbb::this_task_arena::max_concurrency()).c_str(), wall, "s");
  row("processor time of the rays alone", rawOfAll, "s");
  row("ratio", seconds / rawOfAll, "");
  row("memory", static_cast<double>(p.memoryBytes()) / 1048576.0, "MiB");
  row("ended by the depth limit", static_cast<double>(p.cut()), "");
  const particles::ParticleLedger ledger = p.ledger();
  row("ledger residue of the flux in it", 100 * ledger.residue() / (ledger.entered + ledger.passed), "%");
  if (argc > 4) {
    const RgbSum expected = expectedFlux(argv[4]), found = mirrorFlux(p, scene, *tracer);
    row("flux from the mirror onto the west wall", gray(found), "W");
    row("its difference", 100 * (gray(found) / gray(expected) - 1), "%");
  }
}

}  // namespace
}  // namespace deltalux

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: particles_bench NAME SCENE COUNT [MIRROR-FLUX.csv]\n", stderr);
    return 2;
  }
  try {
    deltalux::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "particles_bench: {}\n", error.what());
    return 1;
  }
}
