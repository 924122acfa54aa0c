#include <algorithm>
#include <cmath>
#include <deltalux/design.hpp>
#include <optional>

#include "base/check.hpp"

namespace deltalux {

namespace {

using Row = std::vector<double>;
using Matrix = std::vector<Row>;

constexpr double kRidge = 1e-13;  // of the largest diagonal: groups that bring the same are told apart [rounding]
constexpr double kSlack = 1e-10;  // of a gradient, relative, that is none [rounding]

double dot(const Row& a, const Row& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// x of A x = b, A symmetric and positive definite. (Cholesky)
Row solve(Matrix A, Row b) {
  const std::size_t n = b.size();
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) A[j][j] -= A[j][k] * A[j][k];
    A[j][j] = std::sqrt(A[j][j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= A[i][k] * b[k];
    b[i] /= A[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= A[k][i] * b[k];
    b[i] /= A[i][i];
  }
  return b;
}

/// Least squares within bounds of 0 and 1, by the normal equations G w = c. [SP95]
class BoundedFit {
 public:
  BoundedFit(Matrix G, Row c) : G_(std::move(G)), c_(std::move(c)), w_(c_.size(), 0.0), free_(c_.size(), 0) {}

  Row weights() {
    // Each step lowers the sum of squares; there are finitely many sets of weights that are free.
    std::vector<char> spent(c_.size(), 0);  // came back to its bound at once, by rounding
    while (const auto freed = steepest(spent)) {
      const double before = w_[*freed];
      free_[*freed] = 1;
      while (!solveFree()) {
      }
      if (free_[*freed] || w_[*freed] != before)
        std::ranges::fill(spent, 0);
      else
        spent[*freed] = 1;
    }
    return w_;
  }

 private:
  /// The bounded weight that the sum falls most by.
  std::optional<std::size_t> steepest(const std::vector<char>& spent) const {
    std::optional<std::size_t> best;
    double most = 0;
    for (std::size_t j = 0; j < w_.size(); ++j) {
      if (free_[j] || spent[j] || !(G_[j][j] > 0)) continue;
      const double down = c_[j] - dot(G_[j], w_), gain = w_[j] > 0 ? -down : down;
      const double share = gain / std::sqrt(G_[j][j]);
      if (gain > kSlack * (std::abs(c_[j]) + G_[j][j]) && share > most) most = share, best = j;
    }
    return best;
  }

  /// Goes from where it is towards the best of the free weights. False where some met a bound before: they stay there.
  bool solveFree() {
    std::vector<std::size_t> which;
    for (std::size_t j = 0; j < w_.size(); ++j)
      if (free_[j]) which.push_back(j);
    Matrix A(which.size(), Row(which.size()));
    Row b(which.size());
    for (std::size_t i = 0; i < which.size(); ++i) {
      b[i] = c_[which[i]];
      for (std::size_t j = 0; j < w_.size(); ++j)
        if (!free_[j]) b[i] -= G_[which[i]][j] * w_[j];
      for (std::size_t j = 0; j < which.size(); ++j) A[i][j] = G_[which[i]][which[j]];
    }
    const Row best = solve(std::move(A), std::move(b));
    double step = 1;
    for (std::size_t i = 0; i < which.size(); ++i) {
      const double from = w_[which[i]], bound = best[i] > 1 ? 1.0 : 0.0;
      if (best[i] < 0 || best[i] > 1) step = std::min(step, (bound - from) / (best[i] - from));
    }
    bool all = true;
    for (std::size_t i = 0; i < which.size(); ++i) {
      double& w = w_[which[i]];
      const double to = best[i], bound = to > 1 ? 1.0 : 0.0;
      const bool meets = (to < 0 || to > 1) && (bound - w) / (to - w) <= step;
      w = meets ? bound : std::clamp(w + step * (to - w), 0.0, 1.0);
      if (meets) free_[which[i]] = 0, all = false;
    }
    return all;
  }

  Matrix G_;
  Row c_, w_;
  std::vector<char> free_;
};

}  // namespace

Dimmed bestDimming(const Matrix& brings, const Row& targets) {
  for (const Row& group : brings) DELTALUX_CHECK(group.size() == targets.size(), "a value a point");
  const std::size_t n = brings.size();
  Matrix G(n, Row(n));
  Row c(n);
  double most = 0;
  for (std::size_t i = 0; i < n; ++i) {
    c[i] = dot(brings[i], targets);
    for (std::size_t j = 0; j < n; ++j) G[i][j] = dot(brings[i], brings[j]);
    most = std::max(most, G[i][i]);
  }
  for (std::size_t i = 0; i < n; ++i)
    if (G[i][i] > 0) G[i][i] += kRidge * most;
  Dimmed result{BoundedFit(std::move(G), std::move(c)).weights(), Row(targets.size(), 0.0)};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t p = 0; p < targets.size(); ++p) result.reached[p] += result.weights[i] * brings[i][p];
  return result;
}

}  // namespace deltalux
