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
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (const CellGrid::Border& b : grid.bordersOf(i)) {
      const double a = conductivity[i], c = conductivity[b.cell];
      const double D = a + c > 0 ? 2 * a * c / (a + c) : 0.0;
      const double openness = open.empty() ? 1.0 : double(open[edges_.size()]);
      const double weight = openness * D * b.share / grid.area(i);
      edges_.push_back({b.cell, static_cast<float>(weight)});
      leaving[i] += weight;
    }
    ends_.push_back(static_cast<std::uint32_t>(edges_.size()));
  }
  for (const double l : leaving) largest_ = std::max(largest_, 2 * l);  // Gershgorin's circles
  if (!(largest_ > 0)) return;
  for (Edge& e : edges_) e.weight = static_cast<float>(2 * e.weight / largest_);
  for (std::size_t i = 0; i < own_.size(); ++i) own_[i] = static_cast<float>(2 * leaving[i] / largest_ - 1);
}

/// out(i, (X E)_i) with X = 2 L / largest - 1, whose eigenvalues lie in [-1, 1].
template <class Value, class Out>
void HeatFlow::step(const std::vector<Value>& from, const Out& out) const {
  const Edge* edge = edges_.data();
  const Value* const light = from.data();
  for (std::size_t i = 0; i < from.size(); ++i) {
    Value x = own_[i] * light[i];
    for (const Edge* const end = edges_.data() + ends_[i]; edge != end; ++edge) x -= edge->weight * light[edge->cell];
    out(i, x);
  }
}

template <class Value>
void HeatFlow::run(std::vector<Value>& E, double time, double negligible) const {
  const double z = 0.5 * largest_ * time;
  if (!(z > 0)) return;
  // exp(-z (x + 1)) = sum over k of (-1)^k (2 - [k = 0]) exp(-z) I_k(z) T_k(x)
  const std::vector<double> c = scaledBessel(z, negligible);
  std::vector<Value> before = E, now(E.size()), sum(E.size());
  const auto first = static_cast<float>(c[0]), second = static_cast<float>(-2 * c[1]);
  step(before, [&](std::size_t i, const Value& x) {
    now[i] = x;
    sum[i] = first * before[i] + second * x;
  });
  for (std::size_t k = 2; k < c.size(); ++k) {
    const auto factor = static_cast<float>(k % 2 == 0 ? 2 * c[k] : -2 * c[k]);
    step(now, [&](std::size_t i, const Value& x) {
      before[i] = 2.0f * x - before[i];
      sum[i] += factor * before[i];
    });
    std::swap(before, now);
  }
  E = std::move(sum);
}

void HeatFlow::apply(std::vector<float>& E, double time, double negligible) const { run(E, time, negligible); }
void HeatFlow::apply(std::vector<glm::vec2>& E, double time, double negligible) const { run(E, time, negligible); }
void HeatFlow::apply(std::vector<Rgb>& E, double time, double negligible) const { run(E, time, negligible); }

}  // namespace deltalux
