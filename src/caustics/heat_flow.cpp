#include "caustics/heat_flow.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

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

HeatFlow::HeatFlow(const CellGraph& graph, std::span<const float> conductivity, Openness open)
    : runs_(graph.runs()), weights_(graph.borders()), own_(graph.size(), 0.0f) {
  for (std::uint32_t r = 0; r < runs_.size(); ++r)
    if (r == 0 || runs_[r].first != runs_[r - 1].first) rows_.push_back(r);
  rows_.push_back(static_cast<std::uint32_t>(runs_.size()));
  for (const CellGraph::Run& run : runs_)
    for (std::uint32_t k = 0; k < run.neighbours; ++k) {
      const std::uint32_t n = run.count, border = run.borders + k * n;
      const float *share = graph.shares().data() + border, *area = graph.areas().data() + run.first,
                  *here = conductivity.data() + run.first, *there = here + run.offset[k];
      float* __restrict const weight = weights_.data() + border;
      float* __restrict const leaving = own_.data() + run.first;
      for (std::uint32_t i = 0; i < n; ++i) {
        const float both = here[i] + there[i];
        weight[i] = both > 0 ? 2 * (here[i] / both) * (there[i] / area[i]) * share[i] : 0.0f;
      }
      if (!open.empty())
        for (std::uint32_t i = 0; i < n; ++i) weight[i] *= open[border + i];
      for (std::uint32_t i = 0; i < n; ++i) leaving[i] += weight[i];
    }
  float most = 0;
  for (const float leaving : own_) most = std::max(most, leaving);
  largest_ = 2.0 * most;  // Gershgorin's circles
  if (!(largest_ > 0)) return;
  const auto scale = static_cast<float>(2 / largest_);
  for (float& w : weights_) w *= scale;
  for (float& o : own_) o = scale * o - 1;
}

/// sums[i] -= what flows to cell begin + i from its neighbours in the run.
void HeatFlow::addChunk(const CellGraph::Run& run, std::uint32_t begin, std::uint32_t count, const float* light,
                        float* __restrict sums) const {
  const float* w = weights_.data() + run.borders + (begin - run.first);
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

/// A step of the recurrence of T_k.
void recur(std::uint32_t count, const float* x, float* __restrict before) {
  for (std::uint32_t i = 0; i < count; ++i) before[i] = 2.0f * x[i] - before[i];
}

/// A term of a series.
void addTerm(std::uint32_t count, float factor, const float* term, float* __restrict sum) {
  for (std::uint32_t i = 0; i < count; ++i) sum[i] += factor * term[i];
}

}  // namespace

/// out(channel, begin, count, X E of these cells) with X = 2 L / largest - 1, whose eigenvalues lie in [-1, 1]; of
/// several chunks at once.
template <class Out>
void HeatFlow::step(const Channels& from, const Out& out) const {
  const std::size_t rows = rows_.size() - 1;
  const std::size_t block = own_.size() < kWorth ? rows : rows * kWorth / (4 * own_.size()) + 1;
  parallelFor(rows, std::max<std::size_t>(block, 1),
              [&](std::size_t r) { stepRow(rows_[r], rows_[r + 1], from, out); });
}

/// Of runs of the same cells.
template <class Out>
void HeatFlow::stepRow(std::uint32_t first, std::uint32_t end, const Channels& from, const Out& out) const {
  float sums[kChunk];
  const std::uint32_t last = runs_[first].first + runs_[first].count;
  for (std::uint32_t begin = runs_[first].first; begin < last; begin += kChunk) {
    const std::uint32_t count = std::min<std::uint32_t>(kChunk, last - begin);
    for (std::size_t c = 0; c < from.size(); ++c) {
      const float* const light = from[c].data();
      for (std::uint32_t i = 0; i < count; ++i) sums[i] = own_[begin + i] * light[begin + i];
      for (std::uint32_t k = first; k < end; ++k) addChunk(runs_[k], begin, count, light, sums);
      out(c, begin, count, sums);
    }
  }
}

std::vector<Channels> HeatFlow::after(Channels E, std::span<const double> times, double negligible) const {
  // exp(-z (x + 1)) = sum over k of (-1)^k (2 - [k = 0]) exp(-z) I_k(z) T_k(x)
  std::vector<std::vector<float>> factors;
  std::vector<Channels> sums;
  for (const double time : times) {
    const double z = 0.5 * largest_ * time;
    sums.push_back(E);
    factors.emplace_back();
    if (!(z > 0)) continue;
    for (const double c : scaledBessel(z, negligible)) {
      const std::size_t k = factors.back().size();
      factors.back().push_back(static_cast<float>(k == 0 ? c : k % 2 == 0 ? 2 * c : -2 * c));
    }
  }
  std::size_t terms = 0;
  for (const auto& f : factors) terms = std::max(terms, f.size());
  if (terms == 0) return sums;

  const auto add = [&](std::size_t k, std::size_t channel, std::uint32_t begin, std::uint32_t count, const float* T) {
    for (std::size_t t = 0; t < sums.size(); ++t)
      if (k < factors[t].size()) addTerm(count, factors[t][k], T, sums[t][channel].data() + begin);
  };
  Channels now = E;
  step(E, [&](std::size_t channel, std::uint32_t begin, std::uint32_t count, const float* x) {
    std::copy_n(x, count, now[channel].data() + begin);
    for (std::size_t t = 0; t < sums.size(); ++t) {
      if (factors[t].empty()) continue;
      float* const sum = sums[t][channel].data() + begin;
      for (std::uint32_t i = 0; i < count; ++i) sum[i] = factors[t][0] * sum[i] + factors[t][1] * x[i];
    }
  });
  Channels& before = E;
  for (std::size_t k = 2; k < terms; ++k) {
    step(now, [&](std::size_t channel, std::uint32_t begin, std::uint32_t count, const float* x) {
      float* const T = before[channel].data() + begin;
      recur(count, x, T);
      add(k, channel, begin, count, T);
    });
    std::swap(before, now);
  }
  return sums;
}

void HeatFlow::apply(Channels& E, double time, double negligible) const {
  E = std::move(after(std::move(E), std::span(&time, 1), negligible).front());
}

void HeatFlow::apply(std::vector<float>& E, double time, double negligible) const {
  Channels channels(1);
  std::swap(channels[0], E);
  apply(channels, time, negligible);
  std::swap(channels[0], E);
}

void HeatFlow::relax(Channels& E, double time) const {
  const Channels before = E;
  step(before, [&](std::size_t channel, std::uint32_t begin, std::uint32_t count, const float* x) {
    const float *own = own_.data() + begin, *was = before[channel].data() + begin;
    float* const is = E[channel].data() + begin;
    const auto half = static_cast<float>(0.5 * largest_), most = static_cast<float>(time);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float leaving = half * (own[i] + 1), flow = half * (x[i] + was[i]);
      is[i] = was[i] - (most * leaving <= 1 ? most : 1 / leaving) * flow;
    }
  });
}

}  // namespace deltalux
