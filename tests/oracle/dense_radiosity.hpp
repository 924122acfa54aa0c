#pragma once
// The judge of the hierarchical solver on small rooms: classical radiosity over a fixed grid of patches, every pair
// with its form factor, (I - rho F) B = M solved exactly. It shares nothing with the solver but the description of the
// scene and the ray tracer.
//
// Form factors: from a grid of points of the one patch, the closed form of the other as a polygon cut at the horizon
// [Lambert1760; SH93] times the share of it that rays reach, both ways and averaged, so that they
// are reciprocal. Exact but for visibility and the constancy of B over a patch. Cost: patches^2 x samples.
#include <deltalux/scene.hpp>
#include <vector>

namespace deltalux::test {

struct OraclePatch {
  PrimitiveId primitive;
  Vec3 corners[4];  // counter-clockwise seen from the front
  Vec3 normal;
  double area = 0;

  Vec3 at(double u, double v) const {
    return glm::mix(glm::mix(corners[0], corners[1], u), glm::mix(corners[3], corners[2], u), v);
  }
};

struct OracleSettings {
  double patchSize = 0.5;                  // largest side of a patch [scene units]
  int points = 4;                          // a side of a patch, as receiver
  int rays = 2;                            // a side of the other patch, from each point
  int emitterPoints = 8, emitterRays = 4;  // the same where the other patch emits
};

struct OracleSolution {
  std::vector<OraclePatch> patches;
  std::vector<double> irradiance;  // mean E of each patch, green channel [W/m2]
  std::vector<double> rowSums;     // of form factors: 1 in a closed scene
};

/// For scenes of parallelograms that reflect and emit diffusely on their front alone.
OracleSolution solveDense(const Scene&, const OracleSettings& = {});

}  // namespace deltalux::test
