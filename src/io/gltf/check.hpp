#pragma once
// The form of a glTF document, before anything reads it: types of values, sizes of vectors, indices in range, required
// extensions that are understood. [glTF 2.0, 5]
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deltalux::io {

/// Throws InputError with the place in the document (a JSON pointer) of the first thing that is wrong.
void checkGltf(const nlohmann::json& document, const std::string& name);

}  // namespace deltalux::io
