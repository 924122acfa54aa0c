#pragma once
// Coarser and coarser cells: what lies together in squares of two by two cells and hangs together over open borders
// becomes one cell, so that walls (walls.hpp) stay closed on every level. Wide kernels cost little there: a level has a
// quarter of the cells, and a kernel half as many of them in its radius.
//
// A coarse border's share is half the sum of those of its fine borders: the length is theirs, the distance twice as
// long; its openness is their mean.
// Cost: a level is made when it is first asked for; some 50 nanoseconds a cell.
#include <deque>

#include "caustics/heat_flow.hpp"

namespace deltalux {

class CellPyramid {
 public:
  /// The graph and the openness must outlive this.
  CellPyramid(const CellGraph& finest, Openness open) : finest_(finest), open_(open) {}

  /// Level 0: the finest.
  const CellGraph& graph(std::size_t level) { return level == 0 ? finest_ : coarse(level).graph; }
  /// Of a level's borders.
  Openness open(std::size_t level) { return level == 0 ? open_ : graph(level).open(); }
  /// Flow of conductivity 1 on a level.
  const HeatFlow& evenFlow(std::size_t level);

  /// Mean values over the cells of `level` of those of the level below.
  Channels restricted(const Channels&, std::size_t level);
  /// Gives the cells of the level below `level` the values of those that hold them.
  Channels spread(const Channels&, std::size_t level);

 private:
  struct Level {
    CellGraph graph;
    std::vector<std::uint32_t> of;  // a cell of the level below -> that which holds it
  };

  Level& coarse(std::size_t level);
  static Level coarsened(const CellGraph&, Openness);

  const CellGraph& finest_;
  Openness open_;
  std::deque<Level> levels_;  // from 1 on; addresses stay
  std::deque<HeatFlow> flows_;
};

}  // namespace deltalux
