#pragma once
// MTL files. tinyobjloader reads any word as a number (0 if need be), `Ke 10` as red alone and `d -halo 0.3` as clear;
// here a colour of one number is grey, words, nan and numbers too large are errors with their line, and what is not
// read or out of range is counted. Keywords count in any case. [MTL]
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/obj/tinyobj.hpp"

namespace deltalux::io {

/// The materials in order. Kd, Ks, Tf, d and 1 - Tr lie in [0, 1]; where both d and Tr stand, d counts. Ke is not
/// negative and at most 1e15. Throws InputError in the name of `file`.
std::vector<tinyobj::material_t> readMtl(std::string_view text, const std::string& file,
                                         std::map<std::string, std::size_t>& ignored);

}  // namespace deltalux::io
