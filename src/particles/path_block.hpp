#pragma once
// What tracing a block of paths yields, before it is put with the others.
#include <cstdint>
#include <vector>

#include "particles/particles.hpp"
#include "tracing/ray.hpp"

namespace deltalux {

/// What a block of paths made; vertices and impacts in the order in which they happened.
struct PathBlock {
  std::vector<std::uint32_t> vertexOf, impactOf;  // path within the block
  std::vector<Vec3f> vertices;
  std::vector<PrimitiveId> met;
  std::vector<PrimitiveId> primitive;
  std::vector<std::uint32_t> triangleAndSide;
  std::vector<glm::vec2> uv;
  std::vector<Rgb> throughput;
  /// An account that is still open.
  struct Account {
    Rgb entered{0.0f}, passed{0.0f}, absorbed{0.0f}, left{0.0f};
  };
  // Per path.
  std::vector<std::uint32_t> vertexCount, impactCount;
  std::vector<Account> accounts;
  std::vector<std::uint8_t> fate;
  std::uint64_t rays = 0;

  /// Empty again, for so many paths; what was allocated stays.
  void begin(std::size_t paths) {
    vertexOf.clear(), vertices.clear(), met.clear();
    impactOf.clear(), primitive.clear(), triangleAndSide.clear(), uv.clear(), throughput.clear();
    vertexCount.assign(paths, 0), impactCount.assign(paths, 0);
    accounts.assign(paths, {}), fate.assign(paths, 0);
    rays = 0;
    constexpr std::size_t kUsual = 3;  // vertices of a path
    vertexOf.reserve(kUsual * paths), vertices.reserve(kUsual * paths), met.reserve(kUsual * paths);
    impactOf.reserve(paths), primitive.reserve(paths), triangleAndSide.reserve(paths), uv.reserve(paths);
    throughput.reserve(paths);
  }
  void addVertex(std::uint32_t path, const Vec3f& p, PrimitiveId there) {
    vertexOf.push_back(path), vertices.push_back(p), met.push_back(there);
    ++vertexCount[path];
  }
  void addImpact(std::uint32_t path, const Hit& hit, const glm::vec2& at, const Rgb& flux) {
    impactOf.push_back(path);
    primitive.push_back(hit.primitive);
    triangleAndSide.push_back(2 * hit.triangle + (hit.front ? 0 : 1));
    uv.push_back(at);
    throughput.push_back(flux);
    ++impactCount[path];
  }
};

}  // namespace deltalux
