#pragma once
// What of a link that is judged anew is news to the rows that sample it, or do not yet.
#include "hierarchy/link.hpp"

namespace deltalux::paper {

/// Budgets: what a link may bring for which rows that sample it too little are dealt anew.
inline constexpr double kNews = 0.1;
/// The same where rows do not sample it at all.
inline constexpr double kNewsToRows = 2e-4;

/// Whether a second look has found what the first did, kernels that differ by no more than `sameKernel`, relatively.
/// Light changes all the while; a move is no reason to refine for it.
bool sameTransfer(const hierarchy::Link& before, const hierarchy::Link& after, float sameKernel);

/// Whether a link that was proven blocked, and that rows have no rays over, still shows nothing. Where something moves
/// the proof fails long before light passes: of 125,000 rays over such links, in a cabin and a house, none did.
bool hiddenAsBefore(const hierarchy::Link& before, const hierarchy::Link& after);

/// Whether rows that sample `before` may stand, but for terms that meet what moved or lead to it: those are taken anew
/// one by one, and what now is less or more likely to be seen than their number says costs noise only, next to none
/// where the link brings little (kNews).
bool samePlan(const hierarchy::Link& before, const hierarchy::Link& after);

}  // namespace deltalux::paper
