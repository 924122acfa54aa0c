#include "paper/spiral.hpp"

#include <algorithm>
#include <utility>

namespace deltalux::paper {

namespace {

using caustics::CellGrid;
using caustics::CellLight;

/// The texel at (x, y), which may lie past a seam or a pole; -1 outside.
int texelPast(const CellGrid& grid, int x, int y) {
  const int w = grid.width(), h = grid.height();
  if (y < 0 && grid.poleAtStart()) y = -1 - y, x += w / 2;
  if (y >= h && grid.poleAtEnd()) y = 2 * h - 1 - y, x += w / 2;
  if (grid.closed()) x = (x % w + w) % w;
  return x < 0 || y < 0 || x >= w || y >= h ? -1 : y * w + x;
}

/// Visits the cells of the texels on the square ring of radius r.
template <class Visit>
void forRing(const CellGrid& grid, int x, int y, int r, const Visit& visit) {
  for (int dy = -r; dy <= r; ++dy)
    for (int dx = -r; dx <= r; dx += std::abs(dy) == r ? 1 : 2 * r) {
      const int texel = texelPast(grid, x + dx, y + dy);
      if (texel >= 0 && grid.cellOf(static_cast<std::size_t>(texel)) != CellGrid::kNone)
        visit(grid.cellOf(static_cast<std::size_t>(texel)));
      if (r == 0) return;
    }
}

/// Cells that were met before: several texels may share one.
class Met {
 public:
  explicit Met(std::size_t cells) : last_(cells, 0) {}
  void startOver() { ++turn_; }
  bool again(std::uint32_t cell) { return std::exchange(last_[cell], turn_) == turn_; }

 private:
  std::vector<std::uint32_t> last_;
  std::uint32_t turn_ = 0;
};

struct Reach {
  int radius = 0;
  double area = 0;  // that the kernel covers
};

Reach reachOf(const CellGrid& grid, const CellLight& light, int x, int y, int limit, double most, Met& met) {
  Reach reach;
  met.startOver();
  double gathered = 0;
  for (int r = 0; r <= limit; ++r) {
    forRing(grid, x, y, r, [&](std::uint32_t cell) {
      if (met.again(cell)) return;
      gathered += light.gray[cell];
      reach.area += grid.area(cell);
    });
    reach.radius = r;
    if (gathered >= most) break;  // [GD01 (8)]
  }
  return reach;
}

}  // namespace

std::vector<Rgb> reconstructSpiral(const caustics::CellGrid& grid, const caustics::CellLight& light, int radius) {
  const int limit = std::min({radius, grid.width() / 2, grid.height()});
  const double most = light.gray.empty() ? 0.0 : *std::max_element(light.gray.begin(), light.gray.end());
  std::vector<Reach> reaches(grid.size());
  Met met(grid.size());
  const auto forTexels = [&](const auto& body) {
    for (int y = 0; y < grid.height(); ++y)
      for (int x = 0; x < grid.width(); ++x) {
        const std::uint32_t cell = grid.cellOf(static_cast<std::size_t>(y) * grid.width() + x);
        if (cell != CellGrid::kNone) body(x, y, cell);
      }
  };
  forTexels([&](int x, int y, std::uint32_t cell) {
    if (reaches[cell].area == 0) reaches[cell] = reachOf(grid, light, x, y, limit, most, met);
  });

  // Cells that several texels share take part once.
  std::vector<char> done(grid.size(), 0);
  std::vector<RgbSum> E(light.E.begin(), light.E.end());
  forTexels([&](int x, int y, std::uint32_t a) {
    if (done[a]) return;
    done[a] = 1;
    met.startOver();
    for (int r = 1; r <= reaches[a].radius; ++r)
      forRing(grid, x, y, r, [&](std::uint32_t b) {
        if (b <= a || r > reaches[b].radius || met.again(b)) return;
        const double shared = 1 / std::max(reaches[a].area, reaches[b].area);
        const RgbSum flow = shared * (RgbSum(light.E[b]) - RgbSum(light.E[a]));
        E[a] += double(grid.area(b)) * flow, E[b] -= double(grid.area(a)) * flow;
      });
  });
  std::vector<Rgb> result;
  for (const RgbSum& e : E) result.push_back(Rgb(glm::max(e, RgbSum(0.0))));
  return result;
}

}  // namespace deltalux::paper
