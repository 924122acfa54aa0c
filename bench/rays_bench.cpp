// rays_bench SCENE...
//
// Incoherent rays per second: the ray tracer's batches against a plain Embree loop over the same scene tessellated, in
// the same run, on one thread and on all. The rays are the segments of diffuse light paths (the surfaces are sampled by
// area, six segments a path), shuffled. Prints CSV: scene, threads, measure, value, unit; each value is the fastest of
// several rounds in which the measures take turns.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deltalux/io.hpp>
#include <exception>
#include <filesystem>
#include <functional>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "tracing/embree_handles.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {
namespace {

constexpr std::size_t kRays = 500000;
constexpr std::size_t kBlock = 1024;
constexpr double kSeconds = 6;  // for each number of threads

Vec3 randomDirection(Rng& rng) {
  const double z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A ray that leaves the surface diffusely, to the side of `normal`.
tracing::Ray diffuseRay(const Vec3f& from, const Vec3f& normal, Rng& rng) {
  tracing::Ray ray;
  ray.direction = Vec3f(glm::normalize(Vec3(normal) + 0.999999 * randomDirection(rng)));
  ray.origin = tracing::offsetOrigin(from, normal, ray.direction);
  return ray;
}

std::vector<tracing::Ray> diffusePaths(const Scene& scene, const tracing::RayTracer& tracer, std::size_t count) {
  std::vector<double> areas;
  double total = 0;
  for (const Primitive& p : scene.primitives) areas.push_back(total += area(p.shape));
  Rng rng(1);
  std::vector<tracing::Ray> rays;
  while (rays.size() < count) {
    const auto chosen = std::lower_bound(areas.begin(), areas.end(), rng.uniform() * total) - areas.begin();
    const SurfacePoint p =
        samplePoint(scene.primitives[static_cast<std::size_t>(chosen)].shape, {rng.uniform(), rng.uniform()});
    tracing::Ray ray = diffuseRay(Vec3f(p.position), Vec3f(rng.uniform() < 0.5 ? p.normal : -p.normal), rng);
    for (int segment = 0; segment < 6; ++segment) {
      rays.push_back(ray);
      const tracing::Hit hit = tracer.closestHit(ray);
      if (!hit) break;
      ray = diffuseRay(hit.position, hit.front ? hit.normal : -hit.normal, rng);
    }
  }
  for (std::size_t i = rays.size() - 1; i > 0; --i)
    std::swap(rays[i], rays[static_cast<std::size_t>(rng.uniform() * static_cast<double>(i + 1))]);
  rays.resize(count);
  return rays;
}

struct Triangles {
  std::vector<Vec3f> vertices;
  std::vector<std::array<unsigned, 3>> indices;

  void add(const Shape& shape) {
    const auto first = static_cast<unsigned>(vertices.size());
    const auto copy = [&](const auto& positions, const auto& triangles) {
      for (const Vec3& p : positions) vertices.emplace_back(p);
      for (const auto& t : triangles) indices.push_back({first + t[0], first + t[1], first + t[2]});
    };
    if (const auto* polygon = std::get_if<Polygon>(&shape)) return copy(polygon->vertices, polygon->triangles);
    if (const auto* mesh = std::get_if<Mesh>(&shape)) return copy(mesh->positions, mesh->triangles);
    constexpr unsigned around = 24;  // as tessellatedPolygonCount has it
    const unsigned down = std::holds_alternative<Sphere>(shape) ? 12 : 1;
    for (unsigned i = 0; i < around; ++i)
      for (unsigned j = 0; j <= down; ++j) {
        const double v = down > 1 ? 0.5 * (1 - std::cos(kPi * j / down)) : j;
        vertices.emplace_back(pointAt(shape, {double(i) / around, v}).position);
      }
    const auto corner = [&](unsigned i, unsigned j) { return first + (i % around) * (down + 1) + j; };
    for (unsigned i = 0; i < around; ++i)
      for (unsigned j = 0; j < down; ++j) {
        indices.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
        indices.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
      }
  }
};

tracing::EmbreeScene plainScene(RTCDevice device, const Triangles& triangles) {
  tracing::EmbreeScene scene(rtcNewScene(device));
  const tracing::EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  std::copy(triangles.vertices.begin(), triangles.vertices.end(),
            static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                        sizeof(Vec3f), triangles.vertices.size())));
  std::copy(
      triangles.indices.begin(), triangles.indices.end(),
      static_cast<std::array<unsigned, 3>*>(rtcSetNewGeometryBuffer(
          geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.indices.size())));
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcCommitScene(scene.get());
  tracing::throwEmbreeError(device);
  return scene;
}

/// What a program would write around rtcIntersect1 that keeps distance and triangle.
struct PlainHit {
  float t;
  unsigned triangle;
};

void plainLoop(RTCScene scene, const std::vector<tracing::Ray>& rays, std::vector<PlainHit>& hits) {
  parallelFor(rays.size(), kBlock, [&](std::size_t i) {
    const tracing::Ray& ray = rays[i];
    RTCRayHit found;
    found.ray = {ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 ray.tNear,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0,
                 ray.tFar,
                 ~0u,
                 0,
                 0};
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &found);
    hits[i] = {found.ray.tfar, found.hit.geomID == RTC_INVALID_GEOMETRY_ID ? ~0u : found.hit.primID};
  });
}

struct Measure {
  const char* name;
  std::function<void()> work;
  double best = kInfinity;  // seconds
};

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void run(const std::vector<std::filesystem::path>& files) {
  const Scene scene = loadScene(files).scene;
  std::unique_ptr<tracing::RayTracer> tracer;
  const double built = secondsOf([&] { tracer = tracing::makeEmbreeTracer(scene); });
  const std::vector<tracing::Ray> rays = diffusePaths(scene, *tracer, kRays);

  // A twin with a movable thing: the hundred primitives around the one in the middle of the scene's list.
  const auto grouped = tracing::makeEmbreeTracer(scene);
  std::vector<PrimitiveId> movable;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) movable.emplace_back(i);
  const Vec3 center = bounds(scene.primitives[movable.size() / 2].shape).center();
  const auto distance = [&](PrimitiveId id) { return glm::distance(bounds(scene[id].shape).center(), center); };
  std::sort(movable.begin(), movable.end(), [&](PrimitiveId x, PrimitiveId y) { return distance(x) < distance(y); });
  movable.resize(std::min<std::size_t>(100, movable.size()));
  const tracing::GroupId group = grouped->separate(movable);

  Triangles triangles;
  for (const Primitive& p : scene.primitives) triangles.add(p.shape);
  const tracing::EmbreeDevice device = tracing::makeEmbreeDevice();
  const tracing::EmbreeScene plain = plainScene(device.get(), triangles);

  std::vector<tracing::Hit> hits(kRays);
  std::vector<PlainHit> plainHits(kRays);
  std::vector<Rgb> passed(kRays);
  const std::string name = files.front().stem().string();
  fmt::print("scene,threads,measure,value,unit\n");
  fmt::print("{},{},primitives,{},\n", name, ThreadLimit::defaultThreads(), scene.primitives.size());
  fmt::print("{},{},tessellated triangles,{},\n", name, ThreadLimit::defaultThreads(), triangles.indices.size());
  fmt::print("{},{},build,{:.1f},ms\n", name, ThreadLimit::defaultThreads(), 1e3 * built);
  double rebuilt = kInfinity;
  for (int i = 0; i < 50; ++i) rebuilt = std::min(rebuilt, secondsOf([&] { grouped->rebuild(group); }));
  fmt::print("{},{},rebuild a group of {},{:.3f},ms\n", name, ThreadLimit::defaultThreads(), movable.size(),
             1e3 * rebuilt);
  for (std::size_t threads = 1; threads <= ThreadLimit::defaultThreads(); threads *= 2) {
    const ThreadLimit limit(threads);
    Measure measures[] = {
        {"plain Embree over triangles", [&] { plainLoop(plain.get(), rays, plainHits); }},
        {"closest hits", [&] { tracer->closestHits(rays, hits); }},
        {"closest hits with a movable group", [&] { grouped->closestHits(rays, hits); }},
        {"transmittances", [&] { tracer->transmittances(rays, passed); }},
    };
    for (double spent = 0; spent < kSeconds;)
      for (Measure& m : measures) {
        const double taken = secondsOf(m.work);
        m.best = std::min(m.best, taken);
        spent += taken;
      }
    for (const Measure& m : measures)
      fmt::print("{},{},{},{:.3f},Mrays/s\n", name, threads, m.name, 1e-6 * kRays / m.best);
    fmt::print("{},{},closest hits against plain Embree,{:.3f},ratio\n", name, threads,
               measures[0].best / measures[1].best);
  }
}

}  // namespace
}  // namespace deltalux

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: rays_bench SCENE...\n", stderr);
    return 2;
  }
  try {
    deltalux::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
