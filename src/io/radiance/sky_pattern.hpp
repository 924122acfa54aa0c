#pragma once
#include <deltalux/light.hpp>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// Turns `brightfunc` with skybr of skybright.cal into Type::SkyBrightness, whose ten reals are kind, zenith, ground,
/// normalisation, the sun's direction and the zenith's. Others stay as they are. Throws InputError on wrong arguments.
void recogniseSky(RadObject& brightfunc);

/// The ten reals of a SkyBrightness.
std::vector<double> skyArguments(const RadianceSky&, const Vec3& up);
RadianceSky skyOf(const RadObject& skyBrightness);
Vec3 zenithOf(const RadObject& skyBrightness);

}  // namespace deltalux::io::radiance
