#pragma once
// Solutions of small scenes, and what is measured on them.
#include <algorithm>
#include <bit>
#include <deltalux/engine.hpp>
#include <deltalux/render.hpp>

#include "base/random.hpp"
#include "solution/solution.hpp"
#include "support/rooms.hpp"

namespace deltalux::test {

inline double lux(const ProbeResult& r) { return photometric(r.irradiance, kLuminousEfficacy); }
inline Rgb fromPhotometric(double value) { return Rgb(static_cast<float>(value / kLuminousEfficacy)); }

inline Engine solved(Scene scene, double error = 0.01, SolveMethod method = SolveMethod::Lines) {
  SolveSettings settings;
  settings.error = error, settings.method = method;
  Engine engine(std::move(scene), settings);
  engine.solve();
  return engine;
}

/// For tests of what holds at any error: soon done.
inline SolveSettings coarse() {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 20000;
  return settings;
}

/// Of its mesh, and where all lines and particles go.
inline std::uint64_t hashOf(const Engine& engine) {
  const SolutionHashes hashes = hashesOf(engine.solution().get());
  return combineKeys(combineKeys(hashes.mesh, hashes.lines), hashes.particles);
}

/// Of the direct light of its leaves.
inline std::uint64_t directHashOf(const Engine& engine) {
  const hierarchy::Elements& e = engine.solution().get().elements;
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (!e.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    std::uint64_t own = e.key[i];
    for (int c = 0; c < 3; ++c) own = combineKeys(own, std::bit_cast<std::uint32_t>(e.radiometry[i].direct[c]));
    hash += own;  // in any order
  }
  return hash;
}

/// Whether mesh, lines, particles and direct light are those of a fresh solve of its scene.
inline bool isTheFreshOne(const Engine& engine) {
  Engine fresh(engine.solution().scene(), engine.solution().settings());
  fresh.solve();
  return hashOf(engine) == hashOf(fresh) && directHashOf(engine) == directHashOf(fresh);
}

/// Shadow rays until their own error is a fraction of one per cent.
inline std::vector<ProbeResult> measure(const Engine& engine, const std::vector<ProbePoint>& points) {
  ProbeSettings settings;
  settings.error = 0.002, settings.maxSamples = 1 << 16;
  return probe(engine.solution(), points, settings);
}

/// Area mean of E over the leaves on the front of a primitive. [W/m2]
inline double meshMean(const Engine& engine, PrimitiveId primitive) {
  const hierarchy::Elements& e = engine.solution().get().elements;
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const hierarchy::ElementTopology& t = e.topology[i];
    if (t.kind != hierarchy::ElementKind::Patch || t.emitter || t.childCount > 0 || !t.front) continue;
    if (e.domain[i].primitive != primitive) continue;
    sum += double(e.geometry[i].area) * gray(e.radiometry[i].direct + e.radiometry[i].indirect);
    area += e.geometry[i].area;
  }
  return sum / area;
}

/// What arrives at all leaves, of any light. [W, gray, with the scene's unit squared as area]
inline double arrivingPower(const Engine& engine) {
  const hierarchy::Elements& e = engine.solution().get().elements;
  double power = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const hierarchy::ElementLight& l = e.radiometry[i];
    if (e.isReceivingLeaf(hierarchy::ElementId(i)))
      power += e.geometry[i].litArea() * gray(l.direct + l.indirect + l.particle);
  }
  return power;
}

struct Spread {
  double median, p95;
};
inline Spread spreadOf(std::vector<double> differences) {
  std::sort(differences.begin(), differences.end());
  return {differences[differences.size() / 2], differences[differences.size() * 95 / 100]};
}

}  // namespace deltalux::test
