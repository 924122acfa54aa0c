#include "radiosity/row_reach.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "radiosity/direction_code.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kCosineSlack = 1e-4f;  // of cosines

std::size_t sectorOf(DirectionCode code) {
  return static_cast<std::size_t>((code.y + 128) >> 5 << 3 | (code.x + 128) >> 5);
}

/// Cones around the sectors, of all directions whose codes fall into them.
struct Sectors {
  std::array<float, RowReach::kSectors> x{}, y{}, z{}, cosine{}, sine{};
  using Bounds = std::array<std::array<float, RowReach::kSectors>, 3>;
  Bounds lower{}, upper{};  // by axis: of unit vectors, and the origin

  Sectors() {
    std::array<Vec3f, RowReach::kSectors> axis{};
    forEachCode([&](std::size_t s, const Vec3f& d) { axis[s] += d; });
    for (std::size_t s = 0; s < axis.size(); ++s) {
      axis[s] = glm::normalize(axis[s]);
      x[s] = axis[s].x, y[s] = axis[s].y, z[s] = axis[s].z, cosine[s] = 1;
    }
    forEachCode([&](std::size_t s, const Vec3f& d) {
      cosine[s] = std::min(cosine[s], glm::dot(axis[s], d));
      for (int k = 0; k < 3; ++k) {
        lower[k][s] = std::min(lower[k][s], d[k] - kDirectionCodeError);
        upper[k][s] = std::max(upper[k][s], d[k] + kDirectionCodeError);
      }
    });
    for (std::size_t s = 0; s < axis.size(); ++s) {
      const float angle = std::acos(cosine[s]) + kDirectionCodeError;
      cosine[s] = std::cos(angle), sine[s] = std::sin(angle);
    }
  }

 private:
  template <class Visit>
  static void forEachCode(const Visit& visit) {
    for (int x = -127; x <= 127; ++x)
      for (int y = -127; y <= 127; ++y) {
        const DirectionCode code{static_cast<std::int8_t>(x), static_cast<std::int8_t>(y)};
        visit(sectorOf(code), glm::normalize(direction(code)));
      }
  }
};

const Sectors& sectors() {
  static const Sectors all;
  return all;
}

constexpr int kNearestBits = 4 * (127 - 20);  // of 2^-20

/// Logarithm in quarters of octaves, rounded down; 0 for what is nearer than any ray goes.
std::uint8_t logarithm(float squared) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::sqrt(squared)) >> 21;
  return static_cast<std::uint8_t>(std::clamp(static_cast<int>(bits) - kNearestBits, 0, 254));
}

/// Below which all are whose logarithms are less.
float distanceBelow(std::uint8_t logarithm) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(logarithm + kNearestBits) << 21);
}

Vec3f middle(const hierarchy::ElementGeometry& g) { return 0.5f * (g.lower + g.upper); }

/// The cone that holds a box, as it is seen from a point.
struct ViewCone {
  Vec3f axis;
  float cosine = 1;

  ViewCone(const Vec3f& from, const Vec3f& lower, const Vec3f& upper)
      : axis(glm::normalize(0.5f * (lower + upper) - from)) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f d =
          Vec3f(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y, corner & 4 ? upper.z : lower.z) - from;
      cosine = std::min(cosine, glm::dot(axis, d) / glm::length(d));
    }
  }

  /// No sector is told apart from one so wide.
  bool wide() const { return !(cosine > 0.05f); }
};

}  // namespace

void RowReach::add(const hierarchy::ElementGeometry& leaf, const Vec3f& end) {
  const Vec3f d = end - middle(leaf);
  const float squared = glm::dot(d, d);
  if (!(squared > 0)) return;
  std::uint8_t& f = furthest[sectorOf(directionCode(d))];
  f = std::max(f, static_cast<std::uint8_t>(logarithm(squared) + 1));
}

void RowReach::add(const RowReach& more) {
  for (std::size_t s = 0; s < kSectors; ++s) furthest[s] = std::max(furthest[s], more.furthest[s]);
  objects.add(more.objects);
}

void RowReach::extend(const hierarchy::ElementGeometry& leaf, Vec3f& lower, Vec3f& upper) const {
  constexpr std::size_t kLanes = 16;
  const Sectors& all = sectors();
  const Vec3f from = middle(leaf);
  std::array<float, kSectors> far;
  for (std::size_t s = 0; s < kSectors; ++s) far[s] = furthest[s] > 0 ? distanceBelow(furthest[s]) : 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, kLanes> least{}, most{};
    for (std::size_t s = 0; s < kSectors; s += kLanes)
      for (std::size_t i = 0; i < kLanes; ++i) {
        least[i] = std::min(least[i], far[s + i] * all.lower[axis][s + i]);
        most[i] = std::max(most[i], far[s + i] * all.upper[axis][s + i]);
      }
    lower[axis] = std::min(lower[axis], from[axis] + *std::min_element(least.begin(), least.end()));
    upper[axis] = std::max(upper[axis], from[axis] + *std::max_element(most.begin(), most.end()));
  }
}

bool RowReach::meets(const hierarchy::ElementGeometry& leaf, const Vec3f& lower, const Vec3f& upper) const {
  const Vec3f from = middle(leaf), half = 0.5f * (leaf.upper - leaf.lower), low = lower - half, high = upper + half;
  const Vec3f near = glm::max(glm::max(low - from, from - high), Vec3f(0.0f));
  const float squared = glm::dot(near, near);
  if (!(squared > 0)) return true;
  const std::uint8_t nearest = logarithm(squared);
  std::uint8_t most = 0;
  for (const std::uint8_t f : furthest) most = std::max(most, f);
  if (most <= nearest) return false;
  const ViewCone cone(from, low, high);
  if (cone.wide()) return true;
  const Sectors& all = sectors();
  const float sine = std::sqrt(std::max(0.0f, 1 - cone.cosine * cone.cosine));
  int met = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    const float apart = cone.axis.x * all.x[s] + cone.axis.y * all.y[s] + cone.axis.z * all.z[s];
    const bool within = apart >= cone.cosine * all.cosine[s] - sine * all.sine[s] - kCosineSlack;
    met |= within & (furthest[s] > nearest);
  }
  return met;
}

}  // namespace deltalux::radiosity
