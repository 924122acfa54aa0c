#pragma once
// Several distributions that shine from one place.
#include <deltalux/light.hpp>

namespace deltalux::io {

/// The sum of two distributions, exactly as candela() interpolates either: it has the angles of both, between which
/// both are bilinear. The opening is the first one's.
Photometry superpose(const Photometry&, const Photometry&);

}  // namespace deltalux::io
