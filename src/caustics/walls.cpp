#include "caustics/walls.hpp"

#include <algorithm>

namespace deltalux {

namespace {

constexpr double kParticles = 30;       // of a kernel that edges are looked for with
constexpr double kWidest = 6;           // of its kernel, in cells
constexpr double kContrast = 2;         // jumps of a blurred edge, in units of noise
constexpr double kSharpParticles = 16;  // whose noise a sharp edge must stand out from,
constexpr double kSharpContrast = 2;    // and by how much
constexpr float kLeast = 1e-3f;         // openness of a closed wall

struct Estimate {
  double E = 0;
  double overlap = 0;  // of its kernel
  double grain = 0;    // flux of one particle there

  double noise() const { return grain * overlap; }  // variance of 2 sqrt E
};

/// E of one cell with the kernel that holds kParticles, between the two levels that hold fewer and more.
Estimate estimateAt(const std::vector<ScaleLevel>& levels, std::size_t cell) {
  constexpr double few = 0.1;
  double before = few;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const ScaleLevel& level = levels[k];
    const double count = level.count(cell);
    if (count < kParticles && k + 1 < levels.size()) {
      before = std::max(count, few);
      continue;
    }
    if (k == 0 || count <= kParticles || before >= kParticles) return {level.E(cell), level.overlap, level.grain(cell)};
    const double t = std::log(kParticles / before) / std::log(count / before);
    const ScaleLevel& narrow = levels[k - 1];
    return {t * level.E(cell) + (1 - t) * narrow.E(cell),
            std::exp(t * std::log(level.overlap) + (1 - t) * std::log(narrow.overlap)), level.grain(cell)};
  }
  return {};
}

float opennessOf(double squaredJump, double contrast) {
  return std::max(kLeast, static_cast<float>(std::exp(-squaredJump / (contrast * contrast))));
}

/// The middle one of a cell's gray value and its neighbours'.
float medianAround(const CellGrid& grid, const std::vector<float>& E, std::size_t cell) {
  float values[64] = {E[cell]};
  std::size_t count = 1;
  for (const CellGrid::Border& b : grid.bordersOf(cell))
    if (count < std::size(values)) values[count++] = E[b.cell];
  std::nth_element(values, values + count / 2, values + count);
  return std::max(values[count / 2], 0.0f);
}

}  // namespace

Walls blurredWalls(const CellGrid& grid, const CellLight& light) {
  ScaleSpace space(grid, light, {}, kWidest);
  while (space.widen()) {
  }
  const std::vector<ScaleLevel>& levels = space.levels();
  std::vector<Estimate> estimates;
  Walls walls;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    estimates.push_back(estimateAt(levels, i));
    walls.bandwidth.push_back(static_cast<float>(1 / (8 * kPi * estimates[i].overlap)));
  }
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (const CellGrid::Border& b : grid.bordersOf(i)) {
      const Estimate &p = estimates[i], &q = estimates[b.cell];
      const double overlap = std::max(p.overlap, q.overlap), jump = 2 * (std::sqrt(p.E) - std::sqrt(q.E));
      // Over the kernel's width, not over the one cell.
      const double widths = std::max(1 / (4 * kPi * overlap * grid.meanArea()), 0.25);
      const double steps = b.diagonal ? 2 : 1;
      const double noise = std::max({p.noise(), q.noise(), 1e-300});
      walls.openness.push_back(opennessOf(jump * jump * widths / steps / noise, kContrast));
    }
  return walls;
}

std::vector<float> sharpWalls(const CellGrid& grid, const std::vector<float>& E, double darkness) {
  std::vector<double> clean;
  for (std::size_t i = 0; i < grid.size(); ++i) clean.push_back(medianAround(grid, E, i) + darkness);
  std::vector<float> openness;
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (const CellGrid::Border& b : grid.bordersOf(i)) {
      const double low = std::min(clean[i], clean[b.cell]), high = std::max(clean[i], clean[b.cell]);
      const double jump = high > 0 ? 2 * std::sqrt(kSharpParticles) * (1 - std::sqrt(low / high)) : 0.0;
      openness.push_back(opennessOf(jump * jump / (b.diagonal ? 2 : 1), kSharpContrast));
    }
  return openness;
}

}  // namespace deltalux
