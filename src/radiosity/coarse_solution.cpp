#include "radiosity/coarse_solution.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux {

namespace {

constexpr std::uint64_t kRayBudget = 1u << 20;
constexpr int kIterations = 12;
constexpr int kPanes = 8;  // panes that a ray passes before it is given up

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
    rays_ = std::clamp<std::size_t>(kRayBudget / std::max<std::size_t>(sides_.size(), 1), 8, 64);
  }

  std::vector<SurfaceSide> run(CoarseReport* report) {
    const std::size_t n = sides_.size();
    direct_.assign(n, Rgb(0.0f));
    seen_.assign(n * rays_, kNothing);
    through_.assign(n * rays_, 1.0f);
    open_.assign(n, 0);
    parallelFor(n, 64, [&](std::size_t i) { look(i); });
    std::vector<Rgb> E = radiosity();

    // Seen by a side that has light, or open to the outside: light can get there, though this side's rays missed it.
    std::vector<char> reachable(n, 0);
    for (std::size_t i = 0; i < n; ++i) reachable[i] = !isBlack(E[i]) || open_[i];
    for (std::size_t i = 0; i < n; ++i) {
      if (isBlack(E[i]) && !open_[i]) continue;
      for (std::size_t k = 0; k < rays_; ++k)
        if (const std::uint32_t j = seen_[i * rays_ + k]; j != kNothing) reachable[j] = 1;
    }
    std::vector<SurfaceSide> result;
    for (std::size_t i = 0; i < n; ++i) {
      const bool glass = first_[sides_[i].primitive.index()] == i && !twoSided_[sides_[i].primitive.index()];
      if (!reachable[i] && !glass) continue;
      result.push_back(sides_[i]);
      result.back().irradiance = E[i];
    }
    if (report) {
      report->sides = n;
      report->reachable = result.size();
      report->rays = n * static_cast<std::uint64_t>(rays_) * 2;
    }
    return result;
  }

 private:
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  std::uint32_t sideOf(const Hit& hit) const {
    const std::uint32_t base = first_[hit.primitive.index()];
    return twoSided_[hit.primitive.index()] ? base + 2 * hit.triangle + (hit.front ? 0u : 1u) : base + hit.triangle;
  }

  void look(std::size_t i) {
    SurfaceSide& side = sides_[i];
    Rng rng(combineKeys(combineKeys(side.primitive.value, side.triangle), side.front));
    double path = 0;
    int found = 0;
    RgbSum direct(0.0);
    for (std::size_t k = 0; k < rays_; ++k) {
      const double u = (double(k) + rng.uniform()) / double(rays_), v = rng.uniform();
      const Origin o = pointOnSide(scene_, side, {u, v});
      const double r = std::sqrt(rng.uniform()), phi = 2 * kPi * rng.uniform();
      const Vec3f w(
          Frame(o.normal).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - r * r))}));
      direct += RgbSum(directAt(o, rng));
      float t = 0;
      Rgb through(1.0f);
      const Hit hit = look(o, w, through, t);
      if (hit) {
        path += t, ++found;
        seen_[i * rays_ + k] = sideOf(hit);
        through_[i * rays_ + k] = gray(through);
      } else {
        open_[i] = 1;
        for (const Light& light : scene_.lights)
          if (const auto* dome = std::get_if<DomeLight>(&light.emitter))
            direct += kPi * RgbSum(through * light.scale * skyRadiance(*dome, Vec3(w)));
      }
    }
    direct_[i] = Rgb(direct / double(rays_));
    side.meanFreePath = static_cast<float>(found > 0 ? path / found : diagonal_);
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
    constexpr std::size_t kPicked = 6;
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

  /// Jacobi iteration over what the rays saw.
  std::vector<Rgb> radiosity() const {
    const std::size_t n = sides_.size();
    std::vector<Rgb> E = direct_, B(n);
    std::vector<Rgb> rho(n);
    parallelFor(n, 1024, [&](std::size_t i) { rho[i] = wholeReflectance(scene_, sides_[i]); });
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      parallelFor(n, 1024, [&](std::size_t i) { B[i] = rho[i] * E[i]; });
      parallelFor(n, 256, [&](std::size_t i) {
        Rgb sum(0.0f);
        for (std::size_t k = 0; k < rays_; ++k) {
          const std::size_t ray = i * rays_ + k;
          if (seen_[ray] != kNothing) sum += through_[ray] * B[seen_[ray]];
        }
        E[i] = direct_[i] + sum / float(rays_);
      });
    }
    return E;
  }

  const Scene& scene_;
  const RayTracer& tracer_;
  std::vector<SurfaceSide> sides_;
  std::vector<std::uint32_t> first_;
  std::vector<char> twoSided_;
  std::size_t rays_ = 64;
  double diagonal_ = 0;
  std::vector<Rgb> direct_;
  std::vector<std::uint32_t> seen_;
  std::vector<float> through_;
  std::vector<char> open_;
};

}  // namespace

std::vector<SurfaceSide> coarseSolution(const Scene& scene, const RayTracer& tracer, CoarseReport* report) {
  return Estimator(scene, tracer).run(report);
}

}  // namespace deltalux
