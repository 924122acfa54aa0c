#include "oracle/dense_radiosity.hpp"

#include <Eigen/Dense>

#include "base/parallel.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::test {

namespace {

std::vector<OraclePatch> patchesOf(const Scene& scene, double size) {
  std::vector<OraclePatch> patches;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const auto& p = std::get<Polygon>(scene.primitives[i].shape);
    if (!p.fillsFrame) throw std::invalid_argument("the oracle takes parallelograms");
    const int nu = static_cast<int>(std::ceil(glm::length(p.edgeU) / size - 1e-9));
    const int nv = static_cast<int>(std::ceil(glm::length(p.edgeV) / size - 1e-9));
    for (int v = 0; v < nv; ++v)
      for (int u = 0; u < nu; ++u) {
        const auto corner = [&](int a, int b) {
          return p.origin + double(u + a) / nu * p.edgeU + double(v + b) / nv * p.edgeV;
        };
        patches.push_back(
            {PrimitiveId(i), {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, p.normal, p.area / (nu * nv)});
      }
  }
  return patches;
}

/// The part of `polygon` in front of the plane through x.
std::vector<Vec3> aboveHorizon(const OraclePatch& polygon, const Vec3& x, const Vec3& n) {
  std::vector<Vec3> kept;
  for (int i = 0; i < 4; ++i) {
    const Vec3 a = polygon.corners[i] - x, b = polygon.corners[(i + 1) % 4] - x;
    const double da = glm::dot(a, n), db = glm::dot(b, n);
    if (da > 0) kept.push_back(a);
    if ((da > 0) != (db > 0)) kept.push_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

/// Form factor from the point x to the whole polygon. [Lambert1760]
double pointFactor(const Vec3& x, const Vec3& n, const OraclePatch& to) {
  if (glm::dot(to.normal, x - to.corners[0]) <= 1e-12) return 0;
  const std::vector<Vec3> corners = aboveHorizon(to, x, n);
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const Vec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across, n) / sine;
  }
  return std::max(0.0, -sum / (2 * kPi));  // seen from x the front's corners run clockwise
}

/// Share of `to` that a grid of rays from x reaches.
double visibleShare(const tracing::RayTracer& tracer, const Vec3& x, const Vec3& n, const OraclePatch& to, int rays) {
  int reached = 0, facing = 0;
  for (int i = 0; i < rays * rays; ++i) {
    const Vec3 y = to.at((i % rays + 0.5) / rays, (i / rays + 0.5) / rays), d = y - x;
    if (glm::dot(d, n) <= 0) continue;
    ++facing;
    tracing::Ray ray;
    ray.direction = Vec3f(glm::normalize(d));
    ray.origin = Vec3f(x + 1e-5 * n);
    ray.tFar = static_cast<float>(glm::length(d) * (1 - 1e-4));
    reached += !tracer.occluded(ray);
  }
  return facing > 0 ? double(reached) / facing : 0.0;
}

/// Mean over the patch `from` of the form factor to `to`.
double patchFactor(const tracing::RayTracer& tracer, const OraclePatch& from, const OraclePatch& to, int points,
                   int rays) {
  double sum = 0;
  for (int i = 0; i < points * points; ++i) {
    const Vec3 x = from.at((i % points + 0.5) / points, (i / points + 0.5) / points);
    const double factor = pointFactor(x, from.normal, to);
    if (factor > 0) sum += factor * visibleShare(tracer, x, from.normal, to, rays);
  }
  return sum / (points * points);
}

}  // namespace

OracleSolution solveDense(const Scene& scene, const OracleSettings& settings) {
  OracleSolution result;
  result.patches = patchesOf(scene, settings.patchSize);
  const auto n = static_cast<Eigen::Index>(result.patches.size());
  const auto tracer = tracing::makeEmbreeTracer(scene);
  Eigen::VectorXd M(n), rho(n), areas(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const OraclePatch& p = result.patches[static_cast<std::size_t>(i)];
    const Material& m = scene.materialOf(p.primitive);
    M[i] = m.emission ? kPi * m.emission->radiance.g : 0.0;
    rho[i] = diffuseReflectance(m, true).g;
    areas[i] = p.area;
  }
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);  // F(i, j): from i to j
  parallelFor(static_cast<std::size_t>(n), 1, [&](std::size_t row) {
    const auto i = static_cast<Eigen::Index>(row);
    for (Eigen::Index j = 0; j < n; ++j) {
      if (result.patches[row].primitive == result.patches[static_cast<std::size_t>(j)].primitive) continue;
      const bool lit = M[j] > 0;
      F(i, j) = patchFactor(*tracer, result.patches[row], result.patches[static_cast<std::size_t>(j)],
                            lit ? settings.emitterPoints : settings.points, lit ? settings.emitterRays : settings.rays);
    }
  });
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      // The finer of two estimates, where one side emits; else their mean.
      const double here = areas[i] * F(i, j), there = areas[j] * F(j, i);
      const double exchange = M[j] > 0 && !(M[i] > 0) ? here : M[i] > 0 && !(M[j] > 0) ? there : 0.5 * (here + there);
      F(i, j) = exchange / areas[i], F(j, i) = exchange / areas[j];
    }
  const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n) - rho.asDiagonal() * F;
  const Eigen::VectorXd B = system.partialPivLu().solve(M), E = F * B;
  for (Eigen::Index i = 0; i < n; ++i) {
    result.irradiance.push_back(E[i]);
    result.rowSums.push_back(F.row(i).sum());
  }
  return result;
}

}  // namespace deltalux::test
