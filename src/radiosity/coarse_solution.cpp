#include "radiosity/coarse_solution.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux {

namespace {

constexpr std::uint64_t kPathBudget = 1u << 17;
constexpr std::size_t kMost = 64;                           // paths of one side
constexpr std::size_t kFewest = 24, kFewestOfTriangle = 8;  // a mesh's triangles speak for each other
constexpr int kBounces = 3;
constexpr std::size_t kPicked = 3;  // lights a vertex looks at
constexpr int kPanes = 8;           // panes that a ray passes before it is given up

struct Origin {
  Vec3 position, normal;
};

Origin pointOnSide(const Scene& scene, const SurfaceSide& side, Vec2 u) {
  const Shape& shape = scene[side.primitive].shape;
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
Rgb wholeReflectance(const Scene& scene, const SurfaceSide& side) {
  const Material& m = scene.materialOf(side.primitive);
  Rgb r = diffuseReflectance(m, side.front);
  if (const auto* opaque = std::get_if<Opaque>(&m.surface)) r += opaque->specular.reflectance;
  if (const auto* mirror = std::get_if<Mirror>(&m.surface); mirror && side.front) r += mirror->reflectance;
  return r;
}

class Estimator {
 public:
  Estimator(const Scene& scene, const RayTracer& tracer) : scene_(scene), tracer_(tracer), sides_(surfaceSides(scene)) {
    first_.resize(scene.primitives.size(), 0);
    twoSided_.resize(scene.primitives.size(), false);
    for (std::size_t i = sides_.size(); i-- > 0;) first_[sides_[i].primitive.index()] = static_cast<std::uint32_t>(i);
    for (const SurfaceSide& s : sides_)
      if (!s.front) twoSided_[s.primitive.index()] = true;  // has back sides too
    diagonal_ = bounds(scene).diagonal();
    rays_ = std::clamp<std::size_t>(kPathBudget / std::max<std::size_t>(sides_.size(), 1), kFewestOfTriangle, kMost);
  }

  std::vector<SurfaceSide> run(CoarseReport* report) {
    const std::size_t n = sides_.size();
    estimates_.assign(n, {});
    lit_ = std::vector<std::atomic<char>>(n);
    parallelFor(n, 32, [&](std::size_t i) { estimate(i); });
    std::vector<SurfaceSide> result;
    std::uint64_t rays = 0;
    for (std::size_t i = 0; i < n; ++i) {
      rays += estimates_[i].rays;
      if (isBlack(estimates_[i].E) && !lit_[i] && !isGlass(i)) continue;
      result.push_back(sides_[i]);
      result.back().irradiance = estimates_[i].E;
      result.back().typicalIrradiance = estimates_[i].typical;
    }
    if (report) *report = {rays, n, result.size()};
    return result;
  }

 private:
  std::uint32_t sideOf(const Hit& hit) const {
    const std::uint32_t base = first_[hit.primitive.index()];
    return twoSided_[hit.primitive.index()] ? base + 2 * hit.triangle + (hit.front ? 0u : 1u) : base + hit.triangle;
  }

  bool isGlass(std::size_t i) const { return !twoSided_[sides_[i].primitive.index()]; }

  /// Paths from the side's surface: light found at every vertex counts, so that a lit part of a floor does not light
  /// what sees only its dark part.
  void estimate(std::size_t i) {
    SurfaceSide& side = sides_[i];
    Estimate& e = estimates_[i];
    const bool triangle = std::holds_alternative<Mesh>(scene_[side.primitive].shape);
    const std::size_t rays = triangle ? rays_ : std::max(rays_, kFewest);
    Rng rng(combineKeys(combineKeys(side.primitive.value, side.triangle), side.front));
    double path = 0;
    std::size_t found = 0;
    RgbSum total(0.0);
    double own = 0;
    double root = 0;  // mean root of direct light: a bright patch does not speak for the whole surface
    for (std::size_t k = 0; k < rays; ++k) {
      RgbSum sum(0.0);
      const double u = (double(k) + rng.uniform()) / double(rays), v = rng.uniform();
      Origin o = pointOnSide(scene_, side, {u, v});
      Rgb throughput(1.0f);
      for (int bounce = 0; bounce <= kBounces; ++bounce) {
        const Rgb direct = directAt(o, rng);
        if (bounce == 0) {
          root += std::sqrt(gray(direct)) / double(rays);
          own += gray(direct) / double(rays);
        }
        sum += RgbSum(throughput * direct);
        const double r = std::sqrt(rng.uniform()), phi = 2 * kPi * rng.uniform();
        const Vec3f w(
            Frame(o.normal).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - r * r))}));
        float t = 0;
        Rgb through(1.0f);
        const Hit hit = look(o, w, through, t);
        e.rays += 1 + std::min(scene_.lights.size(), kPicked);
        if (!hit) {
          for (const Light& light : scene_.lights)
            if (const auto* dome = std::get_if<DomeLight>(&light.emitter))
              sum += kPi * RgbSum(throughput * through * light.scale * skyRadiance(*dome, Vec3(w)));
          break;
        }
        if (bounce == 0) path += t, ++found;
        const std::uint32_t j = sideOf(hit);
        if (!isBlack(direct * through)) lit_[j].store(1, std::memory_order_relaxed);
        throughput *= through * wholeReflectance(scene_, sides_[j]);
        if (isBlack(throughput)) break;
        o.position = Vec3(hit.position);
        o.normal = Vec3(hit.front ? hit.normal : -hit.normal);
      }
      total += sum / double(rays);
    }
    e.E = Rgb(total);
    e.typical = static_cast<float>(std::max(0.0, gray(total) - own) + root * root);
    side.meanFreePath = static_cast<float>(found > 0 ? path / double(found) : diagonal_);
  }

  /// First surface that is not a pane.
  Hit look(const Origin& o, const Vec3f& w, Rgb& through, float& t) const {
    Ray ray;
    ray.origin = offsetOrigin(Vec3f(o.position), Vec3f(o.normal), w);
    ray.direction = w;
    for (int pane = 0; pane < kPanes; ++pane) {
      const Hit hit = tracer_.closestHit(ray);
      if (!hit) return hit;
      t += hit.t;
      const auto* glass = std::get_if<ThinGlass>(&scene_.materialOf(hit.primitive).surface);
      if (!glass) return hit;
      through *= transmittance(*glass, std::abs(glm::dot(hit.normal, w)));
      ray.origin = offsetOrigin(hit.position, hit.normal, w);
    }
    return {};
  }

  Rgb directAt(const Origin& o, Rng& rng) const {
    // A few lights picked at random stand for all of them.
    const std::size_t lights = scene_.lights.size();
    Rgb sum(0.0f);
    for (std::size_t k = 0; k < std::min(lights, kPicked); ++k) {
      const std::size_t index =
          lights <= kPicked ? k : static_cast<std::size_t>(rng.uniform() * static_cast<double>(lights));
      const float weight = lights <= kPicked ? 1.0f : static_cast<float>(lights) / float(kPicked);
      sum += weight * fromLight(o, scene_.lights[index], rng);
    }
    return sum;
  }

  Rgb fromLight(const Origin& o, const Light& light, Rng& rng) const {
    const Vec3f x(o.position), n(o.normal);
    return std::visit(
        [&](const auto& emitter) -> Rgb {
          using T = std::decay_t<decltype(emitter)>;
          if constexpr (std::is_same_v<T, SunLight>) {
            const float cosine = glm::dot(n, Vec3f(emitter.direction));
            if (cosine <= 0) return Rgb(0.0f);
            Ray ray;
            ray.direction = Vec3f(emitter.direction);
            ray.origin = offsetOrigin(x, n, ray.direction);
            return float(solidAngle(emitter)) * cosine * emitter.radiance * light.scale * tracer_.transmittance(ray);
          } else if constexpr (std::is_same_v<T, AreaLight>) {
            return fromArea(x, n, emitter.primitive, light.scale, rng);
          } else if constexpr (requires { emitter.position; }) {
            const Vec3f d = Vec3f(emitter.position) - x;
            const float squared = glm::dot(d, d);
            const Vec3f w = d / std::sqrt(squared);
            const float cosine = glm::dot(n, w);
            if (!(cosine > 0)) return Rgb(0.0f);
            return cosine / squared * radiantIntensity(emitter, -Vec3(w)) * light.scale *
                   tracer_.transmittance(segment(x, n, Vec3f(emitter.position), -w));
          } else {
            return Rgb(0.0f);
          }
        },
        light.emitter);
  }

  Rgb fromArea(const Vec3f& x, const Vec3f& n, PrimitiveId primitive, const Rgb& scale, Rng& rng) const {
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
    if (const auto& spot = material.emission->spot) {
      const double focal = glm::length(spot->direction);
      if (glm::dot(-Vec3(w), spot->direction) < focal * std::cos(0.5 * spot->fullAngle)) return Rgb(0.0f);
      const float ratio = std::sqrt(squared) / (std::sqrt(squared) + static_cast<float>(focal));
      cosEmitter *= ratio * ratio;
    }
    const float A = static_cast<float>(area(shape));
    const float kernel = std::min(cosine * cosEmitter * A / squared, float(kPi));
    return kernel * material.emission->radiance * scale *
           tracer_.transmittance(segment(x, n, Vec3f(y.position), Vec3f(y.normal)));
  }

  struct Estimate {
    Rgb E{0.0f};
    float typical = 0;
    std::uint64_t rays = 0;
  };

  const Scene& scene_;
  const RayTracer& tracer_;
  std::vector<SurfaceSide> sides_;
  std::vector<std::uint32_t> first_;
  std::vector<char> twoSided_;
  std::size_t rays_ = 64;
  double diagonal_ = 0;
  std::vector<Estimate> estimates_;
  std::vector<std::atomic<char>> lit_;  // hit by a ray from a lit point
};

}  // namespace

std::vector<SurfaceSide> coarseSolution(const Scene& scene, const RayTracer& tracer, CoarseReport* report) {
  return Estimator(scene, tracer).run(report);
}

}  // namespace deltalux
