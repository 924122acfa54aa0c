#include "particles/coarse_exitance.hpp"

#include <algorithm>
#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"

namespace deltalux {

namespace {

constexpr int kPaths = 4, kVertices = 3, kPicked = 2;
constexpr double kFloor = 0.02;   // of the scene's mean: what no ray found may still be there
constexpr double kHidden = 1e-3;  // of all that lights send, spread over all surfaces: light that only glass lets out
constexpr int kPanes = 8;

struct Vertex {
  Vec3 position, normal;
};

/// Lights by what they might bring to a point, unshadowed: a few of them are looked at.
class LightChoice {
 public:
  LightChoice(const Scene& scene, const LightSampler& lights) : scene_(scene), lights_(lights) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i) prepare(LightId(i));
  }

  /// About the flux that all lights send into a scene of that size.
  double flux(double diagonal) const {
    double sum = 0;
    for (const Known& k : known_) sum += k.power * (std::isinf(k.radius) ? diagonal * diagonal : 4 * kPi);
    return sum;
  }

  /// Irradiance at `v` from lights drawn by `rng`.
  double direct(const Vertex& v, const RayTracer& tracer, Rng& rng, std::vector<double>& weights,
                std::uint64_t& rays) const {
    if (known_.empty()) return 0;
    double total = 0;
    weights.clear();
    for (const Known& k : known_) weights.push_back(total += weight(k, v));
    double sum = 0;
    for (int pick = 0; pick < kPicked; ++pick) {
      const double target = rng.uniform() * total;
      const auto i = std::min<std::size_t>(
          static_cast<std::size_t>(std::upper_bound(weights.begin(), weights.end(), target) - weights.begin()),
          known_.size() - 1);
      const double chance = (weights[i] - (i > 0 ? weights[i - 1] : 0.0)) / total;
      const double u0 = rng.uniform(), u1 = rng.uniform();
      sum += arriving(known_[i], v, {u0, u1}, tracer, rays) / (chance * kPicked);
    }
    return sum;
  }

 private:
  struct Known {
    LightId id;
    double power = 0;  // gray intensity, or irradiance across the beam of what is at infinity
    Vec3 center{0};
    double radius = 0;  // infinite for suns and skies
  };

  void prepare(LightId id) {
    Known k{id, 0, Vec3(0), 0};
    const Light& light = scene_[id];
    if (const auto* area = std::get_if<AreaLight>(&light.emitter)) {
      const auto& emission = scene_.materialOf(area->primitive).emission;
      const Box box = bounds(scene_[area->primitive].shape);
      if (!emission || box.empty()) return;
      k.center = box.center(), k.radius = 0.5 * box.diagonal();
      k.power = gray(emission->radiance) * lights_.area(id);
    } else if (const auto* sun = std::get_if<SunLight>(&light.emitter)) {
      k.power = gray(sun->radiance) * solidAngle(*sun), k.radius = kInfinity;
    } else if (const auto* dome = std::get_if<DomeLight>(&light.emitter)) {
      k.power = kPi * gray(skyRadiance(*dome, dome->axis)), k.radius = kInfinity;
    } else {
      k.center = lights_.position(id);
      std::visit(
          [&](const auto& e) {
            if constexpr (requires { e.intensity; }) k.power = gray(e.intensity);
            if constexpr (requires {
                            e.scale;
                            e.position;
                          })
              k.power = gray(radiantIntensity(e, Vec3(0, 0, -1)));
          },
          light.emitter);
      k.power = std::max(k.power, 1e-6);
    }
    known_.push_back(k);
  }

  static double weight(const Known& k, const Vertex& v) {
    if (std::isinf(k.radius)) return k.power;
    const Vec3 d = k.center - v.position;
    return k.power / std::max(glm::dot(d, d), k.radius * k.radius + 1e-12);
  }

  /// Unscaled by edits: what the light's own values make.
  double arriving(const Known& k, const Vertex& v, const Vec2& u, const RayTracer& tracer, std::uint64_t& rays) const {
    const auto& emitter = scene_[k.id].emitter;
    const Vec3f x(v.position), n(v.normal);
    Ray ray;
    Vec3 w;
    double unshadowed = 0;
    if (const auto* area = std::get_if<AreaLight>(&emitter)) {
      const SurfacePoint y = lights_.samplePoint(k.id, u);
      const Vec3 d = y.position - v.position;
      const double distance = glm::length(d);
      if (!(distance > 0)) return 0;
      w = d / distance;
      const double there = -glm::dot(w, y.normal);
      const Rgb L = emittedRadiance(*scene_.materialOf(area->primitive).emission, -w, distance, there > 0);
      const double kernel = lights_.area(k.id) * std::abs(there) / (distance * distance);
      unshadowed = gray(L) * std::min(kernel, kPi);
      ray = segment(x, n, Vec3f(y.position), Vec3f(y.normal));
    } else if (std::isinf(k.radius)) {
      const auto s = lights_.sample(k.id, v.position, u);
      if (!s || !(s->pdf > 0)) return 0;
      w = s->direction;
      const auto* dome = std::get_if<DomeLight>(&emitter);
      unshadowed = gray(dome ? skyRadiance(*dome, w) : std::get<SunLight>(emitter).radiance) / s->pdf;
      ray.direction = Vec3f(w);
      ray.origin = offsetOrigin(x, n, ray.direction);
    } else {
      const Vec3 d = k.center - v.position;
      const double squared = glm::dot(d, d);
      if (!(squared > 0)) return 0;
      w = d / std::sqrt(squared);
      std::visit(
          [&](const auto& e) {
            if constexpr (requires { radiantIntensity(e, w); }) unshadowed = gray(radiantIntensity(e, -w)) / squared;
          },
          emitter);
      ray = segment(x, n, Vec3f(k.center), Vec3f(-w));
    }
    const double cosine = glm::dot(w, v.normal);
    if (!(cosine > 0) || !(unshadowed > 0)) return 0;
    ++rays;
    return cosine * unshadowed * gray(tracer.transmittance(ray));
  }

  const Scene& scene_;
  const LightSampler& lights_;
  std::vector<Known> known_;
};

/// First surface that is not a pane.
Hit look(const Scene& scene, const RayTracer& tracer, const Vertex& v, const Vec3& w, std::uint64_t& rays) {
  Ray ray;
  ray.direction = Vec3f(w);
  ray.origin = offsetOrigin(Vec3f(v.position), Vec3f(v.normal), ray.direction);
  for (int pane = 0; pane < kPanes; ++pane) {
    const Hit hit = tracer.closestHit(ray);
    ++rays;
    if (!hit || !isThinGlass(scene.materialOf(hit.primitive))) return hit;
    ray.origin = offsetOrigin(hit.position, hit.normal, ray.direction);
  }
  return {};
}

}  // namespace

std::vector<float> skyStrengths(const Scene& scene, const Senders& senders) {
  std::vector<float> strengths(senders.cells().size(), 1.0f);
  for (std::uint32_t c = 0; c < senders.surfaceCells(); ++c) {
    const SenderCell& cell = senders.cells()[c];
    if (cell.kind != SenderKind::Sky) continue;
    const auto& dome = std::get<DomeLight>(scene[cell.light].emitter);
    strengths[c] = std::max(gray(skyRadiance(dome, senders.direction(c, {0.5, 0.5}))), 1e-9f);
  }
  return strengths;
}

CoarseExitance coarseExitance(const Scene& scene, const RayTracer& tracer, const LightSampler& lights,
                              const Senders& senders) {
  CoarseExitance result;
  result.perCell = skyStrengths(scene, senders);
  const std::uint32_t first = senders.surfaceCells();
  const std::size_t count = senders.cells().size() - first;
  if (count == 0) return result;
  const LightChoice choice(scene, lights);
  std::vector<std::uint64_t> keys(senders.cells().size());
  for (const RadixNode& n : senders.nodes())
    if (n.isLeaf()) keys[n.begin] = n.key;

  std::vector<std::uint64_t> rays((count + 63) / 64, 0);
  parallelBlocks(count, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<double> weights;
    for (std::size_t i = begin; i < end; ++i) {
      const auto cell = static_cast<std::uint32_t>(first + i);
      double sum = 0;
      for (int path = 0; path < kPaths; ++path) {
        Rng rng(keys[cell], static_cast<std::uint64_t>(path));
        const double u0 = (path + rng.uniform()) / kPaths, u1 = rng.uniform();
        const SurfacePoint p = senders.point(cell, {u0, u1});
        Vertex v{p.position, p.normal};
        double throughput = 1;
        for (int k = 0; k < kVertices; ++k) {
          sum += throughput * choice.direct(v, tracer, rng, weights, rays[begin / 64]) / kPaths;
          if (k + 1 == kVertices) break;
          const double a = rng.uniform(), b = rng.uniform();
          const Vec3 w = cosineDirection(Frame(v.normal), a, b);
          const Hit hit = look(scene, tracer, v, w, rays[begin / 64]);
          if (!hit) break;
          throughput *= kNominalReflectance;
          v = {Vec3(hit.position), Vec3(hit.front ? hit.normal : -hit.normal)};
        }
      }
      result.perCell[cell] = static_cast<float>(kNominalReflectance * sum);
    }
  });
  for (const std::uint64_t r : rays) result.rays += r;

  double flux = 0, area = 0;
  for (std::size_t c = first; c < senders.cells().size(); ++c) {
    flux += double(senders.cells()[c].measure) * result.perCell[c];
    area += senders.cells()[c].measure;
  }
  const double hidden = kHidden * choice.flux(bounds(scene).diagonal());
  // In steps: a small edit, which moves the mean a little, must not change every cell.
  const auto floor = static_cast<float>(coarse((kFloor * flux + hidden) / area));
  for (std::size_t c = first; c < senders.cells().size(); ++c) result.perCell[c] = std::max(result.perCell[c], floor);
  return result;
}

void addFlux(CoarseExitance& exitance, const Senders& senders, std::span<const double> flux) {
  for (std::size_t c = senders.surfaceCells(); c < senders.cells().size(); ++c)
    exitance.perCell[c] += static_cast<float>(kNominalReflectance * flux[c] / senders.cells()[c].measure);
}

}  // namespace deltalux
