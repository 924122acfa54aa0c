#include "change/known_samples.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "hierarchy/leaf_sequence.hpp"

namespace deltalux::change {

namespace {

constexpr std::size_t kKnownLeaves = 256;  // of a task

/// Whether a line from anywhere about a leaf may pass where something has moved.
bool mayCross(const MovedSpace& space, const hierarchy::ElementGeometry& g, lines::LineCode code) {
  return space.crosses(g.center, g.radius, lines::direction(code), lines::lengthOf(code), lines::kDirectionError);
}

}  // namespace

bool holdFirstLines(const MovedSpace& space, const hierarchy::Elements& elements, const Scene& scene,
                    hierarchy::ElementId patch, const lines::FirstLines& first) {
  const hierarchy::ElementGeometry& g = elements.shape(patch);
  if (space.moved(elements.domain[patch.index()].primitive) || space.touches(g.center, g.radius)) return false;
  for (const lines::LineCode code : first.beyond)
    if (mayCross(space, g, code)) return false;
  const hierarchy::LeafSequence points(elements, scene, patch);
  for (std::uint32_t i = 0; i < first.line.size(); ++i) {
    const lines::LineCode code = first.line[i].code;
    if (code.reach == 0 || !mayCross(space, g, code)) continue;
    if (space.crosses(points.point(i).position, 0, lines::direction(code), lines::lengthOf(code),
                      lines::kDirectionError))
      return false;
  }
  return true;
}

bool holdShadowRays(const MovedSpace& space, const direct::Lamps& lamps, const hierarchy::Elements& elements,
                    hierarchy::ElementId patch) {
  const hierarchy::ElementGeometry& g = elements.shape(patch);
  if (space.moved(elements.domain[patch.index()].primitive) || space.touches(g.center, g.radius)) return false;
  for (const std::uint32_t i : lamps.suns()) {
    const direct::Lamp& sun = lamps.all()[i];
    if (!(direct::potential(sun, g) > 0)) continue;
    const auto stray = static_cast<float>(std::tan(sun.halfAngle));
    if (space.crosses(g.center, g.radius, Vec3f(sun.axis), std::numeric_limits<float>::infinity(), stray)) return false;
  }
  bool holds = true;
  lamps.tree().reaching(g, [&](std::uint32_t i, double) {
    const direct::Lamp& lamp = lamps.all()[i];
    holds = holds && !space.between(g.center, g.radius, {lamp.lower, lamp.upper});
  });
  return holds;
}

lines::KnownLines knownLines(const MovedSpace& space, lines::Lines all, std::span<const lines::EscapedLine> escaped,
                             std::vector<std::uint32_t> of, const hierarchy::Elements& before,
                             const hierarchy::LeafTable& leavesBefore) {
  constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone, kAgain = lines::KnownLines::kAgain;
  std::vector<std::uint32_t> now(all.leaves(), kNone);
  for (std::uint32_t i = 0; i < of.size(); ++i)
    if (of[i] != kNone) now[of[i]] = i;
  const std::vector<std::uint32_t> firstEscaped = lines::firstEscaped(escaped, all.leaves());
  parallelFor(all.leaves(), kKnownLeaves, [&](std::size_t i) {
    const hierarchy::ElementGeometry& g = before.shape(leavesBefore[i]);
    const bool starts = now[i] != kNone && !space.touches(g.center, g.radius);
    std::uint32_t nextEscaped = firstEscaped[i];
    for (std::uint64_t k = all.first[i]; k < all.first[i + 1]; ++k) {
      std::uint32_t& end = all.end[k];
      bool holds = starts;
      if (end == lines::kEscaped) {
        const lines::EscapedLine& e = escaped[nextEscaped++];
        holds = holds && e.weight == Rgb(1.0f) && e.chance == 1;
      } else if (end < lines::kFirstMark) {
        holds = holds && now[end] != kNone;
        end = holds ? now[end] : kAgain;
      } else {
        holds = holds && end == lines::kCovered;  // what goes on is not known where
      }
      const lines::LineCode code = all.code[k];
      if (!holds || (code.reach > 0 && mayCross(space, g, code))) end = kAgain;
    }
  });
  return {std::move(of), std::move(all)};
}

}  // namespace deltalux::change
