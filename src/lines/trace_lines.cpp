#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/parallel.hpp"
#include "lines/first_lines.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kBlock = 32;  // leaves of a task [task]
constexpr std::size_t kBatch = hierarchy::LeafSequence::kBatch;

/// What a task has found of its leaves.
struct Found {
  std::vector<ExceptionalLine> exceptions;
  std::vector<EscapedLine> escaped;
  std::vector<Bend> bends;
  std::uint64_t rays = 0;
};

/// What all tasks have found of something, in their order.
template <class Listed>
void joinAll(const std::vector<Found>& found, std::vector<Listed> Found::*list, std::vector<Listed>& all) {
  std::vector<std::size_t> first{0};
  for (const Found& f : found) first.push_back(first.back() + (f.*list).size());
  all.resize(first.back());
  parallelFor(found.size(), kBlock, [&](std::size_t b) {
    std::ranges::copy(found[b].*list, all.begin() + static_cast<std::ptrdiff_t>(first[b]));
  });
}

/// Of a line's way, what lies behind its first turn: between two mirrors it may run as it did at first again.
void addBends(std::span<const LineSegment> way, std::uint32_t leaf, std::uint32_t number, std::vector<Bend>& bends) {
  std::size_t straight = 0;
  while (straight < way.size() && way[straight].direction == way.front().direction) ++straight;
  for (const LineSegment& segment : way.subspan(straight))
    bends.push_back({leaf, number, segment.from, lineCode(segment.direction, segment.length)});
}

/// The lines of a leaf that are known from before, asked in order.
class KnownOfLeaf {
 public:
  KnownOfLeaf(const KnownLines* known, std::uint32_t leaf) {
    if (!known || known->of[leaf] == hierarchy::LeafTable::kNone) return;
    const std::uint32_t old = known->of[leaf];
    known_ = known, old_ = old, first_ = known->lines.first[old], count_ = known->lines.countOf(old);
    escaped_ = known->firstEscaped[old], exception_ = known->firstException[old];
    bend_ = known->firstBend[old], lastBend_ = known->firstBend[old + 1];
  }
  /// Whether they are all of a leaf that has so many lines now.
  bool areAll(std::uint32_t count) const { return known_ && count == count_ && known_->whole[old_]; }
  /// Takes all of them, for lines from `line` on. Returns how many are covered.
  std::uint32_t takeAll(std::uint32_t leaf, std::uint64_t line, Lines& to, Found& found) const {
    const auto copy = [&](const auto& from, std::uint32_t begin, std::uint32_t end, auto& all) {
      for (std::uint32_t i = begin; i < end; ++i) all.push_back(from[i]), all.back().leaf = leaf;
    };
    copy(known_->escaped, known_->firstEscaped[old_], known_->firstEscaped[old_ + 1], found.escaped);
    copy(known_->bends, bend_, lastBend_, found.bends);
    const std::size_t exceptions = found.exceptions.size();
    copy(known_->lines.exceptions, exception_, known_->firstException[old_ + 1], found.exceptions);
    for (std::size_t i = exceptions; i < found.exceptions.size(); ++i) found.exceptions[i].line += line - first_;
    std::copy_n(known_->lines.code.data() + first_, count_, to.code.data() + line);
    std::copy_n(known_->lines.end.data() + first_, count_, to.end.data() + line);
    return static_cast<std::uint32_t>(std::count(to.end.data() + line, to.end.data() + line + count_, kCovered));
  }
  bool holds(std::uint32_t i) const { return i < count_ && !KnownLines::isAgain(known_->lines.end[first_ + i]); }
  LineCode code(std::uint32_t i) const { return known_->lines.code[first_ + i]; }
  /// Takes line i, of those that hold, for line `line` of all there are, of a leaf; returns its end or mark.
  std::uint32_t take(std::uint32_t i, std::uint32_t leaf, std::uint64_t line, Found& found) {
    const std::uint32_t end = known_->lines.end[first_ + i];
    if (end < kFirstMark) return end;
    if (end == kEscaped) found.escaped.push_back(known_->escaped[escaped_++]), found.escaped.back().leaf = leaf;
    if (end == kException) {
      found.exceptions.push_back(known_->lines.exceptions[exception_++]);
      found.exceptions.back().line = line, found.exceptions.back().leaf = leaf;
    }
    while (bend_ < lastBend_ && known_->bends[bend_].number < i) ++bend_;
    for (; bend_ < lastBend_ && known_->bends[bend_].number == i; ++bend_)
      found.bends.push_back(known_->bends[bend_]), found.bends.back().leaf = leaf;
    return end;
  }
  /// Leaves out line i, which does not hold.
  void skip(std::uint32_t i) {
    if (i >= count_) return;
    const std::uint32_t end = known_->lines.end[first_ + i];
    escaped_ += end == KnownLines::kEscapedAgain, exception_ += end == KnownLines::kExceptionAgain;
  }

 private:
  const KnownLines* known_ = nullptr;
  std::uint64_t first_ = 0;
  std::uint32_t old_ = 0, count_ = 0, escaped_ = 0, exception_ = 0, bend_ = 0, lastBend_ = 0;
};

class LeafTracing {
 public:
  explicit LeafTracing(const LineScene& s) : s_(s) {}

  void operator()(std::uint32_t leaf, TracedLines& out, Found& found) const {
    const std::uint32_t count = out.lines.countOf(leaf);
    out.covered[leaf] = 0;
    if (count == 0) return;
    const std::uint64_t first = out.lines.first[leaf];
    KnownOfLeaf before(s_.known, leaf);
    if (before.areAll(count)) {
      out.covered[leaf] = before.takeAll(leaf, first, out.lines, found);
      return;
    }
    const hierarchy::ElementId e = s_.leaves[leaf];
    const hierarchy::LeafSequence points(s_.elements, s_.tracer.scene(), e);
    LineDirections directions(points.key());
    const PrimitiveId own = s_.elements.domain[e.index()].primitive;
    std::optional<Cover::About> about;  // where a line is to be traced
    std::vector<LineSegment> way;
    std::array<tracing::Ray, kBatch> rays;
    std::array<tracing::Hit, kBatch> hits;
    std::array<float, kBatch> cosines;
    std::array<std::uint32_t, kBatch> which;
    const FirstLines* known = e.index() < s_.first.size() ? s_.first[e.index()].get() : nullptr;
    std::uint32_t covered = 0;
    for (std::uint32_t begin = 0; begin < count; begin += kBatch, known = nullptr) {
      const std::uint32_t last = std::min<std::uint32_t>(count, begin + kBatch);
      std::size_t live = 0;
      for (std::uint32_t i = begin; i < last; ++i) {
        if (before.holds(i) || (known && known->line[i].primitive != FirstLine::kAgain)) continue;
        if (!about) about = s_.cover.about(s_.elements, e);
        const hierarchy::PatchPoint x = points.point(i);
        const Vec3f w = directions(i, x.normal);
        if (s_.cover.covers(x.position, x.normal, own, *about, found.rays)) {
          out.lines.end[first + i] = kCovered, out.lines.code[first + i] = lineCode(w, 0), ++covered;
          continue;
        }
        rays[live].origin = tracing::offsetOrigin(x.position, x.normal, w), rays[live].direction = w;
        cosines[live] = glm::dot(w, x.normal), which[live++] = i;
      }
      s_.tracer.tracer().closestHits(std::span(rays).first(live), std::span(hits).first(live));
      found.rays += live;
      std::size_t k = 0;
      for (std::uint32_t i = begin; i < last; ++i) {
        std::uint32_t mark;
        if (before.holds(i)) {
          mark = before.take(i, leaf, first + i, found);
          out.lines.code[first + i] = before.code(i), out.lines.end[first + i] = mark;
          covered += mark == kCovered;
          continue;
        }
        before.skip(i);
        if (known && known->line[i].primitive != FirstLine::kAgain) {
          mark = take(
              known->line[i], leaf, [&] { return points.point(i).normal; }, found);
          out.lines.code[first + i] = known->line[i].code;
        } else if (k < live && which[k] == i) {
          way.clear();
          const LineEnd end = s_.tracer.follow(rays[k], hits[k], LineDirections::random(points.key(), i), &way);
          if (end.turned) addBends(way, leaf, i, found.bends);
          mark = take(end, leaf, first + i, rays[k].direction, cosines[k], found);
          out.lines.code[first + i] = lineCode(rays[k].direction, end.distance), ++k;
        } else {
          continue;
        }
        out.lines.end[first + i] = mark;
        covered += mark == kCovered;
      }
    }
    out.covered[leaf] = covered;
  }

 private:
  std::uint32_t take(const LineEnd& end, std::uint32_t leaf, std::uint64_t line, const Vec3f& w, float cosine,
                     Found& found) const {
    const std::uint32_t lost = end.met ? kLostBeyond : kLost;
    if (end.termination == LineTermination::Escaped) {
      // What escapes over mirrors and gloss, particles bring from the other end.
      if (end.turned) return lost;
      found.escaped.push_back({leaf, w, cosine, end.weight, end.chance});
      return kEscaped;
    }
    if (end.termination != LineTermination::Ended) return lost;
    const hierarchy::ElementId side = s_.elements.sides.at(end.side);
    if (side.valid() && s_.enclosed[hierarchy::surfaceOf(s_.elements, side).index()])
      return end.turned ? lost : std::uint32_t(kCovered);
    const std::uint32_t at = s_.locator.at(end.side, end.position);
    if (at == hierarchy::LeafTable::kNone) return end.turned ? lost : std::uint32_t(kLost);
    if (!end.dimmed) return at;
    found.exceptions.push_back({line, leaf, at, end.weight, end.turned, end.rough, end.met});
    return kException;
  }

  /// The same of a line that is known but for its leaf. normal(): where it starts.
  std::uint32_t take(const FirstLine& line, std::uint32_t leaf, const auto& normal, Found& found) const {
    if (line.primitive == kEscaped)
      found.escaped.push_back({leaf, line.position, glm::dot(line.position, normal()), Rgb(1.0f), 1});
    if (!line.ended()) return line.primitive;
    const std::uint32_t at = s_.locator.at(line.side(), line.position);
    return at == hierarchy::LeafTable::kNone ? std::uint32_t(kLost) : at;
  }

  const LineScene& s_;
};

}  // namespace

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
  joinAll(found, &Found::exceptions, out.lines.exceptions);
  joinAll(found, &Found::escaped, out.escaped);
  joinAll(found, &Found::bends, out.bends);
  for (const Found& f : found) out.rays += f.rays;
  return out;
}

void setDirections(Lines& lines, const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                   const Scene& scene) {
  parallelFor(lines.leaves(), kBlock, [&](std::size_t leaf) {
    const std::uint32_t count = lines.countOf(leaf);
    if (count == 0) return;
    const hierarchy::LeafSequence points(elements, scene, leaves[leaf]);
    LineDirections directions(points.key());
    const bool flat = elements.at(leaves[leaf]).flat;
    Vec3f normal = points.point(0).normal;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!flat && i > 0) normal = points.point(i).normal;
      LineCode& code = lines.code[lines.first[leaf] + i];
      const LineCode direction = lineCode(directions(i, normal), 0);
      code.x = direction.x, code.y = direction.y;
    }
  });
}

}  // namespace deltalux::lines
