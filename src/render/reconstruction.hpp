#pragma once
// A solution made ready for looking at: where a ray meets a surface side, the irradiance there. Built once a picture or
// a set of probes, then read by all threads.
#include "hierarchy/side_locator.hpp"
#include "render/irradiance_field.hpp"
#include "render/point_sources.hpp"

namespace deltalux {

struct Solution;

}  // namespace deltalux

namespace deltalux::rendering {

struct Reconstruction {
  /// The solution must outlive this. `before`: of the same solution, as it was; what has not changed is taken over,
  /// and what differs by less than `tolerance`, a fraction.
  explicit Reconstruction(const Solution&, const Reconstruction* before = nullptr, float tolerance = 0.0f);

  hierarchy::SideLocator locator;
  IrradianceField field;
  PointSources sources;

  const scene::LightSampler& lights() const { return sources.light().lamps().sampler(); }
};

}  // namespace deltalux::rendering
