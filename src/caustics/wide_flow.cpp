#include "caustics/wide_flow.hpp"

#include <algorithm>

namespace deltalux {

namespace {

constexpr double kOnCells = 3;        // conductivity that a level keeps, in areas of its cells
constexpr double kWorthwhile = 2;     // times that: from which a coarser level is made
constexpr std::size_t kCoarsest = 2;  // level
constexpr double kPrecision = 1e-5;   // flux is kept whatever it is

void flow(CellPyramid& pyramid, std::size_t level, double cell, Channels& E, std::vector<float> D) {
  const auto most = static_cast<float>(kOnCells * cell);
  const bool wide = std::any_of(D.begin(), D.end(), [&](float d) { return d > kWorthwhile * most; });
  if (!wide || level == kCoarsest) {
    HeatFlow(pyramid.graph(level), D, pyramid.open(level)).apply(E, 1.0, kPrecision);
    return;
  }
  std::vector<float> rest = D;
  for (float& d : rest) d = std::max(d - most, 0.0f);
  for (float& d : D) d = std::min(d, most);
  const HeatFlow narrow(pyramid.graph(level), D, pyramid.open(level));
  narrow.apply(E, 0.5, kPrecision);
  const Channels before = pyramid.restricted(E, level + 1);
  Channels change = before;
  flow(pyramid, level + 1, 4 * cell, change, pyramid.restricted({std::move(rest)}, level + 1).front());
  for (std::size_t c = 0; c < change.size(); ++c)
    for (std::size_t i = 0; i < change[c].size(); ++i) change[c][i] -= before[c][i];
  change = pyramid.spread(change, level + 1);
  for (std::size_t c = 0; c < E.size(); ++c)
    for (std::size_t i = 0; i < E[c].size(); ++i) E[c][i] += change[c][i];
  narrow.apply(E, 0.5, kPrecision);
}

}  // namespace

void flowWidely(CellPyramid& pyramid, Channels& E, std::vector<float> conductivity) {
  flow(pyramid, 0, pyramid.graph(0).meanArea(), E, std::move(conductivity));
}

}  // namespace deltalux
