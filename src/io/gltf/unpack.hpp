#pragma once
// Buffer views that are there compressed alone. [EXT_meshopt_compression]
#include <nlohmann/json.hpp>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// Whether the buffer only reserves room for what is to be unpacked.
bool isFallback(const nlohmann::json& buffer);
/// Unpacks the views into buffers of their own, which are appended, and lets the views name those. The document has
/// been checked (check.hpp). Throws InputError.
void unpackViews(nlohmann::json& tree, GltfDocument&);

}  // namespace deltalux::io
