#pragma once
#include "solution/solution.hpp"

namespace deltalux::io {

/// Whether shapes have the tables that belong to them. Throws std::logic_error.
void checkTables(const Scene&);

/// Checks what memory safety and termination ask of a solution that was read from a file: every index points at
/// something that is there, tables have the lengths that belong together, both trees are trees, flags and enumerators
/// are such. Its numbers are as they were saved; they are not judged again. Shapes have their tables, and the orders of
/// faces are there. Throws std::logic_error.
void checkReferences(const Solution&);

}  // namespace deltalux::io
