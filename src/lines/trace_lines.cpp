#include <array>
#include <bit>
#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "lines/lines.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kBlock = 32;  // leaves of a task
constexpr std::size_t kBatch = hierarchy::LeafSequence::kBatch;

/// The upper half of a float above `t`: seven bits after the point, so at most a 64th too far.
std::uint16_t reachCode(float t) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::isfinite(t) ? t : 3e38f);
  return static_cast<std::uint16_t>((bits + 0xffffu) >> 16);
}

/// Octahedral map. [MSS10]
LineCode codeOf(const Vec3f& w, float t) {
  const float sum = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
  float x = w.x / sum, y = w.y / sum;
  if (w.z < 0) {
    const float u = x;
    x = std::copysign(1 - std::abs(y), x), y = std::copysign(1 - std::abs(u), y);
  }
  return {static_cast<std::int8_t>(std::lround(127 * x)), static_cast<std::int8_t>(std::lround(127 * y)), reachCode(t)};
}

/// What a task has found of its leaves.
struct Found {
  std::vector<ExceptionalLine> exceptions;
  std::vector<EscapedLine> escaped;
  std::uint64_t rays = 0;
};

class LeafTracing {
 public:
  explicit LeafTracing(const LineScene& s) : s_(s) {}

  void operator()(std::uint32_t leaf, TracedLines& out, Found& found) const {
    const hierarchy::ElementId e = s_.leaves[leaf];
    const hierarchy::LeafSequence points(s_.elements, s_.tracer.scene(), e);
    const LineDirections directions(points.key());
    const PrimitiveId own = s_.elements.domain[e.index()].primitive;
    const bool touched = s_.cover.mayTouch(s_.elements, e);
    std::array<tracing::Ray, kBatch> rays;
    std::array<tracing::Hit, kBatch> hits;
    std::array<float, kBatch> cosines;
    std::array<std::uint32_t, kBatch> which;
    const std::uint64_t first = out.lines.first[leaf];
    const std::uint32_t count = out.lines.countOf(leaf);
    std::uint32_t covered = 0;
    for (std::uint32_t begin = 0; begin < count; begin += kBatch) {
      std::size_t live = 0;
      for (std::uint32_t i = begin; i < std::min<std::uint32_t>(count, begin + kBatch); ++i) {
        const hierarchy::PatchPoint x = points.point(i);
        const Vec3f w = directions(i, x.normal);
        if (touched && ++found.rays && s_.cover.covers(x.position, x.normal, own)) {
          out.lines.end[first + i] = kCovered, out.lines.code[first + i] = codeOf(w, 0), ++covered;
          continue;
        }
        rays[live].origin = tracing::offsetOrigin(x.position, x.normal, w), rays[live].direction = w;
        cosines[live] = glm::dot(w, x.normal), which[live++] = i;
      }
      s_.tracer.tracer().closestHits(std::span(rays).first(live), std::span(hits).first(live));
      found.rays += live;
      for (std::size_t k = 0; k < live; ++k) {
        const std::uint32_t i = which[k];
        const LineEnd end = s_.tracer.follow(rays[k], hits[k], LineDirections::random(points.key(), i));
        const std::uint32_t mark = take(end, leaf, first + i, rays[k].direction, cosines[k], found);
        out.lines.end[first + i] = mark;
        out.lines.code[first + i] = codeOf(rays[k].direction, end.distance);
        covered += mark == kCovered;
      }
    }
    out.covered[leaf] = covered;
  }

 private:
  std::uint32_t take(const LineEnd& end, std::uint32_t leaf, std::uint64_t line, const Vec3f& w, float cosine,
                     Found& found) const {
    if (end.fate == LineFate::Escaped) {
      // What escapes over mirrors and gloss, particles bring from the other end.
      if (end.turned) return kLost;
      found.escaped.push_back({leaf, w, cosine, end.weight, end.chance});
      return kEscaped;
    }
    if (end.fate != LineFate::Ended) return kLost;
    const hierarchy::ElementId side = s_.elements.sides.at(end.side);
    if (side.valid() && s_.enclosed[hierarchy::surfaceOf(s_.elements, side).index()])
      return end.turned ? kLost : kCovered;
    const std::uint32_t at = s_.locator.at(end.side, end.position);
    if (at == hierarchy::LeafTable::kNone) return kLost;
    if (!end.dimmed) return at;
    found.exceptions.push_back({line, leaf, at, end.weight, end.turned, end.rough});
    return kException;
  }

  const LineScene& s_;
};

}  // namespace

Vec3f LineDirections::operator()(std::uint32_t i, const Vec3f& normal) const {
  const UnitPair u = directions_(i);
  return Vec3f(cosineDirection(Frame(Vec3(normal)), u.x, u.y));
}

TracedLines traceLines(const LineScene& s, std::span<const std::uint32_t> counts) {
  TracedLines out;
  const std::size_t leaves = s.leaves.size();
  out.lines.first.resize(leaves + 1);
  out.lines.first[0] = 0;
  for (std::size_t i = 0; i < leaves; ++i) out.lines.first[i + 1] = out.lines.first[i] + counts[i];
  out.lines.end.resize(out.lines.size()), out.lines.code.resize(out.lines.size());
  out.covered.assign(leaves, 0);
  std::vector<Found> found((leaves + kBlock - 1) / kBlock);
  const LeafTracing trace(s);
  parallelBlocks(leaves, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) trace(static_cast<std::uint32_t>(i), out, found[begin / kBlock]);
  });
  for (const Found& f : found) {
    out.lines.exceptions.insert(out.lines.exceptions.end(), f.exceptions.begin(), f.exceptions.end());
    out.escaped.insert(out.escaped.end(), f.escaped.begin(), f.escaped.end());
    out.rays += f.rays;
  }
  return out;
}

void setDirections(Lines& lines, const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                   const Scene& scene) {
  parallelFor(lines.leaves(), kBlock, [&](std::size_t leaf) {
    const std::uint32_t count = lines.countOf(leaf);
    if (count == 0) return;
    const hierarchy::LeafSequence points(elements, scene, leaves[leaf]);
    const LineDirections directions(points.key());
    const bool flat = elements.at(leaves[leaf]).flat;
    Vec3f normal = points.point(0).normal;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!flat && i > 0) normal = points.point(i).normal;
      LineCode& code = lines.code[lines.first[leaf] + i];
      const LineCode direction = codeOf(directions(i, normal), 0);
      code.x = direction.x, code.y = direction.y;
    }
  });
}

}  // namespace deltalux::lines
