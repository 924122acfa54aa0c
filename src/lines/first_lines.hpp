#pragma once
// The first lines of a patch, which are traced while the mesh is made and are those of its leaf: what of them does not
// depend on the mesh, so that none is traced again. Cost: 384 bytes a patch.
#include <array>

#include "hierarchy/leaf_sequence.hpp"
#include "lines/lines.hpp"

namespace deltalux::lines {

/// One of them: where it ended, whatever leaf that is on.
struct FirstLine {
  static constexpr std::uint32_t kAgain = KnownLines::kAgain;  // in place of the primitive: to be traced once more
  static constexpr std::uint32_t kFront = 1u << 31;            // [layout]

  std::uint32_t primitive = kAgain;  // or a LineMark
  std::uint32_t triangle = 0;        // and kFront
  Vec3f position{0.0f};              // of a line that escapes, its direction
  LineCode code;

  bool ended() const { return primitive < kAgain; }
  hierarchy::Side side() const { return {PrimitiveId(primitive), triangle & ~kFront, (triangle & kFront) != 0}; }
};

struct FirstLines {
  std::array<FirstLine, hierarchy::LeafSequence::kBatch> line;
  std::vector<LineCode> beyond;  // of others that tell what is covered, where some lines end in hollows
};

/// What is to be kept of a line into unit `direction`. `covered`: it ends on an enclosed side, so that it is none.
FirstLine firstLine(const LineEnd&, const Vec3f& direction, bool covered);
/// Of a line that does not start, since something lies there.
inline FirstLine coveredLine(const Vec3f& direction) { return {kCovered, 0, Vec3f(0.0f), lineCode(direction, 0)}; }

}  // namespace deltalux::lines
