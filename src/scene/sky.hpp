#pragma once
// Sky radiance distributions, each relative to its own zenith direction.
//
// radiance(RadianceSky): the functions that gensky's output names, skybr of skybright.cal [Radiance, gensky(1)]: CIE
// clear sky (Kittler 1967, CIE 22), CIE overcast sky (Moon & Spencer 1942), uniform sky, and Matsuura's intermediate
// sky; ground and sky are blended across the horizon with the weights (1.01 +- cos)^10. radiance(CieSky): the standard
// general sky [ISO 15469:2004, Darula & Kittler 2002]; below the horizon the ground. radiance(PerezSky): the
// all-weather sky [Perez, Seals & Michalsky 1993], with perezlum.cal's horizon: nothing below zenith cosine 0.01 is
// brighter than there. Cost: a handful of transcendental functions, no state.
#include <deltalux/light.hpp>

namespace deltalux::scene {

/// Radiance from the unit direction `towards`; `up` is the zenith [W/(sr m2)].
double radiance(const RadianceSky&, const Vec3& towards, const Vec3& up);
double radiance(const CieSky&, const Vec3& towards, const Vec3& up);
double radiance(const PerezSky&, const Vec3& towards, const Vec3& up);

}  // namespace deltalux::scene
