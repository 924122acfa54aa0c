#pragma once
// Typed arrays in the buffers of a glTF file. [glTF 2.0, 3.6.2]
#include <cstdint>
#include <vector>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// Element by element, the `components` numbers of a vector accessor; normalized integers as fractions, sparse values
/// put in. Throws InputError when the type differs, bytes are missing or a number is not finite.
std::vector<double> readVectors(const GltfDocument&, int accessor, int components);

/// The unsigned numbers of a scalar accessor. Throws InputError likewise.
std::vector<std::uint32_t> readIndices(const GltfDocument&, int accessor);

}  // namespace deltalux::io
