#include "caustics/walls.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace deltalux {

namespace {

constexpr double kParticles = 30;       // of a kernel that edges are looked for with
constexpr double kWidest = 6;           // of its kernel, in cells
constexpr double kContrast = 2;         // jumps of a blurred edge, in units of noise
constexpr double kSharpParticles = 16;  // whose noise a sharp edge must stand out from,
constexpr double kSharpContrast = 2;    // and by how much
constexpr float kLeast = 1e-3f;         // openness of a closed wall

/// Of all cells, each with the kernel that holds kParticles.
struct Estimates {
  std::vector<float> root;     // of E
  std::vector<float> overlap;  // of the kernel
  std::vector<float> noise;    // variance of 2 sqrt E
};

/// Between the two levels that hold fewer and more.
Estimates estimatesOf(const std::vector<ScaleLevel>& levels) {
  constexpr double few = 0.1, tiny = 1e-30;
  std::vector<double> logs;
  for (const ScaleLevel& l : levels) logs.push_back(std::log(l.overlap));
  const std::size_t cells = levels[0].light[0].size();
  Estimates result{std::vector<float>(cells), std::vector<float>(cells), std::vector<float>(cells)};
  for (std::size_t cell = 0; cell < cells; ++cell) {
    std::size_t k = 0;
    double before = few, count = levels[0].count(cell);
    while (count < kParticles && k + 1 < levels.size()) before = std::max(count, few), count = levels[++k].count(cell);
    const ScaleLevel& level = levels[k];
    double E = level.E(cell), overlap = level.overlap;
    if (k > 0 && count > kParticles && before < kParticles) {
      const double t = std::log(kParticles / before) / std::log(count / before);
      E = t * E + (1 - t) * levels[k - 1].E(cell);
      overlap = std::exp(t * logs[k] + (1 - t) * logs[k - 1]);
    }
    result.root[cell] = static_cast<float>(std::sqrt(E));
    result.overlap[cell] = static_cast<float>(overlap);
    result.noise[cell] = static_cast<float>(std::max(level.grain(cell) * overlap, tiny));
  }
  return result;
}

/// exp(-x) for x >= 0, to 1e-6 of it; 0 where it is tiny. Written so that loops over it become vector code.
inline float expOfMinus(float x) {
  const float powers = std::max(-126.0f, -1.44269504f * x), whole = std::floor(powers);
  const float part = (powers - whole) * 0.693147181f;
  const float series =
      1 + part * (1 + part * (0.5f + part * (1.6666667e-1f +
                                             part * (4.1666667e-2f + part * (8.3333333e-3f + part * 1.3888889e-3f)))));
  return std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23) * series;
}

/// Brings the middle one of nine to the middle.
void medianOfNine(std::array<float, 9>& v) {
  const auto sort = [&](int a, int b) {
    const float low = std::min(v[a], v[b]);
    v[b] = std::max(v[a], v[b]), v[a] = low;
  };
  sort(1, 2), sort(4, 5), sort(7, 8), sort(0, 1), sort(3, 4), sort(6, 7), sort(1, 2), sort(4, 5), sort(7, 8);
  sort(0, 3), sort(5, 8), sort(4, 7), sort(3, 6), sort(1, 4), sort(2, 5), sort(4, 7), sort(4, 2), sort(6, 4);
  sort(4, 2);
}

/// The middle ones of all cells' gray values and their neighbours', and at least 0.
std::vector<float> mediansAround(const CellGraph& graph, const std::vector<float>& E) {
  constexpr std::size_t most = 64;
  std::vector<float> result(E.size());
  const std::span<const CellGraph::Run> runs = graph.runs();
  for (std::size_t r = 0, next = 0; r < runs.size(); r = next) {
    for (next = r + 1; next < runs.size() && runs[next].first == runs[r].first;) ++next;
    const CellGraph::Run& run = runs[r];
    for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
      if (next == r + 1 && run.neighbours == 8) {
        std::array<float, 9> values;
        for (std::size_t n = 0; n < 8; ++n) values[n] = E[i + static_cast<std::uint32_t>(run.offset[n])];
        values[8] = E[i];
        medianOfNine(values);
        result[i] = std::max(values[4], 0.0f);
        continue;
      }
      float values[most] = {E[i]};
      std::size_t count = 1;
      for (std::size_t k = r; k < next; ++k)
        for (std::uint32_t n = 0; n < runs[k].neighbours && count < most; ++n)
          values[count++] = E[i + static_cast<std::uint32_t>(runs[k].offset[n])];
      std::nth_element(values, values + count / 2, values + count);
      result[i] = std::max(values[count / 2], 0.0f);
    }
  }
  return result;
}

/// By border: exp(-x / contrast^2), x = squared(cell, neighbour), halved over diagonals: the cells are further apart.
template <class Squared>
std::vector<float> opennessBy(const CellGraph& graph, double contrast, const Squared& squared) {
  std::vector<float> openness(graph.borders());
  for (const CellGraph::Run& run : graph.runs())
    for (std::uint32_t k = 0; k < run.neighbours; ++k) {
      const auto factor = static_cast<float>((run.diagonal[k] ? 0.5 : 1) / (contrast * contrast));
      float* __restrict const to = openness.data() + run.borders + k * run.count;
      const std::size_t here = run.first, there = here + static_cast<std::size_t>(std::ptrdiff_t(run.offset[k]));
      for (std::uint32_t i = 0; i < run.count; ++i)
        to[i] = std::max(kLeast, expOfMinus(factor * squared(here + i, there + i)));
    }
  return openness;
}

}  // namespace

Walls blurredWalls(const CellGraph& graph, const CellLight& light) {
  CellPyramid pyramid(graph, {});
  ScaleSpace space(pyramid, light, kWidest);
  while (space.widen()) {
  }
  const Estimates estimates = estimatesOf(space.levels());
  const float *root = estimates.root.data(), *overlap = estimates.overlap.data(), *noise = estimates.noise.data();
  Walls walls;
  for (std::size_t i = 0; i < graph.size(); ++i)
    walls.bandwidth.push_back(static_cast<float>(1 / (8 * kPi * estimates.overlap[i])));
  const auto cell = static_cast<float>(4 * kPi * graph.meanArea());
  walls.openness = opennessBy(graph, kContrast, [=](std::size_t a, std::size_t b) {
    const float jump = 2 * (root[a] - root[b]);
    // Over the kernel's width, not over the one cell.
    const float widths = std::max(1 / (cell * std::max(overlap[a], overlap[b])), 0.25f);
    return jump * jump * widths / std::max(noise[a], noise[b]);
  });
  return walls;
}

std::vector<float> sharpWalls(const CellGraph& graph, const std::vector<float>& E, double darkness) {
  constexpr float tiny = 1e-30f;
  std::vector<float> roots = mediansAround(graph, E);
  for (float& r : roots) r = std::sqrt(r + static_cast<float>(darkness));
  const float* const root = roots.data();
  const auto noise = static_cast<float>(2 * std::sqrt(kSharpParticles));
  return opennessBy(graph, kSharpContrast, [=](std::size_t a, std::size_t b) {
    const float jump = noise * (1 - std::min(root[a], root[b]) / std::max({root[a], root[b], tiny}));
    return jump * jump;
  });
}

}  // namespace deltalux
