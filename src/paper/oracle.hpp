#pragma once
// When to refine a link, from one number: the target relative error of irradiance. A link may err by the power
//
//     budget(r) = share * error * tolerance(r) * max(A_r, A_0(r)),   A_0 = (scale * mean free path)^2
//
// where tolerance(r) is the irradiance that r has now (a mean that favours dark parts) and A_0 the area that matters to
// the light of r's surroundings: light varies over distances like those to other surfaces [WH92],
// so an error on less than A_0 weighs only as much as its share of A_0. Nothing here depends on the scene's size, and
// shadow edges end at patches of about error * A_0.
//
// Which error is asked of links for one of irradiance: oracleSettingsFor() (solve.hpp).
#include "hierarchy/link.hpp"

namespace deltalux::paper {

/// Calibrated against reference values (docs/links.md); not meant to be set by users.
struct OracleSettings {
  double error = 0.2;   // target relative error of irradiance
  double share = 0.1;   // of the target that one link may take
  double scale = 0.3;   // of the mean free path, gives the side of A_0
  double doubt = 4.0;   // weight of what sample rays leave unknown, against kernel variation (which is a bound)
  double finest = 0.6;  // least area of a patch that is still split: finest * error * A_0
  double direct = 4;    // budget of direct light against indirect: one link brings most of it
};

/// What the oracle finds about one link, all in watts (gray).
struct LinkError {
  double receiver = 0;  // what splitting the receiver may mend
  double sender = 0;    // what splitting the sender may mend
  double visibility = 0;
  double power = 0;  // unoccluded transfer
  double budget = 0;

  double total() const { return receiver + sender + visibility; }
};

class Oracle {
 public:
  Oracle(const hierarchy::Elements&, const OracleSettings&);

  /// The error of a link whose K and spreads are set; visibility counts as far as it is known.
  LinkError evaluate(const hierarchy::Link&) const;
  /// Power that links to `receiver` may err by [W].
  double budget(hierarchy::ElementId receiver) const;
  /// Side of the area that matters around an element, squared: A_0.
  double referenceArea(hierarchy::ElementId) const;
  /// Whether an element is large enough to be split: finer detail does not matter to the light around it.
  bool divisible(hierarchy::ElementId) const;

 private:
  double tolerance(hierarchy::ElementId receiver) const;

  const hierarchy::Elements& elements_;
  OracleSettings settings_;
  double floor_ = 0;
};

}  // namespace deltalux::paper
