#pragma once
// pbrt's transforms.
#include <deltalux/math.hpp>

#include "io/pbrt/tokens.hpp"

namespace deltalux::io::pbrt {

/// The matrix of Translate, Scale, Rotate, LookAt, or of Transform and ConcatTransform; nullopt for any other word.
/// Throws InputError.
std::optional<Mat4> takeTransform(std::string_view word, Tokens&);

/// Throws InputError when a product of transforms has grown beyond all bounds.
void requireFinite(const Mat4&, const Place&);

}  // namespace deltalux::io::pbrt
