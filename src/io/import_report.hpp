#pragma once
#include <deltalux/io.hpp>

namespace deltalux::io {

/// Appends the one warning that sums up what `report.ignored` counts, if anything.
void warnOfIgnored(ImportReport& report);

}  // namespace deltalux::io
