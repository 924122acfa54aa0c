#include "io/tm33/superpose.hpp"

#include <algorithm>
#include <iterator>

namespace deltalux::io {

Photometry superpose(const Photometry& a, const Photometry& b) {
  Photometry sum;
  std::ranges::set_union(a.verticals, b.verticals, std::back_inserter(sum.verticals));
  std::ranges::set_union(a.horizontals, b.horizontals, std::back_inserter(sum.horizontals));
  sum.candela.reserve(sum.verticals.size() * sum.horizontals.size());
  for (const double horizontal : sum.horizontals)
    for (const double vertical : sum.verticals)
      sum.candela.push_back(candela(a, vertical, horizontal) + candela(b, vertical, horizontal));
  sum.opening = a.opening;
  return sum;
}

}  // namespace deltalux::io
