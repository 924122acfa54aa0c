#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/parallel.hpp"
#include "lines/first_lines.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kBlock = 32;           // leaves of a task [task]
constexpr std::uint64_t kRoomForOthers = 3;  // part of all lines that there is room for behind them [task]
constexpr std::size_t kBatch = hierarchy::LeafSequence::kBatch;

/// What a task has found of its leaves, one after the other.
struct Found {
  std::vector<ExceptionalLine> exceptions;
  std::vector<EscapedLine> escaped;
  std::vector<Bend> bends;
  std::uint64_t rays = 0;
};

/// How much that is of each.
struct FoundOfLeaf {
  std::uint32_t exceptions = 0, escaped = 0, bends = 0;
};

/// Stores what all tasks have found of something behind what there is. `leaf`: elements by place in the tasks.
template <class Listed>
void append(const std::vector<Found>& found, std::vector<Listed> Found::*list, const std::vector<FoundOfLeaf>& counts,
            std::uint32_t FoundOfLeaf::*count, std::span<const hierarchy::ElementId> leaf, ListsOfLeaves<Listed>& all) {
  auto next = static_cast<std::uint32_t>(all.all.size());
  std::vector<std::uint32_t> first;  // by task
  for (std::size_t k = 0; k < leaf.size(); ++k) {
    if (k % kBlock == 0) first.push_back(next);
    all.of[leaf[k].index()] = {next, counts[k].*count};
    next += counts[k].*count;
  }
  all.all.resize(next);
  parallelFor(found.size(), kBlock,
              [&](std::size_t b) { std::ranges::copy(found[b].*list, all.all.begin() + first[b]); });
}

/// Of a line's way, what lies behind its first turn: it may run on as it did before, through a thin sheet or between
/// two mirrors.
void addBends(std::span<const LineSegment> behind, std::uint32_t number, std::vector<Bend>& bends) {
  for (const LineSegment& segment : behind)
    bends.push_back({number, segment.from, lineCode(segment.direction, segment.length)});
}

/// The lines of a leaf that are known, asked in order.
class KnownOfLeaf {
 public:
  /// Lines there were, of a range of all.
  KnownOfLeaf(const TracedLines& all, hierarchy::ElementId leaf, const LineRange& range)
      : ends_(all.lines.endsOf(range)),
        codes_(all.lines.code.data() + range.first, range.count),
        exceptions_(all.lines.exceptions.at(leaf)),
        escaped_(all.escaped.at(leaf)),
        bends_(all.bends.at(leaf)) {}

  bool holds(std::uint32_t i) const { return i < ends_.size() && !KnownLines::isAgain(ends_[i]); }
  LineCode code(std::uint32_t i) const { return codes_[i]; }
  /// Takes line i, of those that hold; returns its end or mark.
  std::uint32_t take(std::uint32_t i, Found& found) {
    const std::uint32_t end = ends_[i];
    if (end < kFirstMark) return end;
    if (end == kEscaped) found.escaped.push_back(escaped_[escape_++]);
    if (end == kException) found.exceptions.push_back(exceptions_[exception_++]);
    while (bend_ < bends_.size() && bends_[bend_].number < i) ++bend_;
    for (; bend_ < bends_.size() && bends_[bend_].number == i; ++bend_) found.bends.push_back(bends_[bend_]);
    return end;
  }
  /// Leaves out line i, which does not hold.
  void skip(std::uint32_t i) {
    if (i >= ends_.size()) return;
    escape_ += ends_[i] == KnownLines::kEscapedAgain, exception_ += ends_[i] == KnownLines::kExceptionAgain;
  }

 private:
  std::span<const std::uint32_t> ends_;
  std::span<const LineCode> codes_;
  std::span<const ExceptionalLine> exceptions_;
  std::span<const EscapedLine> escaped_;
  std::span<const Bend> bends_;
  std::size_t escape_ = 0, exception_ = 0, bend_ = 0;
};

class LeafTracing {
 public:
  explicit LeafTracing(const LineScene& s) : s_(s) {}

  /// Lines of a leaf, to where its range is; those that are known are taken from where they are.
  FoundOfLeaf operator()(hierarchy::ElementId e, const LineRange& known, TracedLines& all, Found& found) const {
    Lines& out = all.lines;
    LineRange& range = out.of[e.index()];
    const std::uint32_t count = range.count;
    const std::uint64_t first = range.first;
    const FoundOfLeaf before{sizeOf(found.exceptions), sizeOf(found.escaped), sizeOf(found.bends)};
    KnownOfLeaf lines(all, e, known);
    const hierarchy::LeafSequence points(s_.elements, s_.tracer.scene(), e);
    LineDirections directions(points.key());
    const PrimitiveId own = s_.elements.domain[e.index()].primitive;
    std::optional<Cover::About> about;  // where a line is to be traced
    std::vector<LineSegment> way;
    std::array<tracing::Ray, kBatch> rays;
    std::array<tracing::Hit, kBatch> hits;
    std::array<float, kBatch> cosines;
    std::array<std::uint32_t, kBatch> which;
    const FirstLines* measured = e.index() < s_.first.size() ? s_.first[e.index()].get() : nullptr;
    std::uint32_t covered = 0;
    for (std::uint32_t begin = 0; begin < count; begin += kBatch, measured = nullptr) {
      const std::uint32_t last = std::min<std::uint32_t>(count, begin + kBatch);
      std::size_t live = 0;
      for (std::uint32_t i = begin; i < last; ++i) {
        if (lines.holds(i) || (measured && measured->line[i].primitive != FirstLine::kAgain)) continue;
        if (!about) about = s_.cover.about(s_.elements, e);
        const hierarchy::PatchPoint x = points.point(i);
        const Vec3f w = directions(i, x.normal);
        if (s_.cover.covers(x.position, x.normal, own, *about, found.rays)) {
          out.end[first + i] = kCovered, out.code[first + i] = lineCode(w, 0), ++covered;
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
        if (lines.holds(i)) {
          mark = lines.take(i, found);
          out.code[first + i] = lines.code(i), out.end[first + i] = mark;
          covered += mark == kCovered;
          continue;
        }
        lines.skip(i);
        if (measured && measured->line[i].primitive != FirstLine::kAgain) {
          mark = take(
              measured->line[i], [&] { return points.point(i).normal; }, found);
          out.code[first + i] = measured->line[i].code;
        } else if (k < live && which[k] == i) {
          way.clear();
          const LineEnd end = s_.tracer.follow(rays[k], hits[k], LineDirections::random(points.key(), i), &way);
          if (end.turned) addBends(std::span(way).subspan(end.straight), i, found.bends);
          mark = take(end, i, rays[k].direction, cosines[k], found);
          out.code[first + i] = lineCode(rays[k].direction, end.distance), ++k;
        } else {
          continue;
        }
        out.end[first + i] = mark;
        covered += mark == kCovered;
      }
    }
    range.covered = covered;
    return {sizeOf(found.exceptions) - before.exceptions, sizeOf(found.escaped) - before.escaped,
            sizeOf(found.bends) - before.bends};
  }

 private:
  static std::uint32_t sizeOf(const auto& list) { return static_cast<std::uint32_t>(list.size()); }

  std::uint32_t take(const LineEnd& end, std::uint32_t number, const Vec3f& w, float cosine, Found& found) const {
    const std::uint32_t lost = end.met ? kLostBeyond : kLost;
    if (end.termination == LineTermination::Escaped) {
      // What escapes over mirrors and gloss, particles bring from the other end.
      if (end.turned) return lost;
      found.escaped.push_back({w, cosine, end.weight, end.chance});
      return kEscaped;
    }
    if (end.termination != LineTermination::Ended) return lost;
    const hierarchy::ElementId side = s_.elements.sides.at(end.side);
    if (side.valid() && s_.enclosed[hierarchy::surfaceOf(s_.elements, side).index()])
      return end.turned ? lost : std::uint32_t(kCovered);
    const std::uint32_t at = s_.locator.at(end.side, end.position);
    if (at == hierarchy::LeafTable::kNone) return end.turned ? lost : std::uint32_t(kLost);
    if (!end.dimmed) return s_.leaves[at].value;
    found.exceptions.push_back({number, s_.leaves[at].value, end.weight, end.turned, end.rough, end.met});
    return kException;
  }

  /// The same of a line that is known but for its leaf. normal(): where it starts.
  std::uint32_t take(const FirstLine& line, const auto& normal, Found& found) const {
    if (line.primitive == kEscaped)
      found.escaped.push_back({line.position, glm::dot(line.position, normal()), Rgb(1.0f), 1});
    if (!line.ended()) return line.primitive;
    const std::uint32_t at = s_.locator.at(line.side(), line.position);
    return at == hierarchy::LeafTable::kNone ? std::uint32_t(kLost) : s_.leaves[at].value;
  }

  const LineScene& s_;
};

}  // namespace

void traceLines(const LineScene& s, std::span<const std::uint32_t> counts, TracedLines& all) {
  all.resize(s.elements.size());
  std::vector<hierarchy::ElementId> leaves;
  std::vector<LineRange> known;  // of these
  std::uint64_t next = all.lines.end.size();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const hierarchy::ElementId leaf = s.leaves[i];
    LineRange& range = all.lines.of[leaf.index()];
    if (counts[i] <= range.count) continue;
    LineRange before = range;
    std::uint32_t count = counts[i];
    if (s.known && range.count == 0 && s.known->stands[leaf.index()])
      before = s.known->before[leaf.index()], count = std::max(count, before.count);  // lest others are forgotten
    leaves.push_back(leaf), known.push_back(before);
    range = {next, count, 0};
    next += count;
  }
  if (next > all.lines.end.capacity())  // memory that is not touched is none
    all.lines.end.reserve(next + next / kRoomForOthers), all.lines.code.reserve(next + next / kRoomForOthers);
  all.lines.end.resize(next), all.lines.code.resize(next);
  std::vector<Found> found((leaves.size() + kBlock - 1) / kBlock);
  std::vector<FoundOfLeaf> ofLeaf(leaves.size());
  const LeafTracing trace(s);
  parallelBlocks(leaves.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) ofLeaf[k] = trace(leaves[k], known[k], all, found[begin / kBlock]);
  });
  append(found, &Found::exceptions, ofLeaf, &FoundOfLeaf::exceptions, leaves, all.lines.exceptions);
  append(found, &Found::escaped, ofLeaf, &FoundOfLeaf::escaped, leaves, all.escaped);
  append(found, &Found::bends, ofLeaf, &FoundOfLeaf::bends, leaves, all.bends);
  for (const Found& f : found) all.rays += f.rays;
}

void trim(const hierarchy::LeafTable& leaves, std::span<const std::uint32_t> counts, TracedLines& all) {
  parallelFor(leaves.size(), kBlock, [&](std::size_t i) {
    const hierarchy::ElementId leaf = leaves[i];
    LineRange& range = all.lines.of[leaf.index()];
    if (counts[i] == 0) return all.drop(leaf.index());
    if (range.count <= counts[i]) return;
    range.count = counts[i];
    const std::span<const std::uint32_t> ends = all.lines.endsOf(leaf);
    range.covered = static_cast<std::uint32_t>(std::ranges::count(ends, kCovered));
    all.lines.exceptions.of[leaf.index()].count = static_cast<std::uint32_t>(std::ranges::count(ends, kException));
    all.escaped.of[leaf.index()].count = static_cast<std::uint32_t>(std::ranges::count(ends, kEscaped));
    auto& bends = all.bends.of[leaf.index()].count;
    while (bends > 0 && all.bends.at(leaf)[bends - 1].number >= counts[i]) --bends;
  });
}

void setDirections(Lines& lines, const hierarchy::Elements& elements, const Scene& scene) {
  parallelFor(lines.of.size(), kBlock, [&](std::size_t i) {
    const hierarchy::ElementId leaf(i);
    const LineRange& range = lines.at(leaf);
    if (range.count == 0) return;
    const hierarchy::LeafSequence points(elements, scene, leaf);
    LineDirections directions(points.key());
    const bool flat = elements.at(leaf).flat;
    Vec3f normal = points.point(0).normal;
    for (std::uint32_t k = 0; k < range.count; ++k) {
      if (!flat && k > 0) normal = points.point(k).normal;
      LineCode& code = lines.code[range.first + k];
      const LineCode direction = lineCode(directions(k, normal), 0);
      code.x = direction.x, code.y = direction.y;
    }
  });
}

}  // namespace deltalux::lines
