#include "lines/first_lines.hpp"

namespace deltalux::lines {

FirstLine firstLine(const LineEnd& end, const Vec3f& direction, bool covered) {
  FirstLine line;
  line.code = lineCode(direction, end.distance);
  if (covered)
    line.primitive = kCovered;
  else if (end.termination == LineTermination::Lost && end.turned)
    return line;  // and so would its way
  else if (end.termination == LineTermination::Lost)
    line.primitive = end.met ? kLostBeyond : kLost;
  else if (end.dimmed)
    return line;  // its weight would have to be kept as well
  else if (end.termination == LineTermination::Escaped)
    line.primitive = kEscaped, line.position = direction;
  else
    line.primitive = end.side.primitive.value, line.triangle = end.side.triangle | (end.side.front ? line.kFront : 0u),
    line.position = end.position;
  return line;
}

}  // namespace deltalux::lines
