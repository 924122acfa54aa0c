#include "caustics/heat_flow.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux {

namespace {

/// exp(-z) I_k(z) for k = 0 .. as long as they matter, scaled so that c_0 + 2 sum c_k = 1: by recurrence downwards.
/// [Gautschi67]
std::vector<double> scaledBessel(double z, double negligible) {
  const int last = static_cast<int>(std::ceil(std::sqrt(2 * z * -std::log(negligible)))) + 12;
  std::vector<double> c(static_cast<std::size_t>(last) + 1);
  double above = 0, here = 1e-250;
  double sum = 0;
  for (int k = last + 20; k >= 0; --k) {
    if (k <= last) c[static_cast<std::size_t>(k)] = here;
    sum += k == 0 ? here : 2 * here;
    const double below = above + 2 * k / z * here;
    above = here, here = below;
    if (here > 1e200) {
      for (double& value : c) value *= 1e-200;
      here *= 1e-200, above *= 1e-200, sum *= 1e-200;
    }
  }
  for (double& value : c) value /= sum;
  while (c.size() > 2 && c.back() < negligible / static_cast<double>(last)) c.pop_back();
  double kept = c[0];
  for (std::size_t k = 1; k < c.size(); ++k) kept += 2 * c[k];
  for (double& value : c) value /= kept;
  return c;
}

}  // namespace

HeatFlow::HeatFlow(const CellGrid& grid, std::span<const float> conductivity, Openness open) : own_(grid.size()) {
  std::vector<double> leaving(grid.size(), 0.0);
  std::vector<float> edgeWeights;
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (const CellGrid::Border& b : grid.bordersOf(i)) {
      const double a = conductivity[i], c = conductivity[b.cell];
      const double D = a + c > 0 ? 2 * a * c / (a + c) : 0.0;
      const double openness = open.empty() ? 1.0 : double(open[edgeWeights.size()]);
      const double weight = openness * D * b.share / grid.area(i);
      edgeWeights.push_back(static_cast<float>(weight));
      leaving[i] += weight;
    }
  for (const double l : leaving) largest_ = std::max(largest_, 2 * l);  // Gershgorin's circles
  if (!(largest_ > 0)) return;
  for (float& w : edgeWeights) w = static_cast<float>(2 * w / largest_);
  for (std::size_t i = 0; i < own_.size(); ++i) own_[i] = static_cast<float>(2 * leaving[i] / largest_ - 1);
  addRuns(grid, edgeWeights);
}

void HeatFlow::addRuns(const CellGrid& grid, const std::vector<float>& edgeWeights) {
  const auto distance = [&](std::size_t cell, std::size_t k) {
    return static_cast<std::int32_t>(std::int64_t(grid.bordersOf(cell)[k].cell) - std::int64_t(cell));
  };
  const auto alike = [&](std::size_t a, std::size_t b) {
    const std::size_t count = grid.bordersOf(a).size();
    if (grid.bordersOf(b).size() != count || count > kMostNeighbours) return false;
    for (std::size_t k = 0; k < count; ++k)
      if (distance(a, k) != distance(b, k)) return false;
    return true;
  };
  std::size_t edge = 0;  // of the run's first cell
  for (std::size_t first = 0, end = 0; first < grid.size(); first = end) {
    for (end = first + 1; end < grid.size() && alike(first, end);) ++end;
    const std::size_t all = grid.bordersOf(first).size();
    for (std::size_t done = 0; done < all; done += kMostNeighbours) {
      Run run{static_cast<std::uint32_t>(first),
              static_cast<std::uint32_t>(end - first),
              static_cast<std::uint32_t>(weights_.size()),
              static_cast<std::uint32_t>(std::min(kMostNeighbours, all - done)),
              {}};
      for (std::size_t k = 0; k < run.neighbours; ++k) {
        run.offset[k] = distance(first, done + k);
        for (std::size_t i = 0; i < run.count; ++i) weights_.push_back(edgeWeights[edge + i * all + done + k]);
      }
      runs_.push_back(run);
    }
    if (all == 0)
      runs_.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - first), 0, 0, {}});
    edge += (end - first) * all;
  }
}

/// sums[i] -= what flows to cell begin + i from its neighbours in the run.
void HeatFlow::addChunk(const Run& run, std::uint32_t begin, std::uint32_t count, const float* light,
                        float* __restrict sums) const {
  const float* w = weights_.data() + run.weights + (begin - run.first);
  const float* const here = light + begin;
  if (run.neighbours == 8) {
    const std::size_t n = run.count;
    const float *a = here + run.offset[0], *b = here + run.offset[1], *c = here + run.offset[2],
                *d = here + run.offset[3], *e = here + run.offset[4], *f = here + run.offset[5],
                *g = here + run.offset[6], *h = here + run.offset[7];
    for (std::uint32_t i = 0; i < count; ++i)
      sums[i] -= ((w[i] * a[i] + w[n + i] * b[i]) + (w[2 * n + i] * c[i] + w[3 * n + i] * d[i])) +
                 ((w[4 * n + i] * e[i] + w[5 * n + i] * f[i]) + (w[6 * n + i] * g[i] + w[7 * n + i] * h[i]));
    return;
  }
  for (std::uint32_t k = 0; k < run.neighbours; ++k, w += run.count) {
    const float* const there = here + run.offset[k];
    for (std::uint32_t i = 0; i < count; ++i) sums[i] -= w[i] * there[i];
  }
}

namespace {

/// A step of the recurrence of T_k, and its term of the series.
void recur(std::uint32_t count, const float* x, float factor, float* __restrict before, float* __restrict sum) {
  for (std::uint32_t i = 0; i < count; ++i) {
    before[i] = 2.0f * x[i] - before[i];
    sum[i] += factor * before[i];
  }
}

}  // namespace

/// out(channel, begin, count, X E of these cells) with X = 2 L / largest - 1, whose eigenvalues lie in [-1, 1].
template <class Out>
void HeatFlow::step(const Channels& from, const Out& out) const {
  float sums[kChunk];
  for (std::size_t r = 0; r < runs_.size();) {
    std::size_t next = r + 1;
    while (next < runs_.size() && runs_[next].first == runs_[r].first) ++next;
    const std::uint32_t end = runs_[r].first + runs_[r].count;
    for (std::uint32_t begin = runs_[r].first; begin < end; begin += kChunk) {
      const std::uint32_t count = std::min<std::uint32_t>(kChunk, end - begin);
      for (std::size_t c = 0; c < from.size(); ++c) {
        const float* const light = from[c].data();
        for (std::uint32_t i = 0; i < count; ++i) sums[i] = own_[begin + i] * light[begin + i];
        for (std::size_t k = r; k < next; ++k) addChunk(runs_[k], begin, count, light, sums);
        out(c, begin, count, sums);
      }
    }
    r = next;
  }
}

void HeatFlow::run(Channels& E, double time, double negligible) const {
  const double z = 0.5 * largest_ * time;
  if (!(z > 0)) return;
  // exp(-z (x + 1)) = sum over k of (-1)^k (2 - [k = 0]) exp(-z) I_k(z) T_k(x)
  const std::vector<double> c = scaledBessel(z, negligible);
  Channels before = E, now = E;
  const auto zeroth = static_cast<float>(c[0]), first = static_cast<float>(-2 * c[1]);
  step(before, [&](std::size_t channel, std::uint32_t begin, std::uint32_t count, const float* x) {
    for (std::uint32_t i = 0; i < count; ++i) {
      now[channel][begin + i] = x[i];
      E[channel][begin + i] = zeroth * before[channel][begin + i] + first * x[i];
    }
  });
  for (std::size_t k = 2; k < c.size(); ++k) {
    const auto factor = static_cast<float>(k % 2 == 0 ? 2 * c[k] : -2 * c[k]);
    step(now, [&](std::size_t channel, std::uint32_t begin, std::uint32_t count, const float* x) {
      recur(count, x, factor, before[channel].data() + begin, E[channel].data() + begin);
    });
    std::swap(before, now);
  }
}

void HeatFlow::apply(std::vector<float>& E, double time, double negligible) const {
  Channels channels(1);
  std::swap(channels[0], E);
  run(channels, time, negligible);
  std::swap(channels[0], E);
}

template <class Value>
void HeatFlow::applyTo(std::vector<Value>& E, double time, double negligible) const {
  Channels channels(static_cast<std::size_t>(Value::length()), std::vector<float>(E.size()));
  for (std::size_t i = 0; i < E.size(); ++i)
    for (int c = 0; c < Value::length(); ++c) channels[c][i] = E[i][c];
  run(channels, time, negligible);
  for (std::size_t i = 0; i < E.size(); ++i)
    for (int c = 0; c < Value::length(); ++c) E[i][c] = channels[c][i];
}

void HeatFlow::apply(std::vector<glm::vec2>& E, double time, double negligible) const { applyTo(E, time, negligible); }
void HeatFlow::apply(std::vector<Rgb>& E, double time, double negligible) const { applyTo(E, time, negligible); }

}  // namespace deltalux
