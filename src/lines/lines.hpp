#pragma once
// Lines of the leaves, and what came of tracing them: cosine-weighted rays from points of each leaf, which sample the
// line measure dA cos dw, so that every one of them counts at both of its ends. [Neu95; lines.md]
//
// A line is kept as 8 bytes: the leaf that it ends on, and a code of where it runs, by which an edit finds those it can
// touch. Lines that pass panes or go on over mirrors, gloss and glass are kept besides as exceptions, with their
// weight. They are a function of the scene and the mesh alone: line k of a leaf is the same whatever their number.
//
// Leaves are known by their elements, which an edit leaves as they are: so lines that an edit does not touch stay where
// they are stored. What is traced again is stored behind all others, and what it was before is left until it is as much
// as tidy() allows.
#include <memory>
#include <span>
#include <vector>

#include "base/cosine_direction.hpp"
#include "base/large_array.hpp"
#include "base/sobol.hpp"
#include "hierarchy/leaf_locator.hpp"
#include "lines/cover.hpp"
#include "lines/follow_line.hpp"
#include "lines/line_code.hpp"

namespace deltalux::lines {

/// In place of the leaf that a line ends on.
enum LineMark : std::uint32_t {
  kFirstMark = 0xfffffff0u,
  kException = kFirstMark,  // see Lines::exceptions
  kCovered,                 // it starts where something lies on the leaf: there is no line
  kLost,
  kEscaped,
  kLostBeyond,  // lost after the surface that it met first, which has a diffuse part
};

/// A line that is not straight through clear air to a leaf.
struct ExceptionalLine {
  std::uint32_t number = 0;  // which of its leaf's
  std::uint32_t end = 0;     // the element that it ends on
  Rgb weight{1.0f};          // throughput over the chance of its way, that of ending left out
  bool turned = false, rough = false;
  bool beyond = false;      // it went on over a surface that has a diffuse part, through clear air so far
  std::uint8_t unused = 0;  // so that no byte of a stored record is left to chance
};

/// A line that leaves the scene straight, for the sky's light.
struct EscapedLine {
  Vec3f direction{0.0f};
  float cosine = 0;
  Rgb weight{1.0f};
  float chance = 1;  // of its passages
};

/// A segment of a line behind the first surface that it went on over.
struct Bend {
  std::uint32_t number = 0;  // of the line: which of its leaf's
  Vec3f from{0.0f};
  LineCode code;
};

/// What leaves have several of, in order of their lines.
template <class T>
struct ListsOfLeaves {
  struct Range {
    std::uint32_t first = 0, count = 0;
  };
  std::vector<Range> of;  // by element
  std::vector<T> all;

  std::span<const T> at(hierarchy::ElementId e) const {
    const Range r = of[e.index()];
    return {all.data() + r.first, r.count};
  }
};

/// Where a leaf's lines are among all.
struct LineRange {
  std::uint64_t first = 0;
  std::uint32_t count = 0, covered = 0;  // of which so many are not there

  std::uint32_t open() const { return count - covered; }
};

struct Lines {
  std::vector<LineRange> of;      // by element; none of what is no receiving leaf
  LargeArray<std::uint32_t> end;  // by line: the element that it ends on, or a LineMark
  LargeArray<LineCode> code;      // by line
  ListsOfLeaves<ExceptionalLine> exceptions;

  bool empty() const { return of.empty(); }
  std::uint64_t size() const;
  const LineRange& at(hierarchy::ElementId e) const { return of[e.index()]; }
  std::uint32_t countOf(hierarchy::ElementId e) const { return at(e).count; }
  std::span<const std::uint32_t> endsOf(const LineRange& r) const { return {end.data() + r.first, r.count}; }
  std::span<const std::uint32_t> endsOf(hierarchy::ElementId e) const { return endsOf(at(e)); }
  std::span<const LineCode> codesOf(hierarchy::ElementId e) const { return {code.data() + at(e).first, at(e).count}; }
  std::size_t memoryBytes() const;
  /// Of where every line goes; equal for equal lines of equal leaves, wherever they are stored: `keys` by element.
  std::uint64_t hash(std::span<const std::uint64_t> keys) const;
};

/// Recounts: ranges lie within what there is, ends and exceptions are of elements that there are, in order. Throws
/// std::logic_error.
void validate(const Lines&);

struct TracedLines {
  Lines lines;
  ListsOfLeaves<EscapedLine> escaped;
  ListsOfLeaves<Bend> bends;
  std::uint64_t rays = 0;

  void resize(std::size_t elements) {
    lines.of.resize(elements), lines.exceptions.of.resize(elements), escaped.of.resize(elements);
    bends.of.resize(elements);
  }
  /// Of an element all lines.
  void drop(std::size_t element) {
    lines.of[element] = {}, lines.exceptions.of[element] = {}, escaped.of[element] = {}, bends.of[element] = {};
  }
};

/// The same lines of `elements` others, one leaf's behind the other's in their order: `now` by element, kNone where it
/// is no more. Lines that ended there are marked by KnownLines::kAgain.
Lines renumbered(const Lines&, std::span<const std::uint32_t> now, std::size_t elements);
TracedLines renumbered(const TracedLines&, std::span<const std::uint32_t> now, std::size_t elements);

struct FirstLines;

/// Lines that were traced before and are what they would be now, but for those that are marked to be traced again.
/// By element.
struct KnownLines {
  static constexpr std::uint32_t kAgain = kFirstMark - 1, kEscapedAgain = kFirstMark - 2,
                                 kExceptionAgain = kFirstMark - 3;  // [sentinel]
  static constexpr std::uint32_t kLeafAgain = 1u << 31;             // set in the leaf where such a line ended [layout]

  static bool isAgain(std::uint32_t end) { return end < kFirstMark && (end & kLeafAgain) != 0; }
  /// The element where a straight line ended, whether it holds or not; kNone for others.
  static std::uint32_t leafOf(std::uint32_t end) {
    return end < kExceptionAgain ? end & ~kLeafAgain : hierarchy::LeafTable::kNone;
  }

  std::vector<LineRange> before;  // where their lines were, and still lie; none of what was no leaf
  std::vector<char> stands;       // whether it is a leaf that was one, where it was
  std::vector<char> whole;        // the same, of which all lines hold

  /// Whether a leaf has the lines that it had.
  bool same(hierarchy::ElementId e, const Lines& now) const {
    return whole[e.index()] && before[e.index()].count == now.countOf(e);
  }
};

/// What lines are traced over. All must outlive whoever uses it.
struct LineScene {
  const hierarchy::Elements& elements;
  const hierarchy::LeafTable& leaves;
  const hierarchy::LeafLocator& locator;
  const LineTracer& tracer;
  const Cover& cover;
  const std::vector<char>& enclosed;                        // by element of the input level
  std::span<const std::unique_ptr<FirstLines>> first = {};  // by element: of those that are known
  const KnownLines* known = nullptr;
};

/// Traces lines until each leaf has `counts` of them at least: by leaf, in order. What is there and known is kept.
void traceLines(const LineScene&, std::span<const std::uint32_t> counts, TracedLines&);
/// Leaves of each leaf no more than `counts`.
void trim(const hierarchy::LeafTable&, std::span<const std::uint32_t> counts, TracedLines&);
/// Moves lines together where so many that are no more lie among them that it is worth it.
void tidy(TracedLines&);

/// Sets the directions in the lines' codes, which follow from the leaves that they start on.
void setDirections(Lines&, const hierarchy::Elements&, const Scene&);

/// Direction i of a leaf's lines, about its normal there.
class LineDirections {
 public:
  explicit LineDirections(std::uint64_t leafKey) : directions_(combineKeys(leafKey, kKey)) {}
  Vec3f operator()(std::uint32_t i, const Vec3f& normal) {
    if (normal != normal_) normal_ = normal, frame_ = Frame(Vec3(normal));
    const UnitPair u = directions_(i);
    return Vec3f(cosineDirection(frame_, u.x, u.y));
  }
  /// What decides at the branches of line i.
  static Rng random(std::uint64_t leafKey, std::uint32_t i) { return Rng(combineKeys(leafKey, kKey + 1), i); }

 private:
  static constexpr std::uint64_t kKey = 0x6c696e65735f5full;  // [key]
  ScrambledSobol directions_;
  Vec3f normal_{0, 0, 1};  // the latest: of flat leaves the only one
  Frame frame_{Vec3(0, 0, 1)};
};

}  // namespace deltalux::lines
