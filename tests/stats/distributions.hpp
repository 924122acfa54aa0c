#pragma once
// Tails of the two distributions that statistical tests ask for.

namespace deltalux::test {

/// P(chi^2 > x) with `degrees` degrees of freedom.
double chiSquareTail(double x, double degrees);
/// P(|T| > |t|) of Student's t with `degrees` degrees of freedom.
double studentTwoSidedTail(double t, double degrees);

}  // namespace deltalux::test
