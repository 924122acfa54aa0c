// Any bytes parse to points with finite positions and unit normals, or throw InputError; what is read can be written.
#include <cmath>
#include <cstdlib>
#include <deltalux/error.hpp>
#include <deltalux/points.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const deltalux::PointTable table = deltalux::parsePoints({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    for (const deltalux::ProbePoint& point : table.points) {
      for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(point.position[axis])) std::abort();
      if (!(std::abs(glm::length(point.normal) - 1.0) < 1e-9)) std::abort();
    }
    const std::vector<deltalux::ProbeResult> results(table.points.size());
    deltalux::formatProbeResults(table, results, deltalux::ProbeColumns::ValuesAndErrors);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
