#include "paper/side_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "base/pilot_paths.hpp"
#include "base/tuning.hpp"

namespace deltalux::paper {

namespace {

constexpr int kPanes = 64;  // panes that a ray passes before it is given up [limit]

/// Lights that a vertex looks at, which stand for all of them.
std::size_t lightsPicked(const Scene& scene) {
  return std::min<std::size_t>(scene.lights.size(), deltalux::tuning::kPilots);
}

Rgb scaleOf(const Light& light) { return isBlack(light.scale) ? Rgb(deltalux::tuning::kNegligible) : light.scale; }

Vec3f cosineDirection(const Vec3& normal, Rng& rng) {
  const double r = std::sqrt(rng.uniform()), phi = 2 * kPi * rng.uniform();
  return Vec3f(Frame(normal).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - r * r))}));
}

}  // namespace

SideEstimator::SideEstimator(const Scene& scene, const tracing::RayTracer& tracer, std::size_t sides)
    : scene_(scene),
      tracer_(tracer),
      rays_(std::max<std::size_t>(kPilotPaths / std::max<std::size_t>(sides, 1), deltalux::tuning::kPilots)) {}

double SideEstimator::diagonal() const {
  std::call_once(measured_, [&] { diagonal_ = bounds(scene_).diagonal(); });
  return diagonal_;
}

std::vector<tracing::Hit> SideEstimator::firstMet(const hierarchy::Side& side, std::size_t rays) const {
  std::vector<tracing::Hit> found;
  Rng rng(combineKeys(combineKeys(side.primitive.value, side.triangle), side.front), 1);
  for (std::size_t k = 0; k < rays; ++k) {
    const double u = (double(k) + rng.uniform()) / double(rays), v = rng.uniform();
    const Origin o = pointOnSide(side, {u, v});
    float t = 0;
    Rgb through(1.0f);
    found.push_back(look(o, cosineDirection(o.normal, rng), rng, through, t));
  }
  return found;
}

SideEstimator::Origin SideEstimator::pointOnSide(const hierarchy::Side& side, Vec2 u) const {
  const Shape& shape = scene_[side.primitive].shape;
  Origin o;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const auto& t = mesh->triangles[side.triangle];
    if (u.x + u.y > 1) u = Vec2(1.0) - u;
    const Vec3 p = mesh->positions[t[0]], a = mesh->positions[t[1]] - p, b = mesh->positions[t[2]] - p;
    const Vec3 n = glm::cross(a, b);
    o = {p + u.x * a + u.y * b, glm::length(n) > 0 ? glm::normalize(n) : Vec3(0, 0, 1)};
  } else {
    const SurfacePoint s = samplePoint(shape, u);
    o = {s.position, s.normal};
  }
  if (!side.front) o.normal = -o.normal;
  return o;
}

/// What sides reflect of what they receive, every way together: this is an estimate, not transport.
Rgb SideEstimator::wholeReflectance(const hierarchy::Side& side) const {
  const Material& m = scene_.materialOf(side.primitive);
  Rgb r = diffuseReflectance(m, side.front);
  if (const auto* opaque = std::get_if<Opaque>(&m.surface)) r += m.coverage * opaque->specular.reflectance;
  if (const auto* mirror = std::get_if<Mirror>(&m.surface); mirror && side.front) r += m.coverage * mirror->reflectance;
  return r;
}

/// Whether a ray that comes straight down on the point meets another surface in its stead, one in the same place.
bool SideEstimator::hidden(const hierarchy::Side& side, const Origin& o) const {
  tracing::Ray ray;
  ray.direction = -Vec3f(o.normal);
  ray.origin = tracing::offsetOrigin(Vec3f(o.position), Vec3f(o.normal), Vec3f(o.normal));
  const float height = glm::dot(ray.origin - Vec3f(o.position), Vec3f(o.normal));
  const tracing::Hit hit = tracer_.closestHit(ray);
  return hit && hit.primitive != side.primitive && hit.t <= 2 * height;
}

bool SideEstimator::hidden(const hierarchy::Side& side, std::size_t points) const {
  Rng rng(combineKeys(combineKeys(side.primitive.value, side.triangle), side.front), 2);
  for (std::size_t k = 0; k < points; ++k) {
    const double u = (double(k) + rng.uniform()) / double(points);
    if (!hidden(side, pointOnSide(side, {u, rng.uniform()}))) return false;
  }
  return true;
}

SideEstimate SideEstimator::estimate(const hierarchy::Side& side) const {
  SideEstimate e;
  e.side = {side.primitive, side.triangle, side.front};
  const bool triangle = std::holds_alternative<Mesh>(scene_[side.primitive].shape);
  const std::size_t rays = triangle ? rays_ : std::max(rays_, static_cast<std::size_t>(deltalux::tuning::kPilots));
  if (hidden(side, rays)) return e;
  Rng rng(combineKeys(combineKeys(side.primitive.value, side.triangle), side.front));
  double path = 0;
  std::size_t found = 0;
  RgbSum total(0.0);
  double own = 0;
  double root = 0;  // mean root of direct light: a bright patch does not speak for the whole surface
  for (std::size_t k = 0; k < rays; ++k) {
    RgbSum sum(0.0);
    const double u = (double(k) + rng.uniform()) / double(rays), v = rng.uniform();
    Origin o = pointOnSide(side, {u, v});
    Rgb throughput(1.0f);
    for (int bounce = 0; bounce <= deltalux::tuning::kPilotBounces; ++bounce) {
      const Rgb direct = directAt(o, rng);
      if (bounce == 0) {
        root += std::sqrt(gray(direct)) / double(rays);
        own += gray(direct) / double(rays);
      }
      sum += RgbSum(throughput * direct);
      const Vec3f w = cosineDirection(o.normal, rng);
      float t = 0;
      Rgb through(1.0f);
      const tracing::Hit hit = look(o, w, rng, through, t);
      e.rays += 1 + lightsPicked(scene_);
      if (!hit) {
        for (const Light& light : scene_.lights)
          if (const auto* dome = std::get_if<DomeLight>(&light.emitter))
            sum += kPi * RgbSum(throughput * through * scaleOf(light) * skyRadiance(*dome, Vec3(w)));
        break;
      }
      if (bounce == 0) path += t, ++found;
      const hierarchy::Side other = sideOf(scene_, hit);
      e.met.push_back(other);
      if (!isBlack(direct * through)) e.lit.push_back(other);
      throughput *= through * wholeReflectance(other);
      if (isBlack(throughput)) break;
      o.position = Vec3(hit.position);
      o.normal = Vec3(hit.front ? hit.normal : -hit.normal);
    }
    total += sum / double(rays);
  }
  if (isBlack(Rgb(total))) e.met.clear();
  e.side.irradiance = Rgb(total);
  e.side.typicalIrradiance = static_cast<float>(std::max(0.0, gray(total) - own) + root * root);
  e.side.meanFreePath = static_cast<float>(found > 0 ? path / double(found) : diagonal());
  return e;
}

/// First surface that is not a pane; what is covered in part stands in the way as often as that.
tracing::Hit SideEstimator::look(const Origin& o, const Vec3f& w, Rng& rng, Rgb& through, float& t) const {
  tracing::Ray ray;
  ray.origin = tracing::offsetOrigin(Vec3f(o.position), Vec3f(o.normal), w);
  ray.direction = w;
  for (int pane = 0; pane < kPanes; ++pane) {
    const tracing::Hit hit = tracer_.closestHit(ray);
    if (!hit) return hit;
    t += hit.t;
    const Material& material = scene_.materialOf(hit.primitive);
    if (!passesStraight(material)) return hit;
    if (!isClear(material)) {
      if (rng.uniform() < material.coverage) return hit;
      through *= material.filter;
    } else {
      through *= straightTransmittance(material, std::abs(glm::dot(hit.normal, w)));
    }
    ray.origin = tracing::offsetOrigin(hit.position, hit.normal, w);
  }
  return {};
}

Rgb SideEstimator::directAt(const Origin& o, Rng& rng) const {
  // A few lights picked at random stand for all of them.
  const std::size_t lights = scene_.lights.size();
  Rgb sum(0.0f);
  const std::size_t picked = lightsPicked(scene_);
  for (std::size_t k = 0; k < picked; ++k) {
    const std::size_t index =
        lights == picked ? k : static_cast<std::size_t>(rng.uniform() * static_cast<double>(lights));
    const float weight = static_cast<float>(lights) / static_cast<float>(picked);
    sum += weight * fromLight(o, scene_.lights[index], rng);
  }
  return sum;
}

Rgb SideEstimator::fromLight(const Origin& o, const Light& light, Rng& rng) const {
  const Vec3f x(o.position), n(o.normal);
  return std::visit(
      [&, scale = scaleOf(light)](const auto& emitter) -> Rgb {
        using T = std::decay_t<decltype(emitter)>;
        if constexpr (std::is_same_v<T, SunLight>) {
          const float cosine = glm::dot(n, Vec3f(emitter.direction));
          if (cosine <= 0) return Rgb(0.0f);
          tracing::Ray ray;
          ray.direction = Vec3f(emitter.direction);
          ray.origin = tracing::offsetOrigin(x, n, ray.direction);
          return float(solidAngle(emitter)) * cosine * emitter.radiance * scale * tracer_.transmittance(ray);
        } else if constexpr (std::is_same_v<T, AreaLight>) {
          return fromArea(x, n, emitter.primitive, scale, rng);
        } else if constexpr (requires { emitter.position; }) {
          const Vec3f d = Vec3f(emitter.position) - x;
          const float squared = glm::dot(d, d);
          const Vec3f w = d / std::sqrt(squared);
          const float cosine = glm::dot(n, w);
          if (!(cosine > 0)) return Rgb(0.0f);
          return cosine / squared * radiantIntensity(emitter, -Vec3(w)) * scale *
                 tracer_.transmittance(tracing::segment(x, n, Vec3f(emitter.position), -w));
        } else {
          return Rgb(0.0f);
        }
      },
      light.emitter);
}

Rgb SideEstimator::fromArea(const Vec3f& x, const Vec3f& n, PrimitiveId primitive, const Rgb& scale, Rng& rng) const {
  const Material& material = scene_.materialOf(primitive);
  const Shape& shape = scene_[primitive].shape;
  const double u = rng.uniform();
  const SurfacePoint y = samplePoint(shape, {u, rng.uniform()});
  const Vec3f d = Vec3f(y.position) - x;
  const float squared = std::max(glm::dot(d, d), 1e-12f);
  const Vec3f w = d / std::sqrt(squared);
  const float cosine = glm::dot(n, w);
  float cosEmitter = -glm::dot(Vec3f(y.normal), w);
  if (material.emission->bothSides) cosEmitter = std::abs(cosEmitter);
  if (!(cosine > 0 && cosEmitter > 0)) return Rgb(0.0f);
  cosEmitter *= static_cast<float>(relativeRadiance(*material.emission, -Vec3(w), std::sqrt(squared)));
  const float A = static_cast<float>(area(shape));
  const float kernel = std::min(cosine * cosEmitter * A / squared, float(kPi));
  return kernel * material.emission->radiance * scale *
         tracer_.transmittance(tracing::segment(x, n, Vec3f(y.position), Vec3f(y.normal)));
}

}  // namespace deltalux::paper
