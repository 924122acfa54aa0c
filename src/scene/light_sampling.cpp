#include "scene/light_sampling.hpp"

#include <algorithm>
#include <mutex>

#include "base/check.hpp"
#include "base/unit_circle.hpp"
#include "scene/form_factor.hpp"
#include "scene/light_sampling_triangle.hpp"
#include "scene/tuning.hpp"

namespace deltalux::scene {

namespace {

constexpr double kMinSolidAngle = 1e-3;  // below, area sampling is as good and keeps more digits [rounding]

/// A direction within 1 - cos <= `depth` of `axis`, uniform in solid angle.
Vec3 sampleCap(const Vec3& axis, double depth, const Vec2& u) {
  const double down = u.x * depth, radius = std::sqrt(std::max(0.0, down * (2.0 - down)));
  return Frame(axis).toWorld(Vec3(radius * onUnitCircle(u.y), 1.0 - down));
}

double sunDepth(const SunLight& sun) { return solidAngle(sun) / (2.0 * kPi); }

/// 1 - cos of the cone that a sphere fills from outside.
double coneDepth(double radius, double distance) {
  const double sin2 = radius * radius / (distance * distance);
  return sin2 / (1.0 + std::sqrt(1.0 - sin2));
}

template <class Emitter>
constexpr bool kPointLike = requires(const Emitter& e, Vec3 w) {
  e.position;
  radiantIntensity(e, w);
};

const Emission* emissionOf(const Scene& scene, PrimitiveId p) {
  const auto& emission = scene.materialOf(p).emission;
  return emission ? &*emission : nullptr;
}

}  // namespace

Rgb emittedRadiance(const Emission& emission, const Vec3& direction, double distance, bool front) {
  if (!front && !emission.bothSides) return Rgb(0.0f);
  return emission.radiance * static_cast<float>(relativeRadiance(emission, direction, distance));
}

Rgb seenRadiance(const Material& material, const Vec3& direction, double distance, bool front) {
  if (!material.emission || !material.emission->seenOnly) return Rgb(0.0f);
  return emittedRadiance(*material.emission, direction, distance, front);
}

/// Made when first asked for: many who sample area lights never ask.
class LightSampler::LazyDome {
 public:
  explicit LazyDome(const DomeLight& dome) : dome_(dome) {}

  const DomeTable& table() {
    std::call_once(made_, [&] { table_.emplace(dome_); });
    return *table_;
  }

 private:
  const DomeLight& dome_;
  std::once_flag made_;
  std::optional<DomeTable> table_;
};

LightSampler::~LightSampler() = default;

LightSampler::LightSampler(const Scene& scene, std::vector<Rgb> scales)
    : scene_(scene), scales_(std::move(scales)), lightOf_(scene.primitives.size()) {
  DELTALUX_CHECK(scales_.empty() || scales_.size() == scene.lights.size(), "a scale for every light");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    Prepared prepared;
    const auto& emitter = scene.lights[i].emitter;
    if (const auto* area = std::get_if<AreaLight>(&emitter)) {
      if (emissionOf(scene, area->primitive)) {
        prepared.area = prepareArea(area->primitive);
        lightOf_[area->primitive.index()] = LightId(i);
      }
    } else if (const auto* dome = std::get_if<DomeLight>(&emitter)) {
      prepared.dome = std::make_unique<LazyDome>(*dome);
      atInfinity_.push_back(LightId(i));
    } else if (std::holds_alternative<SunLight>(emitter)) {
      atInfinity_.push_back(LightId(i));
    }
    prepared_.push_back(std::move(prepared));
  }
}

LightSampler::AreaData LightSampler::prepareArea(PrimitiveId p) const {
  AreaData data{p, {}, {}, 0};
  if (const auto& spot = scene_.materialOf(p).emission->spot) {
    const Box box = bounds(scene_[p].shape);
    const double half = 0.5 * spot->fullAngle, focal = glm::length(spot->direction);
    if (!box.empty() && focal > 0 && half < kPi)
      data.beam = {box.center(), spot->direction / focal, 0.5 * box.diagonal(), std::cos(half), std::sin(half)};
  }
  const Shape& shape = scene_[p].shape;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    for (const auto& t : polygon->triangles) {
      data.triangles.push_back({polygon->vertices[t[0]], polygon->vertices[t[1]], polygon->vertices[t[2]]});
    }
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    for (const auto& t : mesh->triangles) {
      data.triangles.push_back({mesh->positions[t[0]], mesh->positions[t[1]], mesh->positions[t[2]]});
    }
  } else {
    data.area = deltalux::area(shape);
  }
  for (const Triangle& t : data.triangles) {
    data.cumulative.push_back(data.area += 0.5 * glm::length(glm::cross(t.b - t.a, t.c - t.a)));
  }
  return data;
}

bool LightSampler::AreaData::shinesPast(const Vec3& p) const {
  if (!beam) return false;
  const Vec3 to = p - beam->center;
  const double along = glm::dot(to, beam->axis), squared = glm::dot(to, to);
  const double across = std::sqrt(std::max(0.0, squared - along * along));
  return across * beam->cosine - along * beam->sine > 1.0001 * beam->radius + 1e-7 * std::sqrt(squared);
}

bool LightSampler::isPointLike(LightId id) const {
  return std::visit([](const auto& e) { return kPointLike<decltype(e)>; }, scene_[id].emitter);
}

Vec3 LightSampler::position(LightId id) const {
  return std::visit(
      [](const auto& e) {
        if constexpr (kPointLike<decltype(e)>) return e.position;
        return Vec3(0);
      },
      scene_[id].emitter);
}

Rgb LightSampler::intensity(LightId id, const Vec3& direction) const {
  const Light& light = scene_[id];
  return scaleOf(id) * std::visit(
                           [&](const auto& e) {
                             if constexpr (kPointLike<decltype(e)>) return radiantIntensity(e, direction);
                             return Rgb(0.0f);
                           },
                           light.emitter);
}

std::optional<LightSample> LightSampler::samplePointLike(LightId id, const Vec3& from) const {
  const Vec3 d = position(id) - from;
  const double squared = glm::dot(d, d);
  if (!(squared > 0.0)) return std::nullopt;
  const double distance = std::sqrt(squared);
  const Vec3 direction = d / distance;
  const Rgb I = intensity(id, -direction);
  if (isBlack(I)) return std::nullopt;
  return LightSample{direction, distance, Vec3(0), I * static_cast<float>(1.0 / squared), 0.0};
}

std::optional<LightSample> LightSampler::sample(LightId id, const Vec3& from, const Vec2& u) const {
  const Prepared& prepared = prepared_[id.index()];
  if (prepared.area) return sampleArea(id, *prepared.area, from, u);
  if (prepared.dome) {
    const DomeTable::Sample s = prepared.dome->table().sample(u);
    return LightSample{s.direction, kInfinity, Vec3(0), radianceFrom(id, s.direction), s.pdf};
  }
  const Light& light = scene_[id];
  if (const auto* sun = std::get_if<SunLight>(&light.emitter)) {
    const Vec3 direction = sampleCap(sun->direction, sunDepth(*sun), u);
    return LightSample{direction, kInfinity, Vec3(0), sun->radiance * scaleOf(id), 1.0 / solidAngle(*sun)};
  }
  return isPointLike(id) ? samplePointLike(id, from) : std::nullopt;
}

bool LightSampler::bySolidAngle(const AreaData& data, const Vec3& from, double& omega) const {
  if (data.triangles.empty() || data.triangles.size() > tuning::kMostBySolidAngle ||
      !std::holds_alternative<Polygon>(scene_[data.primitive].shape)) {
    return false;
  }
  // Cheap upper bound first: a far polygon needs no exact solid angle.
  const Triangle& first = data.triangles.front();
  const Vec3 normal = std::get<Polygon>(scene_[data.primitive].shape).normal;
  const double height = std::abs(glm::dot(from - first.a, normal));
  if (height < 1e-9 * std::sqrt(data.area)) return false;
  const Vec3 toFirst = first.a - from;
  if (data.area * height < kMinSolidAngle * 0.1 * std::pow(glm::dot(toFirst, toFirst), 1.5)) return false;
  omega = 0;
  for (const Triangle& t : data.triangles) {
    omega += sphericalTriangleArea(glm::normalize(t.a - from), glm::normalize(t.b - from), glm::normalize(t.c - from));
  }
  return omega > kMinSolidAngle;
}

std::optional<LightSample> LightSampler::finishArea(LightId id, const AreaData& data, const Vec3& from,
                                                    const Vec3& point, const Vec3& normal, double omega) const {
  const Vec3 d = point - from;
  const double squared = glm::dot(d, d);
  if (!(squared > 0.0)) return std::nullopt;
  const double distance = std::sqrt(squared);
  const Vec3 direction = d / distance;
  const double cosine = -glm::dot(direction, normal);
  const bool front = cosine > 0.0;
  if (cosine == 0.0) return std::nullopt;
  const Rgb L = emittedRadiance(id, -direction, distance, front);
  if (isBlack(L)) return std::nullopt;
  // Made where it is returned: it is asked for many times, and takes longer to copy than to fill in.
  std::optional<LightSample> sample(std::in_place);
  sample->direction = direction, sample->distance = distance, sample->normal = front ? normal : -normal;
  sample->radiance = L;
  sample->pdf = omega > 0.0 ? 1.0 / omega : squared / (data.area * std::abs(cosine));
  return sample;
}

std::optional<LightSample> LightSampler::sampleArea(LightId id, const AreaData& data, const Vec3& from,
                                                    const Vec2& u) const {
  if (data.shinesPast(from)) return std::nullopt;
  const Shape& shape = scene_[data.primitive].shape;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    const Vec3 toCenter = sphere->center - from;
    const double d = glm::length(toCenter);
    const bool outside = d > sphere->radius * (1.0 + 1e-9);
    const double depth = outside ? coneDepth(sphere->radius, d) : 2.0;
    const Vec3 direction = sampleCap(d > 0.0 ? toCenter / d : Vec3(0, 0, 1), depth, u);
    const double along = glm::dot(toCenter, direction);
    const double half = std::sqrt(std::max(0.0, sphere->radius * sphere->radius - (d * d - along * along)));
    const Vec3 point = from + (outside ? along - half : along + half) * direction;
    const Vec3 outward = glm::normalize(point - sphere->center);
    return finishArea(id, data, from, point, sphere->inward ? -outward : outward, 2.0 * kPi * depth);
  }
  double omega = 0;
  if (bySolidAngle(data, from, omega)) {
    const Vec3 normal = std::get<Polygon>(shape).normal;
    double rest = u.x * omega;
    for (std::size_t i = 0; i < data.triangles.size(); ++i) {
      const Triangle& t = data.triangles[i];
      const Vec3 a = glm::normalize(t.a - from), b = glm::normalize(t.b - from), c = glm::normalize(t.c - from);
      const double part = sphericalTriangleArea(a, b, c);
      if (rest >= part && i + 1 < data.triangles.size()) {
        rest -= part;
        continue;
      }
      const Vec3 direction = sampleSphericalTriangle(a, b, c, {std::min(rest / part, 1.0), u.y});
      const double along = glm::dot(direction, normal);
      if (along == 0.0) return std::nullopt;
      return finishArea(id, data, from, from + glm::dot(t.a - from, normal) / along * direction, normal, omega);
    }
  }
  const SurfacePoint point = samplePoint(id, u);
  return finishArea(id, data, from, point.position, point.normal, 0.0);
}

std::optional<Rgb> LightSampler::irradiance(LightId id, const Vec3& at, const Vec3& normal) const {
  const Prepared& prepared = prepared_[id.index()];
  if (!prepared.area) return {};
  const AreaData& data = *prepared.area;
  const Emission& emission = *emissionOf(scene_, data.primitive);
  if (emission.spot || emission.pattern) return {};
  const Rgb exitance = scaleOf(id) * emission.radiance * static_cast<float>(kPi);
  const Shape& shape = scene_[data.primitive].shape;
  if (const auto* sphere = std::get_if<Sphere>(&shape); sphere && (!sphere->inward || emission.bothSides)) {
    const Vec3 to = sphere->center - at;
    const double squared = glm::dot(to, to), radius = sphere->radius, height = glm::dot(to, normal);
    if (squared > radius * radius && height >= radius)
      return exitance * static_cast<float>(radius * radius * height / (squared * std::sqrt(squared)));
    return {};
  }
  const auto* polygon = std::get_if<Polygon>(&shape);
  if (!polygon || data.triangles.size() > tuning::kMostBySolidAngle) return {};
  if (!emission.bothSides && !(glm::dot(at - data.triangles.front().a, polygon->normal) > 0)) return Rgb(0.0f);
  double F = 0;
  for (const Triangle& t : data.triangles)
    F += formFactorToPolygon(Vec3f(at), Vec3f(normal), std::array<Vec3f, 3>{Vec3f(t.a), Vec3f(t.b), Vec3f(t.c)});
  return exitance * static_cast<float>(F);
}

double LightSampler::area(LightId id) const {
  const auto& data = prepared_[id.index()].area;
  return data ? data->area : 0.0;
}

SurfacePoint LightSampler::samplePoint(LightId id, const Vec2& u) const {
  const AreaData& data = *prepared_[id.index()].area;
  if (data.triangles.empty()) return deltalux::samplePoint(scene_[data.primitive].shape, u);
  const double target = u.x * data.area;
  const auto it = std::upper_bound(data.cumulative.begin(), data.cumulative.end() - 1, target);
  const std::size_t i = static_cast<std::size_t>(it - data.cumulative.begin());
  const double below = i > 0 ? data.cumulative[i - 1] : 0.0;
  const double root = std::sqrt(std::clamp((target - below) / (*it - below), 0.0, 1.0));
  const Triangle& t = data.triangles[i];
  SurfacePoint point;
  point.position = t.a * (1.0 - root) + t.b * (root * (1.0 - u.y)) + t.c * (root * u.y);
  point.normal = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
  point.triangle = static_cast<std::uint32_t>(i);
  return point;
}

double LightSampler::pdf(LightId id, const Vec3& from, const Vec3& direction, double distance,
                         const Vec3& normal) const {
  const Prepared& prepared = prepared_[id.index()];
  if (prepared.dome) return prepared.dome->table().pdf(direction);
  if (const auto* sun = std::get_if<SunLight>(&scene_[id].emitter)) return 1.0 / solidAngle(*sun);
  if (!prepared.area) return 0.0;
  const AreaData& data = *prepared.area;
  if (const auto* sphere = std::get_if<Sphere>(&scene_[data.primitive].shape)) {
    const double d = glm::length(sphere->center - from);
    return 1.0 / (2.0 * kPi * (d > sphere->radius * (1.0 + 1e-9) ? coneDepth(sphere->radius, d) : 2.0));
  }
  double omega = 0;
  if (bySolidAngle(data, from, omega)) return 1.0 / omega;
  const double cosine = std::abs(glm::dot(direction, normal));
  return cosine > 0.0 ? distance * distance / (data.area * cosine) : 0.0;
}

Rgb LightSampler::emittedRadiance(LightId id, const Vec3& direction, double distance, bool front) const {
  const Emission& emission = *emissionOf(scene_, std::get<AreaLight>(scene_[id].emitter).primitive);
  return scaleOf(id) * deltalux::scene::emittedRadiance(emission, direction, distance, front);
}

Rgb LightSampler::radianceFrom(LightId id, const Vec3& towards) const {
  const Light& light = scene_[id];
  if (const auto* dome = std::get_if<DomeLight>(&light.emitter)) return skyRadiance(*dome, towards) * scaleOf(id);
  const auto& sun = std::get<SunLight>(light.emitter);
  // |a - b|^2 = 2 (1 - cos) keeps the digits that the cosine of a small angle loses.
  const Vec3 d = towards - sun.direction;
  return 0.5 * glm::dot(d, d) <= sunDepth(sun) ? sun.radiance * scaleOf(id) : Rgb(0.0f);
}

}  // namespace deltalux::scene
