#include "particles/coarse_exitance.hpp"

#include <algorithm>
#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "base/tuning.hpp"
#include "particles/tuning.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::particles {

namespace {

constexpr int kPanes = 64;  // [limit]

/// Irradiance from lights: of one sample of each, unshadowed, one is drawn by what it would bring, and a shadow ray
/// sent after it. [TCE05]
class Direct {
 public:
  Direct(const Scene& scene, const scene::LightSampler& lights) : scene_(scene), lights_(lights) {}

  double irradiance(const SurfacePoint& p, const tracing::RayTracer& tracer, Rng& rng, std::uint64_t& rays) {
    const std::size_t all = scene_.lights.size(), some = std::min<std::size_t>(all, deltalux::tuning::kPilots);
    if (all == 0) return 0;
    const double first = rng.uniform();
    samples_.clear();
    double total = 0;
    for (std::size_t i = 0; i < some; ++i) {
      // Where there are more, they are spread evenly over all.
      const auto light = static_cast<std::size_t>((static_cast<double>(i) + first) / static_cast<double>(some) *
                                                  static_cast<double>(all));
      const double u0 = rng.uniform(), u1 = rng.uniform();
      const auto s = lights_.sample(LightId(some < all ? light : i), p.position, {u0, u1});
      if (!s) continue;
      const double cosine = glm::dot(s->direction, p.normal);
      if (!(cosine > 0)) continue;
      const double unshadowed = cosine * gray(s->radiance) / (s->pdf > 0 ? s->pdf : 1.0);
      if (unshadowed > 0) samples_.push_back({total += unshadowed, *s});
    }
    const double target = rng.uniform() * total;
    if (samples_.empty()) return 0;
    const auto drawn = std::upper_bound(samples_.begin(), std::prev(samples_.end()), target,
                                        [](double x, const Sample& s) { return x < s.summed; });
    const scene::LightSample& to = drawn->light;
    ++rays;
    return total * static_cast<double>(all) / static_cast<double>(some) *
           gray(tracer.transmittance(tracing::shadowRay(p.position, p.normal, to.direction, to.distance, to.normal)));
  }

 private:
  struct Sample {
    double summed;
    scene::LightSample light;
  };

  const Scene& scene_;
  const scene::LightSampler& lights_;
  std::vector<Sample> samples_;
};

/// First surface that is not a pane; what is covered in part stands in the way as often as that.
tracing::Hit look(const Scene& scene, const tracing::RayTracer& tracer, const SurfacePoint& p, const Vec3& w, Rng& rng,
                  std::uint64_t& rays) {
  tracing::Ray ray;
  ray.direction = Vec3f(w);
  ray.origin = tracing::offsetOrigin(Vec3f(p.position), Vec3f(p.normal), ray.direction);
  for (int pane = 0; pane < kPanes; ++pane) {
    const tracing::Hit hit = tracer.closestHit(ray);
    ++rays;
    if (!hit) return hit;
    const Material& material = scene.materialOf(hit.primitive);
    if (!passesStraight(material) || (!isClear(material) && rng.uniform() < material.coverage)) return hit;
    ray.origin = tracing::offsetOrigin(hit.position, hit.normal, ray.direction);
  }
  return {};
}

/// What rays at a cell find.
struct Found {
  double direct = 0;                                          // irradiance by lights
  std::array<std::uint32_t, deltalux::tuning::kPilots> seen;  // cells; kNone where there is none
};

/// What few points of a cell missed may still be there: raises cells to a share of the mean around them, and of the
/// mean around that.
void raise(const Senders& senders, std::vector<double>& exitance) {
  const std::uint32_t first = senders.surfaceCells();
  struct Sum {
    double flux = 0, area = 0;
    double mean() const { return area > 0 ? flux / area : 0; }
  };
  std::vector<Sum> sums(senders.nodes().size());
  std::vector<double> least(senders.nodes().size(), 0.0);
  const std::uint32_t root = senders.surfaceRoots().front();
  for (std::size_t n = sums.size(); n-- > root;) {
    const RadixNode& node = senders.nodes()[n];
    if (node.isLeaf()) {
      const double area = senders.cells()[node.begin].measure;
      sums[n] = {area * exitance[node.begin - first], area};
      continue;
    }
    const Sum &a = sums[node.child[0]], &b = sums[node.child[1]];
    sums[n] = {a.flux + b.flux, a.area + b.area};
  }
  // In steps: a small edit, which moves the mean a little, must not change every cell.
  const double floor = sums[root].flux > 0 ? coarse(deltalux::tuning::kDefensive * sums[root].mean()) : 1.0;
  least[root] = floor;
  for (std::size_t n = root; n < sums.size(); ++n) {
    const RadixNode& node = senders.nodes()[n];
    if (node.isLeaf()) {
      double& x = exitance[node.begin - first];
      x = std::max({x, least[n], floor});
      continue;
    }
    const double here = std::max(least[n], sums[n].mean());
    for (const std::uint32_t child : node.child) least[child] = tuning::kAround * here;
  }
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

CoarseExitance coarseExitance(const Scene& scene, const tracing::RayTracer& tracer, const scene::LightSampler& lights,
                              const Senders& senders, std::span<const double> caustics) {
  CoarseExitance result;
  result.perCell = skyStrengths(scene, senders);
  const std::uint32_t first = senders.surfaceCells();
  const std::size_t count = senders.cells().size() - first;
  if (count == 0) return result;
  std::vector<std::uint64_t> keys(senders.cells().size());
  for (const RadixNode& n : senders.nodes())
    if (n.isLeaf()) keys[n.begin] = n.key;

  constexpr std::size_t kBlock = 64;  // [task]
  std::vector<Found> found(count);
  std::vector<std::uint64_t> rays((count + kBlock - 1) / kBlock, 0);
  parallelBlocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
    Direct direct(scene, lights);
    for (std::size_t i = begin; i < end; ++i) {
      const auto cell = static_cast<std::uint32_t>(first + i);
      const ScrambledSobol places(keys[cell]), directions(mix64(keys[cell]));
      Rng rng(keys[cell]);
      for (std::uint32_t k = 0; k < deltalux::tuning::kPilots; ++k) {
        const UnitPair place = places(k), way = directions(k);
        const SurfacePoint p = senders.point(cell, {place.x, place.y});
        found[i].direct += direct.irradiance(p, tracer, rng, rays[begin / kBlock]) / deltalux::tuning::kPilots;
        const tracing::Hit hit =
            look(scene, tracer, p, cosineDirection(Frame(p.normal), way.x, way.y), rng, rays[begin / kBlock]);
        found[i].seen[k] = RadixNode::kNone;
        if (!hit) continue;
        const Vec2 uv = parameterAt(scene[hit.primitive].shape, Vec3(hit.position), hit.triangle);
        found[i].seen[k] = senders.cellOf(hit.primitive, hit.triangle, hit.front, uv);
      }
    }
  });
  for (const std::uint64_t r : rays) result.rays += r;

  std::vector<double> source(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double measure = senders.cells()[first + i].measure;
    source[i] = tuning::kNominalReflectance * (found[i].direct + (measure > 0 ? caustics[first + i] / measure : 0.0));
  }
  std::vector<double> exitance = source;
  for (int bounce = 0; bounce < deltalux::tuning::kPilotBounces; ++bounce) {
    const std::vector<double> before = exitance;
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0;
      for (const std::uint32_t cell : found[i].seen)
        if (cell != RadixNode::kNone) sum += before[cell - first];
      exitance[i] = source[i] + tuning::kNominalReflectance * sum / deltalux::tuning::kPilots;
    }
  }
  raise(senders, exitance);
  for (std::size_t i = 0; i < count; ++i) result.perCell[first + i] = static_cast<float>(exitance[i]);
  return result;
}

}  // namespace deltalux::particles
