#pragma once
// The time and place that gensky and gendaylit are given. [Radiance, gensky(1), gendaylit(1)]
#include <string>

#include "io/radiance/object_maker.hpp"
#include "io/radiance/sun_position.hpp"

namespace deltalux::io::radiance {

struct SkyTime {
  SunTime time;
  Site site;
  std::optional<SunAngles> angles;  // given in place of a date
  bool zoneGiven = false;           // and with it the meridian
};

/// Reads `month day hour` or `-ang altitude azimuth`.
SkyTime readSkyTime(ObjectMaker&);
/// The next option, with its sign.
std::string readOption(ObjectMaker&);
/// Takes -a latitude, -o longitude, -m meridian and -y year; false for others.
bool readSiteOption(ObjectMaker&, const std::string& option, SkyTime&);
SunAngles sunAngles(const SkyTime&);

}  // namespace deltalux::io::radiance
