#pragma once
#include <cstddef>

namespace deltalux {

/// Boxes that stand for many, or things that are kept apart, where each look takes longer by each of them. Nothing comes
/// out otherwise for another number: what more of them would tell apart is looked at again.
inline constexpr std::size_t kFewBoxes = 8;  // [task]

}  // namespace deltalux
