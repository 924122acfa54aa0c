#pragma once
// Lines of the leaves, and what came of tracing them: cosine-weighted rays from points of each leaf, which sample the
// line measure dA cos dw, so that every one of them counts at both of its ends. [Neu95; lines.md]
//
// A line is kept as 8 bytes: the leaf that it ends on, and a code of where it runs, by which an edit finds those it can
// touch. Lines that pass panes or go on over mirrors, gloss and glass are kept besides as exceptions, with their
// weight. They are a function of the scene and the mesh alone: line k of a leaf is the same whatever their number.
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
  std::uint64_t line = 0;
  std::uint32_t leaf = 0, end = 0;  // where it starts and ends
  Rgb weight{1.0f};                 // throughput over the chance of its way, that of ending left out
  bool turned = false, rough = false;
  bool beyond = false;      // it went on over a surface that has a diffuse part, through clear air so far
  std::uint8_t unused = 0;  // so that no byte of a stored record is left to chance
};

struct Lines {
  LargeArray<std::uint64_t> first{0};       // by leaf: its lines; one more for the end
  LargeArray<std::uint32_t> end;            // by line
  LargeArray<LineCode> code;                // by line
  std::vector<ExceptionalLine> exceptions;  // ascending

  std::size_t leaves() const { return first.size() - 1; }
  std::uint64_t size() const { return first.back(); }
  std::uint32_t countOf(std::size_t leaf) const { return static_cast<std::uint32_t>(first[leaf + 1] - first[leaf]); }
  std::size_t memoryBytes() const;
  /// Of where every line goes; equal for equal lines of equal leaves, whatever the leaves' numbers: `keys` by leaf.
  std::uint64_t hash(std::span<const std::uint64_t> keys) const;
};

/// Recounts: ends and exceptions are of leaves that there are, in order. Throws std::logic_error.
void validate(const Lines&);

/// A line that leaves the scene straight, for the sky's light.
struct EscapedLine {
  std::uint32_t leaf = 0;
  Vec3f direction{0.0f};
  float cosine = 0;
  Rgb weight{1.0f};
  float chance = 1;  // of its passages
};

/// A segment of a line behind the first surface that it went on over.
struct Bend {
  std::uint32_t leaf = 0, number = 0;  // of the line: where it starts, and which of that leaf's
  Vec3f from{0.0f};
  LineCode code;
};

/// By leaf: the first of those that start there, of lines ascending by leaf; one more for the end.
template <class OfLeaf>
std::vector<std::uint32_t> firstOf(const std::vector<OfLeaf>& ascending, std::size_t leaves) {
  std::vector<std::uint32_t> first(leaves + 1, 0);
  for (const OfLeaf& x : ascending) ++first[x.leaf + 1];
  for (std::size_t i = 0; i < leaves; ++i) first[i + 1] += first[i];
  return first;
}

struct TracedLines {
  Lines lines;
  std::vector<EscapedLine> escaped;    // ascending by leaf
  std::vector<Bend> bends;             // ascending by leaf, number and way
  std::vector<std::uint32_t> covered;  // by leaf: lines that are not there
  std::uint64_t rays = 0;
};

struct FirstLines;

/// Lines that were traced before and are what they would be now, but for those that are marked to be traced again.
struct KnownLines {
  static constexpr std::uint32_t kAgain = kFirstMark - 1, kEscapedAgain = kFirstMark - 2,
                                 kExceptionAgain = kFirstMark - 3;  // [sentinel]
  static constexpr std::uint32_t kLeafAgain = 1u << 31;             // set in the leaf where such a line ended [layout]

  static bool isAgain(std::uint32_t end) { return end < kFirstMark && (end & kLeafAgain) != 0; }
  /// The leaf, of those that there are now, where a straight line ended, whether it holds or not; kNone for others.
  static std::uint32_t leafOf(std::uint32_t end) {
    return end < kExceptionAgain ? end & ~kLeafAgain : hierarchy::LeafTable::kNone;
  }

  std::vector<std::uint32_t> of;   // by leaf: the leaf of `lines` that it was; LeafTable::kNone: none
  std::vector<std::uint32_t> now;  // by leaf of `lines`: which that is now
  Lines lines;                     // they end on leaves that there are now
  std::vector<EscapedLine> escaped;
  std::vector<Bend> bends;
  std::vector<std::uint32_t> firstEscaped, firstException, firstBend;  // by leaf of `lines`
  std::vector<char> whole;                                             // the same: all of its lines hold
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

/// `counts` lines of each leaf.
TracedLines traceLines(const LineScene&, std::span<const std::uint32_t> counts);

/// Sets the directions in the lines' codes, which follow from the leaves that they start on.
void setDirections(Lines&, const hierarchy::Elements&, const hierarchy::LeafTable&, const Scene&);

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
