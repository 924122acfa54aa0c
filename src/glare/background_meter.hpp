#pragma once
// A light meter at the eye that sees no luminaire and no sun, neither straight nor by way of mirrors: only what
// surfaces reflect diffusely, and skies. Cost: that of a meter in free space (render/space_meter.hpp).
#include <deltalux/glare.hpp>

#include "render/space_meter.hpp"

namespace deltalux::glare {

class BackgroundMeter {
 public:
  /// Both must outlive this.
  BackgroundMeter(const Solution&, const rendering::Reconstruction&);

  /// Illuminance on the eye [lux], to the settings' error.
  double lux(const Eye&, const GlareSettings&, std::uint64_t key) const;

 private:
  const Scene& scene_;
  rendering::EyePaths paths_;
  rendering::SpaceMeter meter_;
};

}  // namespace deltalux::glare
