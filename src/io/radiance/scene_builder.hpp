#pragma once
#include <deltalux/io.hpp>
#include <vector>

#include "io/radiance/expander.hpp"

namespace deltalux::io::radiance {

/// The scene of a flat list of objects, in which modifiers stand before their use; the files of their patterns are
/// opened by `files`. Throws InputError.
ImportedScene buildScene(const std::vector<RadObject>& objects, FileAccess& files, const ImportSettings&,
                         const ExpansionLimits&);

}  // namespace deltalux::io::radiance
