#pragma once
#include <deltalux/io.hpp>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// The scene of a flat list of objects, in which modifiers stand before their use. Throws InputError.
ImportedScene buildScene(const std::vector<RadObject>& objects, const ImportSettings&);

}  // namespace deltalux::io::radiance
