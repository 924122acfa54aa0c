#pragma once

namespace deltalux {

/// For programs that update, called first in main(): memory that was freed stays with the process instead of going back
/// to the system, page by page, to be asked for again by the next update (a tenth of its time). Costs 64 MiB of address
/// space, and what solving needed stays resident, until updates have added an eighth to it. Does nothing where the C
/// library has no such setting.
void keepFreedMemory();

}  // namespace deltalux
