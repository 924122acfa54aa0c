#include "direct/sky_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/tuning.hpp"
#include "base/unit_circle.hpp"
#include "direct/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "scene/nominal_scale.hpp"
#include "scene/stops_light.hpp"

namespace deltalux::direct {

namespace {

constexpr int kHeights = kSkySide, kAzimuths = kSkySide;
constexpr std::uint64_t kSkyKey = 0x736b795f5f5full;  // [key]

/// Power of two nearest to a share, none of less than matters.
float octave(float share) {
  return std::exp2(std::round(std::log2(std::clamp(share, static_cast<float>(tuning::kMatters), 1.0f))));
}

void add(std::uint64_t& key, const Rgb& x) {
  for (int c = 0; c < 3; ++c) key = combineKeys(key, std::bit_cast<std::uint32_t>(x[c]));
}

/// The middles and the corners of all cells, one coordinate after the other, as passes over arrays want it.
struct CellLooks {
  using All = std::array<float, SkyCells::kCount>;

  CellLooks() {
    for (int cell = 0; cell < SkyCells::kCount; ++cell)
      for (std::size_t look = 0; look < 5; ++look) {
        const bool corner = look < 4;
        const Vec3f w = SkyCells::direction(cell, corner ? double(look & 1) : 0.5, corner ? double(look >> 1) : 0.5);
        const auto c = static_cast<std::size_t>(cell);
        x[look][c] = w.x, y[look][c] = w.y, z[look][c] = w.z;
      }
  }
  /// Greatest cosine of a direction of each with `normal`, or -1.
  All cosines(const Vec3f& normal) const {
    All most;
    most.fill(-1.0f);
    for (std::size_t look = 0; look < 5; ++look)
      for (std::size_t c = 0; c < most.size(); ++c)
        most[c] = std::max(most[c], normal.x * x[look][c] + normal.y * y[look][c] + normal.z * z[look][c]);
    return most;
  }

  std::array<All, 5> x, y, z;
};

}  // namespace

int SkyCells::of(const Vec3f& direction) {
  const Vec3f w = glm::normalize(direction);
  const int height = std::clamp(static_cast<int>((0.5f * w.z + 0.5f) * kHeights), 0, kHeights - 1);
  const float turn = std::atan2(w.y, w.x) / static_cast<float>(2 * kPi);
  const int azimuth = std::clamp(static_cast<int>((turn - std::floor(turn)) * kAzimuths), 0, kAzimuths - 1);
  return height * kAzimuths + azimuth;
}

Vec3f SkyCells::direction(int cell, double a, double b) {
  const double z = -1 + 2 * (cell / kAzimuths + a) / kHeights;
  return Vec3f(Vec3(std::sqrt(std::max(0.0, 1 - z * z)) * onUnitCircle((cell % kAzimuths + b) / kAzimuths), z));
}

Skies::Skies(const Scene& scene) {
  const std::vector<Rgb> nominal = scene::nominalScales(scene), dimmed = scene::dimming(scene);
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (std::holds_alternative<DomeLight>(scene.lights[i].emitter) && !isBlack(nominal[i])) which.push_back(i);
  if (which.empty()) return;
  alike_ = std::ranges::all_of(which, [&](std::size_t i) { return dimmed[i] == dimmed[which.front()]; });
  if (alike_) dimming_ = dimmed[which.front()];
  for (const std::size_t i : which)
    domes_.push_back({std::get<DomeLight>(scene.lights[i].emitter), alike_ ? nominal[i] : scene.lights[i].scale});
  for (int cell = 0; cell < SkyCells::kCount; ++cell)
    for (const double corner : {0.25, 0.75}) add(key_, radiance(SkyCells::direction(cell, corner, corner)));
  for (int cell = 0; cell < SkyCells::kCount; ++cell)
    strength_[static_cast<std::size_t>(cell)] =
        SkyCells::meanOver(cell, [&](const Vec3f& direction) { return gray(radiance(direction)); });
}

Rgb Skies::radiance(const Vec3f& direction) const {
  Rgb sum(0.0f);
  for (const Dome& d : domes_) sum += d.scale * skyRadiance(d.light, Vec3(direction));
  return sum;
}

SkyVisibility::GuidedLeaves SkyVisibility::placeGuides(const hierarchy::Elements& elements,
                                                       const hierarchy::LeafTable& leaves,
                                                       std::span<const std::uint32_t> linesOf) {
  std::vector<std::uint32_t> below(elements.size(), 0), guide(elements.size(), hierarchy::LeafTable::kNone);
  for (std::size_t i = elements.size(); i-- > 0;) {
    if (leaves.indexOf[i] != hierarchy::LeafTable::kNone) below[i] += linesOf[leaves.indexOf[i]];
    const hierarchy::ElementId parent = elements.topology[i].parent;
    if (parent.valid()) below[parent.index()] += below[i];
  }
  guideOf_.resize(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    hierarchy::ElementId e = leaves[i];
    while (below[e.index()] < kGuideLines && elements.at(e).parent.valid()) e = elements.at(e).parent;
    if (guide[e.index()] == hierarchy::LeafTable::kNone) guide[e.index()] = static_cast<std::uint32_t>(guides_++);
    guideOf_[i] = guide[e.index()];
  }
  GuidedLeaves guided{std::vector<std::uint32_t>(guides_ + 1, 0), std::vector<std::uint32_t>(leaves.size())};
  for (const std::uint32_t g : guideOf_) ++guided.first[g + 1];
  for (std::size_t g = 0; g < guides_; ++g) guided.first[g + 1] += guided.first[g];
  std::vector<std::uint32_t> next(guided.first.begin(), guided.first.end() - 1);
  for (std::size_t i = 0; i < leaves.size(); ++i) guided.leaf[next[guideOf_[i]]++] = static_cast<std::uint32_t>(i);
  return guided;
}

/// Few lines in all guide nothing: each would tell where rays go that it is balanced with, and count for less by that.
void SkyVisibility::setShares(std::size_t guide, const Counts& counts) {
  const bool few = std::accumulate(counts.all.begin(), counts.all.end(), 0.0f) < kGuideLines;
  for (std::size_t c = 0; c < SkyCells::kCount; ++c)
    share_[guide * SkyCells::kCount + c] =
        few ? 1.0f
            : octave((counts.open[c] + deltalux::tuning::kDefensive * tuning::kPrior) /
                     (counts.all[c] + tuning::kPrior));
  std::uint64_t key = 0;
  for (std::size_t c = 0; c < SkyCells::kCount; ++c)
    key = combineKeys(key, std::bit_cast<std::uint32_t>(share_[guide * SkyCells::kCount + c]));
  keys_[guide] = key;
}

bool SkyVisibility::takeShares(std::size_t guide, std::uint64_t leaves, const SkyVisibility& before) {
  const auto was = before.guideOfLeaves_.find(leaves);
  if (was == before.guideOfLeaves_.end()) return false;
  std::copy_n(before.share_.begin() + std::ptrdiff_t(was->second) * SkyCells::kCount, SkyCells::kCount,
              share_.begin() + static_cast<std::ptrdiff_t>(guide) * SkyCells::kCount);
  keys_[guide] = before.keys_[was->second];
  return true;
}

SkyKey skyKey(const Skies& skies, const SkyVisibility& visibility, const SkyLeaf& s) {
  SkyKey all;
  std::uint64_t& key = all.points;
  // In words of bits: points ascend, and nearly all are among the first.
  std::uint64_t word = 0, bits = 0;
  for (const std::uint32_t point : s.points) {
    if (point / 64 != word) key = combineKeys(combineKeys(key, word), bits), word = point / 64, bits = 0;
    bits |= std::uint64_t(1) << (point % 64);
  }
  key = combineKeys(combineKeys(key, word), bits);
  all.guide = visibility.key(s.leaf);
  std::uint64_t& light = all.light = combineKeys(combineKeys(skies.key(), all.guide), s.lines);
  light = combineKeys(light, all.points);
  const auto both = [](float a, float b) {
    return std::uint64_t(std::bit_cast<std::uint32_t>(a)) << 32 | std::bit_cast<std::uint32_t>(b);
  };
  for (const EscapedView& e : s.escaped) {
    light = combineKeys(combineKeys(light, both(e.direction.x, e.direction.y)), both(e.direction.z, e.chance));
    light = combineKeys(combineKeys(light, both(e.weight.r, e.weight.g)), both(e.weight.b, 0));
  }
  return all;
}

SkyAtLeaf skyLight(const Skies& skies, const SkyVisibility& visibility, const hierarchy::Elements& elements,
                   const Scene& scene, const tracing::RayTracer& tracer, const SkyLeaf& s, std::span<SkyRay> all) {
  using Visibility = SkyRay::Visibility;
  SkyAtLeaf result;
  const hierarchy::ElementGeometry& g = elements.shape(s.element);
  const bool flat = g.normalCone > 0.999f;
  std::array<float, SkyCells::kCount> cumulative;
  float total = 0;
  const auto weight = [&](int cell) {
    const auto c = static_cast<std::size_t>(cell);
    return cumulative[c] - (c > 0 ? cumulative[c - 1] : 0.0f);
  };
  static const CellLooks looks;
  CellLooks::All cosines;
  if (flat)
    cosines = looks.cosines(g.normal);
  else
    cosines.fill(1.0f);
  for (int cell = 0; cell < SkyCells::kCount; ++cell) {
    const float cosine = cosines[static_cast<std::size_t>(cell)];
    if (cosine > 0) total += skies.strength(cell) * cosine * visibility.at(s.leaf, cell);
    cumulative[static_cast<std::size_t>(cell)] = total;
  }
  const auto rays = static_cast<double>(s.points.size());
  const auto guided = [&](int cell) { return total > 0 ? rays * weight(cell) / total / SkyCells::solidAngle() : 0.0; };
  // Density of own lines: they pass panes by chance, about what those let through.
  const auto byLines = [&](float cosine, const Rgb& V) {
    return double(s.lines) * cosine / kPi * std::max(1e-3f, gray(V));
  };
  RgbSum sum(0.0);
  double squares = 0;
  const auto add = [&](const Rgb& x) { sum += RgbSum(x), squares += double(gray(x)) * gray(x); };
  if (total > 0) {
    const hierarchy::LeafSequence sequence(elements, scene, s.element);
    const ScrambledSobol choices(combineKeys(sequence.key(), kSkyKey)),
        places(combineKeys(sequence.key(), kSkyKey + 1));
    for (std::uint32_t k = 0; k < s.points.size(); ++k) {
      const UnitPair choice = choices(k), place = places(k);
      const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), static_cast<float>(choice.x) * total);
      const int cell = std::min(static_cast<int>(at - cumulative.begin()), SkyCells::kCount - 1);
      const Vec3f w = SkyCells::direction(cell, place.x, place.y);
      SkyRay& ray = all[k];
      if (ray.cell != cell) ray = {static_cast<std::uint8_t>(cell)};
      if (ray.known == Visibility::Stopped) continue;
      const hierarchy::PatchPoint x = sequence.point(s.points[k]);
      const float cosine = glm::dot(w, x.normal);
      if (!(cosine > 0)) continue;
      const Rgb L = skies.radiance(w);
      if (isBlack(L)) continue;
      Rgb V(1.0f);
      if (ray.known == Visibility::Unknown) {
        tracing::Ray way;
        way.origin = tracing::offsetOrigin(x.position, x.normal, w), way.direction = w;
        ++result.rays;
        const tracing::Hit hit = tracer.closestHit(way);
        const bool stopped = hit && scene::stopsLight(scene.materialOf(hit.primitive));
        ray.direction = w, ray.length = stopped ? hit.t : hit ? SkyRay::kDimmed : way.tFar;
        if (stopped) continue;
        if (hit) V = tracer.transmittance(way);
      }
      if (!isBlack(V)) add(L * V * static_cast<float>(cosine / (guided(cell) + byLines(cosine, V))));
    }
  }
  for (const EscapedView& e : s.escaped) {
    const Rgb V = e.weight * e.chance;
    const double traced = double(s.lines) * e.cosine / kPi * e.chance, line = byLines(e.cosine, V);
    const double share = line / (line + guided(SkyCells::of(e.direction)));  // [VG95 (balance heuristic)]
    add(skies.radiance(e.direction) * V * static_cast<float>(e.cosine * share / traced));
  }
  const double n = rays + s.lines;
  result.E = Rgb(sum);
  const double mean = gray(sum) / n;
  result.deviation = static_cast<float>(std::sqrt(std::max(0.0, squares - n * mean * mean)));
  return result;
}

}  // namespace deltalux::direct
