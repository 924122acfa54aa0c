#include "direct/point_light.hpp"

#include <algorithm>

#include "base/morton.hpp"
#include "direct/tuning.hpp"
#include "hierarchy/tuning.hpp"
#include "scene/nominal_scale.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::direct {

namespace {

/// Like a sun of its size.
Lamp narrow(LightId id, const DomeLight& dome, const Rgb& scale) {
  Lamp lamp;
  lamp.id = id, lamp.sun = true, lamp.axis = dome.axis, lamp.halfAngle = dome.halfAngle;
  const Frame frame(dome.axis);
  const double least = std::cos(dome.halfAngle), angle = 2 * kPi * (1 - least);
  constexpr int looks = hierarchy::tuning::kGrid;
  for (int k = 0; k < looks * looks; ++k) {
    const double z = least + (1 - least) * (k % looks + 0.5) / looks, phi = 2 * kPi * (k / looks + 0.5) / looks;
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3 w = frame.toWorld({r * std::cos(phi), r * std::sin(phi), z});
    lamp.most += angle / (looks * looks) * gray(scale * skyRadiance(dome, w));
  }
  return lamp;
}

}  // namespace

hierarchy::ElementGeometry pointPatch(const Receiver& x) {
  hierarchy::ElementGeometry g;
  g.center = g.lower = g.upper = Vec3f(x.position);
  g.normal = Vec3f(x.normal), g.normalCone = 1;
  return g;
}

PointSampler::PointSampler(const Scene& scene, const tracing::RayTracer& tracer)
    : tracer_(tracer), lamps_(scene, scene::scalesOf(scene)) {
  whole_.assign(lamps_.all().begin(), lamps_.all().end());
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const auto* dome = std::get_if<DomeLight>(&light.emitter);
    if (!dome || isBlack(light.scale)) continue;
    if (2 * dome->halfAngle < tuning::kNarrow) {
      whole_.push_back(narrow(LightId(i), *dome, light.scale));
      continue;
    }
    Sky sky{LightId(i), *dome, light.scale};
    for (int cell = 0; cell < SkyCells::kCount; ++cell)
      sky.strength[static_cast<std::size_t>(cell)] = SkyCells::meanOver(
          cell, [&](const Vec3f& direction) { return gray(sky.scale * skyRadiance(*dome, Vec3(direction))); });
    skies_.push_back(std::move(sky));
  }
  for (int cell = 0; cell < SkyCells::kCount; ++cell) {
    const auto c = static_cast<std::size_t>(cell);
    curve_[c] = cell;
    looks_[c][4] = SkyCells::direction(cell, 0.5, 0.5);
    for (int corner = 0; corner < 4; ++corner)
      looks_[c][static_cast<std::size_t>(corner)] = SkyCells::direction(cell, corner & 1, corner >> 1);
  }
  const auto place = [](int cell) {
    return morton(static_cast<std::uint32_t>(cell % kSkySide), static_cast<std::uint32_t>(cell / kSkySide));
  };
  std::sort(curve_.begin(), curve_.end(), [&](int a, int b) { return place(a) < place(b); });
}

std::vector<Source> PointSampler::lampsOver(const hierarchy::ElementGeometry& patch) const {
  std::vector<Source> out;
  const auto add = [&](std::uint32_t i, double bright) {
    if (bright > 0) out.push_back({i, static_cast<float>(bright), 0.5f});  // as likely seen as not
  };
  for (const std::uint32_t i : lamps_.suns()) add(i, potential(whole_[i], patch));
  for (std::size_t i = lamps_.all().size(); i < whole_.size(); ++i)
    add(static_cast<std::uint32_t>(i), potential(whole_[i], patch));
  lamps_.tree().reaching(patch, add);
  std::sort(out.begin(), out.end(), [](const Source& a, const Source& b) { return a.id < b.id; });
  return out;
}

void PointSampler::addSkies(const hierarchy::ElementGeometry& patch, std::vector<Source>& out) const {
  if (skies_.empty()) return;
  const bool flat = patch.normalCone > 0.999f;
  std::array<float, SkyCells::kCount> cosine;
  cosine.fill(flat ? 0.0f : 1.0f);
  for (std::size_t cell = 0; flat && cell < SkyCells::kCount; ++cell)
    for (const Vec3f& w : looks_[cell]) cosine[cell] = std::max(cosine[cell], glm::dot(patch.normal, w));
  for (std::size_t s = 0; s < skies_.size(); ++s)
    for (std::size_t k = 0; k < SkyCells::kCount; ++k) {
      const auto cell = static_cast<std::size_t>(curve_[k]);
      const float potential = skies_[s].strength[cell] * cosine[cell] * static_cast<float>(SkyCells::solidAngle());
      if (potential > 0)
        out.push_back({static_cast<std::uint32_t>(whole_.size() + s * SkyCells::kCount + k), potential, 1.0f});
    }
}

std::vector<Source> PointSampler::sources(const Receiver& x) const {
  return sources(pointPatch(x), [](int) { return 1.0f; });
}

std::optional<Arrival> PointSampler::arrival(std::uint32_t source, const Receiver& x, const Vec2& u) const {
  if (source < whole_.size()) {
    const LightId id = whole_[source].id;
    const auto s = lamps_.sampler().sample(id, x.position, u);
    if (!s || !(glm::dot(s->direction, x.normal) > 0)) return std::nullopt;
    const Rgb V = tracer_.transmittance(tracing::shadowRay(x.position, x.normal, s->direction, s->distance, s->normal));
    if (isBlack(V)) return std::nullopt;
    return Arrival{s->direction, id, V * s->radiance * static_cast<float>(1 / (s->pdf > 0 ? s->pdf : 1.0))};
  }
  const Sky& sky = skies_[(source - whole_.size()) / SkyCells::kCount];
  const Vec3 w(SkyCells::direction(cellOf(source), u.x, u.y));
  if (!(glm::dot(w, x.normal) > 0)) return std::nullopt;
  const Rgb L = sky.scale * skyRadiance(sky.light, w);
  if (isBlack(L)) return std::nullopt;
  const Rgb V = tracer_.transmittance(tracing::shadowRay(x.position, x.normal, w, kInfinity, Vec3(0)));
  if (isBlack(V)) return std::nullopt;
  return Arrival{w, sky.id, V * L * static_cast<float>(SkyCells::solidAngle())};
}

}  // namespace deltalux::direct
