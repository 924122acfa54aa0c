#include "render/reconstruction.hpp"

#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {
constexpr float kNoise = 2.0f;  // of leaves, times the error that was asked for
}  // namespace

Reconstruction::Reconstruction(const Solution& s, const Reconstruction* before)
    : locator(s.elements, s.scene),
      field(s.elements, s.scene, *s.tracer, meshIrradiance(s.elements, s.caustics, s.deviation),
            kNoise * static_cast<float>(s.settings.error), before ? &before->field : nullptr),
      sources(s) {}

}  // namespace deltalux::rendering
