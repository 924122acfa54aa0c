// caustics_bench particles NAME SCENE OBJECT ERROR [LEAST MOST]
// caustics_bench solve NAME SCENE ERROR
//
// Caustic textures, as CSV rows: scene, error, particles, measure, value, unit.
//   particles    the textures of one object's surface against the truth, as the number of particles grows by factors of
//                four. Truth: the mean of 16 times the most particles with another seed over a grid of 128 x 128
//                texels, less its own noise. Differences are root mean square, of gray irradiance, over its mean. The
//                paper's way with its fixed values beside ours.
//   solve        textures of a whole solution: how many, texels, time, share of the solve.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <stdexcept>

#include "caustics/adaptive_textures.hpp"
#include "paper/caustic_textures.hpp"
#include "solution/solution.hpp"

namespace deltalux::bench {
namespace {

constexpr int kTruthTexels = 128;

double cpuSeconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

void row(const std::string& scene, double error, std::uint64_t particles, const char* measure, double value,
         const char* unit) {
  fmt::print("{},{},{},{},{:.6g},{}\n", scene, error, particles, measure, value, unit);
  std::fflush(stdout);
}

Engine solved(const std::string& file, double error, std::uint64_t particles, std::uint64_t seed) {
  SolveSettings settings;
  settings.error = error, settings.particles = particles, settings.seed = seed;
  Engine engine(loadScene({file}).scene, settings);
  engine.solve();
  return engine;
}

/// The front of the first primitive of an object, and what was deposited there.
struct PlacedDeposits {
  Shape shape;
  std::vector<particles::Impact> impacts;
};

PlacedDeposits depositsOn(const Solution& s, const std::string& object) {
  const std::vector<ObjectId> found = findObjects(s.scene, object);
  if (found.empty()) throw std::runtime_error("no object named " + object);
  const std::vector<PrimitiveId> primitives = primitivesOf(s.scene, found.front());
  if (primitives.empty()) throw std::runtime_error("an object without surfaces: " + object);
  PlacedDeposits deposited{s.scene[primitives.front()].shape, {}};
  for (const particles::Impact& impact : particles::impacts(s.particles, s.elements, s.scene))
    if (impact.primitive == primitives.front() && impact.front) deposited.impacts.push_back(impact);
  return deposited;
}

Vec2 gridPoint(int x, int y, int size) { return {(x + 0.5) / size, (y + 0.5) / size}; }

/// Gray irradiance by texels of the surface's parameters, and the variance of its noise.
struct Truth {
  std::vector<double> E, variance;

  explicit Truth(const PlacedDeposits& deposited) : E(kTruthTexels * kTruthTexels, 0.0), variance(E.size(), 0.0) {
    const double texel = area(deposited.shape) / static_cast<double>(E.size());
    for (const particles::Impact& impact : deposited.impacts) {
      const int x = std::min(static_cast<int>(impact.uv.x * kTruthTexels), kTruthTexels - 1);
      const int y = std::min(static_cast<int>(impact.uv.y * kTruthTexels), kTruthTexels - 1);
      const double g = gray(impact.flux) / texel;
      E[y * kTruthTexels + x] += g, variance[y * kTruthTexels + x] += g * g;
    }
  }

  /// Relative root mean square difference of the textures' mean over each texel.
  double difference(const caustics::SurfaceCaustics& s, const Shape& shape) const {
    constexpr int samples = 4;
    double squares = 0, mean = 0;
    for (int y = 0; y < kTruthTexels; ++y)
      for (int x = 0; x < kTruthTexels; ++x) {
        double shown = 0;
        for (int k = 0; k < samples * samples; ++k) {
          const Vec2 uv = gridPoint(x * samples + k % samples, y * samples + k / samples, kTruthTexels * samples);
          shown += gray(s.irradianceAt(pointAt(shape, uv))) / (samples * samples);
        }
        const double d = shown - E[y * kTruthTexels + x];
        squares += d * d - variance[y * kTruthTexels + x];
        mean += E[y * kTruthTexels + x];
      }
    const double count = static_cast<double>(E.size());
    return std::sqrt(std::max(squares, 0.0) / count) / (mean / count);
  }
};

std::size_t texelsOf(const caustics::SurfaceCaustics& s) {
  std::size_t sum = 0;
  for (const caustics::CausticTexture& t : s.textures) sum += t.texels.size();
  return sum;
}

void growParticles(const std::string& name, const std::string& file, const std::string& object, double error,
                   std::uint64_t least, std::uint64_t most) {
  const Truth truth(depositsOn(solved(file, error, 16 * most, 2).solution().get(), object));
  const auto measure = [&](std::uint64_t n, const char* way, double seconds,
                           const std::optional<caustics::SurfaceCaustics>& s, const Shape& shape) {
    if (!s) return;
    row(name, error, n, fmt::format("{}: difference", way).c_str(), truth.difference(*s, shape), "");
    row(name, error, n, fmt::format("{}: texels", way).c_str(), static_cast<double>(texelsOf(*s)), "");
    row(name, error, n, fmt::format("{}: processor time", way).c_str(), seconds, "s");
  };
  for (std::uint64_t n = least; n <= most; n *= 4) {
    const PlacedDeposits deposited = depositsOn(solved(file, error, n, 1).solution().get(), object);
    row(name, error, n, "impacts", static_cast<double>(deposited.impacts.size()), "");
    const double begin = cpuSeconds();
    const auto ours = caustics::makeCausticTextures(deposited.shape, deposited.impacts, {error, 0});
    const double middle = cpuSeconds();
    const auto papers = paper::makeTextures(deposited.shape, deposited.impacts);
    measure(n, "adaptive", middle - begin, ours, deposited.shape);
    measure(n, "paper", cpuSeconds() - middle, papers, deposited.shape);
  }
}

void measureSolve(const std::string& name, const std::string& file, double error) {
  const Engine engine = solved(file, error, 0, 1);
  const SolveReport& report = engine.solution().report();
  const std::uint64_t n = report.counts.particles;
  std::size_t texels = 0;
  for (const caustics::SurfaceCaustics& s : engine.solution().get().caustics.surfaces) texels += texelsOf(s);
  row(name, error, n, "textures", static_cast<double>(report.counts.causticTextures), "");
  row(name, error, n, "mean size", report.counts.causticTextureMeanSize, "texels a side");
  row(name, error, n, "texels", static_cast<double>(texels), "");
  row(name, error, n, "memory", static_cast<double>(report.memory.textures) / 1048576.0, "MiB");
  row(name, error, n, "time", report.times.textures, "s");
  row(name, error, n, "share of the solve", 100 * report.times.textures / report.times.total, "%");
}

int run(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const auto number = [&](std::size_t i) { return std::stod(arguments.at(i)); };
  if (arguments.size() >= 5 && arguments[0] == "particles")
    growParticles(arguments[1], arguments[2], arguments[3], number(4),
                  arguments.size() > 5 ? static_cast<std::uint64_t>(number(5)) : 25000,
                  arguments.size() > 6 ? static_cast<std::uint64_t>(number(6)) : 400000);
  else if (arguments.size() == 4 && arguments[0] == "solve")
    measureSolve(arguments[1], arguments[2], number(3));
  else
    throw std::runtime_error("see the head of caustics_bench.cpp for its arguments");
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  try {
    return deltalux::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "caustics_bench: {}\n", error.what());
    return 1;
  }
}
