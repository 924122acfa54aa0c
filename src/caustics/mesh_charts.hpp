#pragma once
// A triangle mesh cut into plane charts (see chart.hpp): grown from triangle to neighbour while the normals stay within
// 45 degrees of the first, largest triangle's, which bounds the stretching by a factor of 1.41. A patch that winds over
// itself (a spiral stair) shares texels between its layers: flux is kept, the layers' light is mixed.
#include "caustics/chart.hpp"

namespace deltalux::caustics {

Charts meshCharts(const Mesh&);

}  // namespace deltalux::caustics
