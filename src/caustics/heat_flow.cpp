#include "caustics/heat_flow.hpp"

#include <cmath>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "caustics/tuning.hpp"

namespace deltalux::caustics {

HeatFlow::HeatFlow(const CellRaster& raster, std::span<const float> conductivity, const Borders* open)
    : raster_(raster), through_(raster.shares()), own_(raster.slots(), 0.0f), perArea_(raster.slots(), 0.0f) {
  const std::size_t begin = raster.rowBegin(0), end = raster.rowBegin(raster.rows());
  const auto across = raster.across();
  for (std::size_t b = 0; b < 4; ++b) {
    float* const to = through_[b].data();
    if (open) {
      const float* const factor = (*open)[b].data();
      for (std::size_t i = begin; i < end; ++i) to[i] *= factor[i];
    }
    if (conductivity.empty()) continue;
    const float *here = conductivity.data(), *there = here + across[b];
    for (std::size_t i = begin; i < end; ++i) {
      const float both = here[i] + there[i];
      to[i] *= both > 0 ? 2 * here[i] * (there[i] / both) : 0.0f;
    }
  }
  const float *a = through_[0].data(), *b = through_[1].data(), *c = through_[2].data(), *d = through_[3].data();
  const float* const area = raster.areas().data();
  float* __restrict const own = own_.data(), * __restrict const perArea = perArea_.data();
  const std::size_t S = raster.stride();
  for (std::size_t i = begin; i < end; ++i) {
    own[i] = ((a[i] + a[i - 1]) + (b[i] + b[i - S])) + ((c[i] + c[i - S - 1]) + (d[i] + d[i - S + 1]));
    perArea[i] = area[i] > 0 ? 1 / area[i] : 0.0f;
  }
  largest_ = 2.0 * raster.mostPerArea(own_);  // Gershgorin's circles
}

/// before = factors.now * now - factors.before * before - factors.flow * (L now)
template <std::size_t channels>
void HeatFlow::stepRow(std::size_t row, const Factors& f, const std::array<float*, channels>& now,
                       const std::array<float*, channels>& before) const {
  const std::size_t S = raster_.stride(), begin = raster_.rowBegin(row);
  const float *a = through_[0].data() + begin, *b = through_[1].data() + begin, *c = through_[2].data() + begin,
              *d = through_[3].data() + begin, *own = own_.data() + begin, *perArea = perArea_.data() + begin;
  const float *left = a - 1, *below = b - S, *belowLeft = c - S - 1, *belowRight = d - S + 1;
#pragma GCC ivdep
  for (std::size_t i = 0; i < S; ++i) {
    const float flow = f.flow * perArea[i];
#pragma GCC unroll 3
    for (std::size_t k = 0; k < channels; ++k) {
      const float *x = now[k] + begin, *up = x + S, *down = x - S;
      const float arriving =
          ((a[i] * x[i + 1] + left[i] * x[i - 1]) + (b[i] * up[i] + below[i] * down[i])) +
          ((c[i] * up[i + 1] + belowLeft[i] * down[i - 1]) + (d[i] * up[i - 1] + belowRight[i] * down[i + 1]));
      float& to = before[k][begin + i];
      to = (f.now * x[i] - f.before * to) + flow * (arriving - own[i] * x[i]);
    }
  }
  for (float* const values : before) raster_.even(row, values);
}

template <std::size_t channels>
void HeatFlow::applyTo(Channels& E, double time) const {
  // The fewest steps that are stable, and damp even the fastest modes: at the far end of its range the polynomial is 1
  // again, and falls off from there as it does from this end.
  const double z = 0.5 * largest_ * time + tuning::kDamping;
  const auto reach = [](double steps) { return steps * (steps + 2 * kOrder) / (2 * kOrder + 1); };
  const int steps = static_cast<int>(std::ceil(std::sqrt(kOrder * kOrder + (2 * kOrder + 1) * z) - kOrder));
  const double scale = time / reach(steps);  // times L: the polynomials' argument is 1 - that [OSullivan19]
  std::array<Slots, channels> other;
  std::array<float*, channels> now, before;
  for (std::size_t k = 0; k < channels; ++k)
    other[k].assign(raster_.slots(), 0.0f), now[k] = E[k].data(), before[k] = other[k].data();
  const std::size_t rows = raster_.rows();
  const std::size_t block = raster_.slots() < kWorth ? rows : kWorth / (4 * raster_.stride()) + 1;
  for (int n = 0; n < steps; ++n) {
    // (n + 2 alpha) P_{n+1} = 2 (n + alpha) x P_n - n P_{n-1}, of polynomials that are 1 at x = 1
    const double both = n + 2 * kOrder, ahead = 2 * (n + kOrder) / both;
    const Factors factors{static_cast<float>(ahead * scale), static_cast<float>(ahead), static_cast<float>(n / both)};
    if (block >= rows)
      for (std::size_t row = 0; row < rows; ++row) stepRow<channels>(row, factors, now, before);
    else
      parallelFor(rows, block, [&](std::size_t row) { stepRow<channels>(row, factors, now, before); });
    std::swap(now, before);
  }
  if (steps % 2 == 1)
    for (std::size_t k = 0; k < channels; ++k) std::swap(E[k], other[k]);
}

void HeatFlow::apply(Channels& E, double time) const {
  if (!(largest_ * time > 0)) return;
  DELTALUX_CHECK(E.size() >= 1 && E.size() <= 3, "one to three channels");
  if (E.size() == 1) applyTo<1>(E, time);
  if (E.size() == 2) applyTo<2>(E, time);
  if (E.size() == 3) applyTo<3>(E, time);
}

void HeatFlow::apply(Slots& E, double time) const {
  Channels channels(1);
  std::swap(channels[0], E);
  apply(channels, time);
  std::swap(channels[0], E);
}

}  // namespace deltalux::caustics
