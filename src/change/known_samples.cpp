#include "change/known_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "change/line_sieve.hpp"
#include "hierarchy/leaf_sequence.hpp"

namespace deltalux::change {

namespace {

constexpr std::size_t kKnownLeaves = 256;  // of a task [task]

BoxF boxOf(const hierarchy::ElementGeometry& g) { return {g.lower, g.upper}; }
BoxF at(const Vec3f& p) { return {p, p}; }

/// Whether a patch faces any place where something has moved: its samples run to its side of a flat one.
bool faces(const MovedSpace& space, const hierarchy::Elements& elements, hierarchy::ElementId patch) {
  const hierarchy::ElementGeometry& g = elements.shape(patch);
  return !elements.at(patch).flat || !space.behind(g.center, g.normal);
}

/// Whether a line from anywhere in a box may pass where something has moved.
bool mayCross(const MovedSpace& space, const BoxF& from, lines::LineCode code) {
  return space.crosses(from, lines::direction(code), lines::lengthOf(code), lines::kDirectionError);
}

}  // namespace

bool holdFirstLines(const MovedSpace& space, const hierarchy::Elements& elements, const Scene& scene,
                    hierarchy::ElementId patch, const lines::FirstLines& first) {
  const BoxF box = boxOf(elements.shape(patch));
  if (space.moved(elements.domain[patch.index()].primitive) || space.touches(box)) return false;
  if (!faces(space, elements, patch)) return true;
  const LineSieve sieve(space, box, lines::kDirectionError);
  std::array<lines::LineCode, hierarchy::LeafSequence::kBatch> codes;
  std::array<char, hierarchy::LeafSequence::kBatch> near;
  for (std::size_t begin = 0; begin < first.beyond.size(); begin += near.size()) {
    const auto some = std::span(first.beyond).subspan(begin, std::min(near.size(), first.beyond.size() - begin));
    sieve.mark(some, std::span(near).first(some.size()));
    for (std::size_t i = 0; i < some.size(); ++i)
      if (near[i] && mayCross(space, box, some[i])) return false;
  }
  for (std::uint32_t i = 0; i < codes.size(); ++i) codes[i] = first.line[i].code;
  sieve.mark(codes, near);
  if (std::ranges::find(near, 1) == near.end()) return true;
  const hierarchy::LeafSequence points(elements, scene, patch);
  for (std::uint32_t i = 0; i < codes.size(); ++i) {
    const lines::LineCode code = codes[i];
    if (!near[i] || code.reach == 0 || !mayCross(space, box, code)) continue;
    if (mayCross(space, at(points.point(i).position), code)) return false;
  }
  return true;
}

bool holdWalks(const MovedSpace& space, const lines::LightWalks& walks) {
  if (space.touches(walks.box)) return false;
  return std::ranges::none_of(
      walks.steps, [&](const lines::LineSegment& s) { return space.crosses(at(s.from), s.direction, s.length); });
}

bool crosses(const MovedSpace& space, const tracing::Ray& ray) {
  return space.crosses(at(ray.origin), ray.direction, ray.tFar);
}

bool mayShadow(const MovedSpace& space, const direct::Lamp& lamp, const BoxF& from) {
  if (!lamp.sun) return space.between(from, {lamp.lower, lamp.upper});
  return space.crosses(from, Vec3f(lamp.axis), std::numeric_limits<float>::infinity(),
                       static_cast<float>(std::tan(lamp.halfAngle)));
}

std::uint64_t lampsThrough(const MovedSpace& space, const direct::Lamps& lamps, const BoxF& from, std::uint64_t among) {
  std::uint64_t through = 0;
  for (const direct::Lamp& lamp : lamps.all()) {
    const std::uint64_t bit = direct::lampBit(lamp.id);
    if ((among & ~through & bit) != 0 && mayShadow(space, lamp, from)) through |= bit;
  }
  return through;
}

/// visit(lamp) of suns and lamps that may shine on a patch through where something has moved.
template <class Visit>
void forEachMayShadow(const MovedSpace& space, const direct::Lamps& lamps, const hierarchy::ElementGeometry& g,
                      std::uint64_t through, const Visit& visit) {
  if (through == 0) return;
  for (const direct::Lamp& lamp : lamps.all())
    if ((through & direct::lampBit(lamp.id)) != 0 && direct::potential(lamp, g) > 0 && mayShadow(space, lamp, boxOf(g)))
      visit(lamp);
}

bool holdDimRays(const MovedSpace& space, const direct::Lamps& lamps, const hierarchy::Elements& elements,
                 const Scene& scene, hierarchy::ElementId leaf, std::span<const std::uint32_t> points,
                 std::uint64_t through) {
  if (space.moved(elements.domain[leaf.index()].primitive) || space.touches(boxOf(elements.shape(leaf)))) return false;
  if (through == 0 || !faces(space, elements, leaf)) return true;
  return !direct::anyDimRay(elements, scene, lamps, leaf, points,
                            [&](const tracing::Ray& ray) { return crosses(space, ray); });
}

bool holdAskedRays(const MovedSpace& space, const direct::DirectSampler& sampler, const hierarchy::Elements& elements,
                   hierarchy::ElementId patch, const direct::KnownPoints& known, const direct::LeafDirect& before,
                   std::uint64_t through, bool& drawn) {
  if (space.moved(elements.domain[patch.index()].primitive)) return false;
  if (!faces(space, elements, patch)) return true;
  bool holds = true;
  forEachMayShadow(space, sampler.lamps(), elements.shape(patch), through, [&](const direct::Lamp& lamp) {
    if (!holds) return;
    const direct::LampLight* const asked = direct::askedLight(before.lamps, lamp.id);
    // A lamp that is asked may have come to be by a ray that was drawn.
    drawn = drawn || !asked || (before.sight.drawnSeen && !lamp.sun);
    if (asked)
      holds = !sampler.anyRay(
          patch, known, *asked, [&](const Vec3f& from) { return mayShadow(space, lamp, at(from)); },
          [&](const tracing::Ray& ray) { return crosses(space, ray); });
  });
  return holds;
}

bool holdShadowRays(const MovedSpace& space, const direct::DirectSampler& sampler, const hierarchy::Elements& elements,
                    hierarchy::ElementId patch, const direct::KnownPoints& known, const direct::LampSight& above,
                    const direct::LeafDirect& before, std::uint64_t through) {
  bool drawn = false;
  return holdAskedRays(space, sampler, elements, patch, known, before, through, drawn) &&
         !(drawn && before.drawn > 0 &&
           sampler.anyDrawnRay(patch, known, above, before.drawn,
                               [&](const tracing::Ray& ray) { return crosses(space, ray); }));
}

bool holdSkyRays(const MovedSpace& space, const hierarchy::Elements& elements, hierarchy::ElementId patch,
                 std::span<const lines::LineCode> codes, std::span<direct::SkyRay> rays) {
  using Visibility = direct::SkyRay::Visibility;
  const BoxF box = boxOf(elements.shape(patch));
  if (space.touches(box)) return false;
  std::array<char, deltalux::tuning::kFewestEstimates> near{};
  if (faces(space, elements, patch))
    LineSieve(space, box, lines::kDirectionError).mark(codes, std::span(near).first(codes.size()));
  bool all = true;
  for (std::size_t k = 0; k < codes.size(); ++k) {
    if (codes[k].reach == 0) continue;
    if (near[k] && mayCross(space, box, codes[k])) {
      all = false;
      continue;
    }
    const float length = lines::lengthOf(codes[k]);
    if (length < direct::SkyRay::kDimmed)
      rays[k].known = Visibility::Stopped;
    else if (length >= lines::kEndless)
      rays[k].known = Visibility::Open;
  }
  return all;
}

lines::KnownLines knownLines(const MovedSpace& space, lines::TracedLines& all, std::vector<char> stands,
                             const hierarchy::Elements& elements) {
  using lines::KnownLines;
  lines::tidy(all);
  all.resize(elements.size());
  KnownLines known{all.lines.of, std::move(stands), std::vector<char>(elements.size(), false)};
  const auto endHolds = [&](std::uint32_t end) {
    return end >= lines::kFirstMark || (end < known.stands.size() && known.stands[end]);
  };
  parallelFor(elements.size(), kKnownLeaves, [&](std::size_t i) {
    const hierarchy::ElementId leaf(i);
    if (!known.stands[i]) return all.drop(i);
    const BoxF box = boxOf(elements.shape(leaf));
    const bool starts = !space.touches(box);
    const std::span<std::uint32_t> ends(all.lines.end.data() + known.before[i].first, known.before[i].count);
    const std::span<const lines::LineCode> codes(all.lines.code.data() + known.before[i].first, ends.size());
    std::vector<char> near(ends.size(), 0);
    if (starts && faces(space, elements, leaf)) LineSieve(space, box, lines::kDirectionError).mark(codes, near);
    const std::span<const lines::ExceptionalLine> exceptions = all.lines.exceptions.at(leaf);
    const std::span<const lines::Bend> bends = all.bends.at(leaf);
    // Most leaves have neither lines near it nor others than straight ones.
    if (starts && exceptions.empty() && bends.empty() && std::ranges::find(near, 1) == near.end() &&
        std::ranges::all_of(ends, endHolds)) {
      known.whole[i] = true;
      return;
    }
    std::size_t exception = 0, bend = 0;
    bool whole = true;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      std::uint32_t& end = ends[k];
      const std::uint32_t mark = end;
      bool holds = starts && endHolds(mark);
      if (mark == lines::kException) holds = endHolds(exceptions[exception++].end) && holds;
      holds = holds && !(near[k] && codes[k].reach > 0 && mayCross(space, box, codes[k]));
      if (mark >= lines::kFirstMark && mark != lines::kEscaped && mark != lines::kCovered)
        for (; bend < bends.size() && bends[bend].number <= k; ++bend) {
          const lines::Bend& b = bends[bend];
          holds = holds && (b.number < k || !mayCross(space, at(b.from), b.code));
        }
      whole = whole && holds;
      if (!holds)
        end = mark == lines::kEscaped     ? KnownLines::kEscapedAgain
              : mark == lines::kException ? KnownLines::kExceptionAgain
              : mark >= lines::kFirstMark ? KnownLines::kAgain
                                          : mark | KnownLines::kLeafAgain;
    }
    known.whole[i] = whole;
    if (!whole) all.lines.of[i] = {};
  });
  return known;
}

}  // namespace deltalux::change
