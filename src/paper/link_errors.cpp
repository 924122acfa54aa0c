#include "paper/link_errors.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace deltalux::paper {

namespace {

constexpr double kBinsPerOctave = 4, kLowest = -12;  // [layout]
constexpr double kParts = 4;                         // links that one is split into [defined]

}  // namespace

LinkErrors::LinkErrors(const hierarchy::Links& links, const hierarchy::Elements& elements,
                       const OracleSettings& settings)
    : evaluatedAt_(settings.error) {
  struct Bins {
    std::array<std::uint64_t, kBins> count{};
    Bins& operator+=(const Bins& o) {
      for (std::size_t i = 0; i < kBins; ++i) count[i] += o.count[i];
      return *this;
    }
  };
  const Oracle oracle(elements, settings);
  count_ = parallelSum<Bins>(links.size(), 4096, [&](std::size_t i) {
             Bins bins;
             const hierarchy::Link& l = links.all[i];
             if (l.state != hierarchy::LinkState::Active || l.visibility == hierarchy::Visibility::Blocked) return bins;
             const LinkError e = oracle.evaluate(l);
             if (!(e.total() > 0) || !(e.budget > 0)) return bins;
             const double bin = kBinsPerOctave * (std::log2(e.total() / e.budget) - kLowest);
             bins.count[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))] = 1;
             return bins;
           }).count;
}

double LinkErrors::madeBy(double error) const {
  double made = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    const double q = std::exp2((static_cast<double>(i) + 0.5) / kBinsPerOctave + kLowest) * evaluatedAt_ / error;
    if (q > 1) made += kParts * q * static_cast<double>(count_[i]);
  }
  return made;
}

}  // namespace deltalux::paper
