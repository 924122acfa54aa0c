#include "caustics/caustics.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "caustics/adaptive_textures.hpp"
#include "caustics/tuning.hpp"
#include "particles/side_index.hpp"

namespace deltalux::caustics {

namespace {

/// Sorts the impacts by side, in the order that they are in; runs of impacts on one side.
std::vector<std::span<const particles::Impact>> bySide(std::vector<particles::Impact>& impacts) {
  std::size_t count = 0;
  for (const particles::Impact& i : impacts) count = std::max(count, particles::sideIndex(i.primitive, i.front) + 1);
  std::vector<std::size_t> first(count + 1, 0);
  for (const particles::Impact& i : impacts) ++first[particles::sideIndex(i.primitive, i.front) + 1];
  for (std::size_t s = 0; s < count; ++s) first[s + 1] += first[s];
  std::vector<std::size_t> next(first.begin(), first.end());
  std::vector<particles::Impact> sorted(impacts.size());
  for (const particles::Impact& i : impacts) sorted[next[particles::sideIndex(i.primitive, i.front)]++] = i;
  impacts = std::move(sorted);
  std::vector<std::span<const particles::Impact>> sides;
  for (std::size_t s = 0; s < count; ++s)
    if (first[s] < first[s + 1]) sides.emplace_back(impacts.data() + first[s], first[s + 1] - first[s]);
  return sides;
}

/// body(side index, impacts, settings) for every side that has impacts, in parallel.
template <class Body>
void forEachSide(const Scene& scene, const hierarchy::Elements& elements,
                 const std::vector<std::span<const particles::Impact>>& sides, double error, const Body& body) {
  SurfaceSides lit(2 * scene.primitives.size(), false);
  for (const std::span<const particles::Impact> side : sides)
    lit[particles::sideIndex(side.front().primitive, side.front().front)] = true;
  const OtherLight other = otherLight(scene, elements, lit);
  std::vector<std::size_t> order(sides.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sides[a].size() > sides[b].size(); });
  parallelFor(sides.size(), 1, [&](std::size_t k) {  // those that take long come first
    const std::size_t i = order[k];
    const particles::Impact& first = sides[i].front();
    const std::size_t side = particles::sideIndex(first.primitive, first.front);
    body(i, scene[first.primitive].shape, CausticSettings{error, other.mean[side], other.darkest[side]});
  });
}

struct LitPart {
  std::size_t side;
  double E, area;
};

/// Puts them in order, and the index with them.
Caustics indexed(std::vector<SurfaceCaustics> surfaces, std::size_t primitives) {
  std::sort(surfaces.begin(), surfaces.end(), [](const SurfaceCaustics& a, const SurfaceCaustics& b) {
    return particles::sideIndex(a.primitive, a.front) < particles::sideIndex(b.primitive, b.front);
  });
  Caustics result;
  result.ofPrimitive.assign(primitives, {Caustics::kNone, Caustics::kNone});
  for (std::uint32_t i = 0; i < surfaces.size(); ++i)
    result.ofPrimitive[surfaces[i].primitive.index()][surfaces[i].front ? 0 : 1] = i;
  result.surfaces = std::move(surfaces);
  return result;
}

}  // namespace

TextureRule adaptiveRule() { return {deservesTextures, makeCausticTextures}; }

OtherLight otherLight(const Scene& scene, const hierarchy::Elements& elements, const SurfaceSides& sides) {
  OtherLight result;
  result.mean = meanOtherLight(scene, elements);
  result.darkest.assign(result.mean.size(), 0.0);
  std::vector<LitPart> parts;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementTopology& t = elements.topology[i];
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    const std::size_t side = particles::sideIndex(elements.domain[i].primitive, t.front);
    if (!sides[side]) continue;
    const hierarchy::ElementLight& l = elements.radiometry[i];
    parts.push_back({side, gray(l.direct + l.indirect), elements.geometry[i].litArea()});
  }
  std::sort(parts.begin(), parts.end(),
            [](const LitPart& a, const LitPart& b) { return a.side != b.side ? a.side < b.side : a.E < b.E; });
  for (std::size_t begin = 0, end = 0; begin < parts.size(); begin = end) {
    double area = 0, below = 0;
    for (end = begin; end < parts.size() && parts[end].side == parts[begin].side; ++end) area += parts[end].area;
    std::size_t k = begin;
    while (k + 1 < end && (below += parts[k].area) < deltalux::tuning::kChangeMatters * area) ++k;
    result.darkest[parts[begin].side] = parts[k].E;
  }
  return result;
}

std::vector<double> meanOtherLight(const Scene& scene, const hierarchy::Elements& elements) {
  std::vector<double> flux(2 * scene.primitives.size(), 0.0), area(flux.size(), 0.0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementId e(i);
    if (!elements.isInputLevel(e) || elements.at(e).emitter || elements.at(e).blocker) continue;
    const std::size_t side = particles::sideIndex(elements.domain[i].primitive, elements.at(e).front);
    const double own = elements.shape(e).area;
    flux[side] += own * gray(elements.radiometry[i].direct + elements.radiometry[i].indirect);
    area[side] += own;
  }
  for (std::size_t i = 0; i < flux.size(); ++i) flux[i] = area[i] > 0 ? flux[i] / area[i] : 0.0;
  return flux;
}

std::size_t Caustics::count() const {
  std::size_t sum = 0;
  for (const SurfaceCaustics& s : surfaces) sum += s.textures.size();
  return sum;
}

double Caustics::meanSize() const {
  double sum = 0;
  for (const SurfaceCaustics& s : surfaces)
    for (const CausticTexture& t : s.textures) sum += std::sqrt(double(t.width) * t.height);
  return count() > 0 ? sum / static_cast<double>(count()) : 0.0;
}

std::size_t Caustics::memoryBytes() const {
  std::size_t bytes = ofPrimitive.size() * sizeof ofPrimitive[0];
  for (const SurfaceCaustics& s : surfaces) {
    bytes += sizeof s + s.charts.all.size() * sizeof(Chart) + s.charts.ofTriangle.size() * sizeof(std::uint32_t);
    for (const CausticTexture& t : s.textures) bytes += sizeof t + t.texels.size() * (sizeof(Rgb) + sizeof(float));
  }
  return bytes;
}

SurfaceSides sidesWithTextures(const Scene& scene, const hierarchy::Elements& elements,
                               std::vector<particles::Impact> impacts, double error, const TextureRule& rule) {
  const auto sides = bySide(impacts);
  std::vector<char> chosen(sides.size(), 0);
  forEachSide(scene, elements, sides, error, [&](std::size_t i, const Shape& shape, const CausticSettings& settings) {
    chosen[i] = rule.deserves(shape, sides[i], settings);
  });
  SurfaceSides result(2 * scene.primitives.size(), false);
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (chosen[i]) result[particles::sideIndex(sides[i].front().primitive, sides[i].front().front)] = true;
  return result;
}

Caustics makeCaustics(const Scene& scene, const hierarchy::Elements& elements, std::vector<particles::Impact> impacts,
                      double error, const TextureRule& rule) {
  Caustics caustics = indexed({}, scene.primitives.size());
  const std::vector<char> all(2 * scene.primitives.size(), 1);
  remakeCaustics(caustics, scene, elements, std::move(impacts), error, all, rule);
  return caustics;
}

std::size_t remakeCaustics(Caustics& caustics, const Scene& scene, const hierarchy::Elements& elements,
                           std::vector<particles::Impact> impacts, double error, const std::vector<char>& remade,
                           const TextureRule& rule) {
  if (std::none_of(remade.begin(), remade.end(), [](char r) { return r; })) return 0;
  const auto sides = bySide(impacts);
  std::vector<std::optional<SurfaceCaustics>> made(sides.size());
  forEachSide(scene, elements, sides, error, [&](std::size_t i, const Shape& shape, const CausticSettings& settings) {
    made[i] = rule.make(shape, sides[i], settings);
    if (!made[i]) return;
    made[i]->primitive = sides[i].front().primitive, made[i]->front = sides[i].front().front;
    DELTALUX_VALIDATED(validate(*made[i]));
  });
  std::vector<SurfaceCaustics> all;
  for (SurfaceCaustics& s : caustics.surfaces)
    if (!remade[particles::sideIndex(s.primitive, s.front)]) all.push_back(std::move(s));
  std::size_t count = 0;
  for (std::optional<SurfaceCaustics>& s : made)
    if (s) count += s->textures.size(), all.push_back(std::move(*s));
  caustics = indexed(std::move(all), scene.primitives.size());
  return count;
}

bool rescale(SurfaceCaustics& s, const RgbSum& flux, double tolerance) {
  const RgbSum shown = s.flux();
  if (gray(glm::abs(flux - shown)) <= tolerance * gray(flux)) return false;
  RgbSum factor(0.0);
  for (int c = 0; c < 3; ++c) factor[c] = shown[c] > 0 ? flux[c] / shown[c] : 0.0;
  for (CausticTexture& t : s.textures) {
    for (Rgb& E : t.texels) E *= Rgb(factor);
    t.flux *= factor;
  }
  return true;
}

void validate(const Caustics& c) {
  for (std::size_t i = 0; i < c.surfaces.size(); ++i) {
    const SurfaceCaustics& s = c.surfaces[i];
    validate(s);
    if (c.of(s.primitive, s.front) != &s) throw std::logic_error("caustics: the index does not find a side");
  }
}

}  // namespace deltalux::caustics
