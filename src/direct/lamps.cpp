#include "direct/lamps.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "direct/tuning.hpp"

namespace deltalux::direct {

namespace {

/// Greatest intensity of a lamp over directions on a grid about its axis, and the half angle within which it is above
/// half of that.
struct Beam {
  double most = 0, halfWidth = kPi;
};

Beam beamOf(const scene::LightSampler& sampler, LightId id, const Vec3& axis, const auto& intensity) {
  constexpr int kRings = deltalux::tuning::kPolarAngles, kAround = deltalux::tuning::kPilots;
  const Frame frame(axis);
  std::array<double, kRings + 1> brightest{};
  Beam beam;
  for (int r = 0; r <= kRings; ++r) {
    const double theta = kPi * std::pow(double(r) / kRings, 2);  // finer near the axis
    for (int a = 0; a < (r == 0 ? 1 : kAround); ++a) {
      const double phi = 2 * kPi * a / kAround;
      const Vec3 w = frame.toWorld({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      brightest[static_cast<std::size_t>(r)] =
          std::max<double>(brightest[static_cast<std::size_t>(r)], gray(intensity(sampler, id, w)));
    }
    beam.most = std::max(beam.most, brightest[static_cast<std::size_t>(r)]);
  }
  int last = 0;
  for (int r = 0; r <= kRings; ++r)
    if (brightest[static_cast<std::size_t>(r)] > 0.5 * beam.most) last = r;
  beam.halfWidth = kPi * std::pow(double(last + 1) / kRings, 2);
  return beam;
}

Vec3 axisOf(const Light& light) {
  if (const auto* spot = std::get_if<SpotLight>(&light.emitter)) return spot->direction;
  if (const auto* lambert = std::get_if<LambertPointLight>(&light.emitter)) return lambert->direction;
  if (const auto* photometric = std::get_if<PhotometricLight>(&light.emitter)) return -photometric->frame[2];
  return {0, 0, 1};
}

}  // namespace

Lamps::Lamps(const Scene& scene, const std::vector<Rgb>& scales) : sampler_(scene, scales) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (isBlack(scales[i]) || std::holds_alternative<DomeLight>(light.emitter)) continue;
    Lamp lamp;
    lamp.id = LightId(i);
    if (const auto* sun = std::get_if<SunLight>(&light.emitter)) {
      lamp.sun = true, lamp.axis = sun->direction, lamp.halfAngle = sun->angularRadius;
      lamp.most = gray(scales[i] * sun->radiance) * solidAngle(*sun);
    } else if (const auto* area = std::get_if<AreaLight>(&light.emitter)) {
      const Material& material = scene.materialOf(area->primitive);
      const Shape& shape = scene[area->primitive].shape;
      const Box box = bounds(shape);
      if (!material.emission || !sendsLight(material) || box.empty()) continue;
      lamp.lower = Vec3f(box.lower), lamp.upper = Vec3f(box.upper);
      const double size = sampler_.area(lamp.id);
      const bool plane = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Ring>(shape);
      if (plane && !material.emission->bothSides) lamp.flat = true, lamp.axis = samplePoint(shape, {0.5, 0.5}).normal;
      lamp.most = gray(scales[i] * material.emission->radiance) * size;
      if (const auto& spot = material.emission->spot) {
        lamp.axis = glm::normalize(spot->direction), lamp.halfAngle = 0.5 * spot->fullAngle;
        lamp.beam = lamp.halfAngle;
      } else if (material.emission->pattern) {
        const Beam beam = beamOf(sampler_, lamp.id, lamp.flat ? lamp.axis : Vec3(0, 0, -1),
                                 [&](const scene::LightSampler& s, LightId id, const Vec3& w) {
                                   return Rgb(static_cast<float>(size)) * s.emittedRadiance(id, w, 1e30, true);
                                 });
        lamp.most = beam.most;
      }
    } else {
      lamp.lower = lamp.upper = Vec3f(sampler_.position(lamp.id));
      lamp.axis = axisOf(light);
      const Beam beam =
          beamOf(sampler_, lamp.id, lamp.axis,
                 [](const scene::LightSampler& s, LightId id, const Vec3& w) { return s.intensity(id, w); });
      lamp.most = beam.most;
      if (const auto* spot = std::get_if<SpotLight>(&light.emitter)) lamp.halfAngle = std::acos(spot->cosOuter);
      if (std::holds_alternative<LambertPointLight>(light.emitter)) lamp.halfAngle = 0.5 * kPi;
      // A measured beam has no edge: it is looked for within half of its peak, and shines beyond.
      lamp.beam = std::min(beam.halfWidth, lamp.halfAngle);
    }
    lamp.cone = emissionCone(lamp);
    all_.push_back(lamp);
  }
  const auto those = [&](const auto& wanted) {
    std::vector<std::uint32_t> which;
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (wanted(all_[i])) which.push_back(static_cast<std::uint32_t>(i));
    return which;
  };
  suns_ = those([](const Lamp& l) { return l.sun; });
  tree_ = LampTree(all_, those([](const Lamp& l) { return !l.sun; }));
  narrow_ = LampTree(all_, those([](const Lamp& l) { return isNarrow(l); }));
}

bool Lamps::tooWideForBeam(const hierarchy::ElementGeometry& g) const {
  bool wide = false;
  narrow_.reaching(g,
                   [&](std::uint32_t i, double) { wide = wide || g.radius > tuning::kBeam * beamWidth(all_[i], g); });
  return wide;
}

}  // namespace deltalux::direct
