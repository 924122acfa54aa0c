#pragma once
#include <deltalux/light.hpp>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

using SkyFunction = std::variant<RadianceSky, PerezSky>;

/// Turns `brightfunc` with skybr of skybright.cal into Type::SkyBrightness, whose ten reals are kind, zenith, ground,
/// normalisation, the sun's direction and the zenith's; and with skybright of perezlum.cal into Type::PerezBrightness,
/// whose thirteen are diffuse normalisation, ground, five coefficients, the sun's direction and the zenith's. Others
/// stay as they are. Throws InputError on wrong arguments.
void recogniseSky(RadObject& brightfunc);

/// The reals of a SkyBrightness and of a PerezBrightness.
std::vector<double> skyArguments(const RadianceSky&, const Vec3& up);
std::vector<double> skyArguments(const PerezSky&, const Vec3& up);
SkyFunction skyOf(const RadObject&);
Vec3 zenithOf(const RadObject&);

}  // namespace deltalux::io::radiance
