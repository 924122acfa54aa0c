#pragma once
#include <deltalux/report.hpp>

namespace deltalux::test {

/// What a ledger does not account for, of what is emitted.
inline double residue(const EnergyLedger& l) {
  return (*l.emittedW - *l.absorbedW - *l.escapedW - *l.unsettledW) / *l.emittedW;
}

}  // namespace deltalux::test
