#pragma once
// The paper's reconstruction [GD01 3.3]: every texel spirals outward over r <= R and gathers p(i,j) / N, N the texels
// covered so far, until what it has gathered reaches the histogram's maximum: bright texels keep to themselves, dark
// ones are averaged widely.                                                                         (8)
//
// As it stands that makes and loses flux, and darkens borders. Here the stopping rule gives every texel its radius, and
// two texels exchange light over areas that both kernels cover, by the same share both ways: flux is kept, a uniform
// light stays as it is, at borders too. The spiral runs on over the seam of a closed chart and over its poles.
// Cost: O(texels R^2).
#include "caustics/cell_light.hpp"

namespace deltalux::paper {

/// E of every cell [W/m2]. `radius`: R in texels.
std::vector<Rgb> reconstructSpiral(const caustics::CellGrid&, const caustics::CellLight&, int radius);

}  // namespace deltalux::paper
