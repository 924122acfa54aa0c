#pragma once
#include <deltalux/shape.hpp>

namespace deltalux::io {

/// The same surface with front and back changed.
Shape turnedOver(const Shape&);

}  // namespace deltalux::io
