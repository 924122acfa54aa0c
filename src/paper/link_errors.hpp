#pragma once
// How far links are from a target error: a histogram of error over budget, from which the work that a smaller target
// would take can be read before any of it is done. Cost: one evaluation a link.
#include <array>

#include "hierarchy/link.hpp"
#include "paper/oracle.hpp"

namespace deltalux::paper {

class LinkErrors {
 public:
  /// Of the links that carry light, evaluated at `settings.error`.
  LinkErrors(const hierarchy::Links&, const hierarchy::Elements&, const OracleSettings& settings);

  /// About how many links refinement to `error` makes: a link whose error is q budgets ends as kParts q of them.
  double madeBy(double error) const;

 private:
  static constexpr int kBins = 96;  // four to an octave, from 2^-12 to 2^12 [layout]
  double evaluatedAt_;
  std::array<std::uint64_t, kBins> count_{};
};

}  // namespace deltalux::paper
