#pragma once
// What tracing a block of paths yields, before it is put with the others.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/particles.hpp"
#include "tracing/ray.hpp"

namespace deltalux::particles {

/// What a block of paths made; vertices and deposits in the order in which they happened.
struct PathBlock {
  static constexpr std::size_t kPaths = 512;  // of all blocks but the last [task]

  struct Vertex {
    std::uint32_t path;  // within the block
    Vec3f position;
    PrimitiveId met;
  };
  struct Deposit {
    std::uint32_t path;
    PrimitiveId primitive;
    std::uint32_t triangleAndSide;
    glm::vec2 uv;
    Rgb throughput;
  };
  /// An account that is still open.
  struct Account {
    Rgb entered{0.0f}, passed{0.0f}, absorbed{0.0f}, left{0.0f};
  };
  std::vector<Vertex> vertices;
  std::vector<Deposit> deposits;
  // Per path.
  std::vector<std::uint32_t> vertexCount, depositCount;
  std::vector<Account> accounts;
  std::vector<std::uint8_t> termination;
  std::uint64_t rays = 0;

  /// Empty again, for so many paths; what was allocated stays.
  void begin(std::size_t paths) {
    constexpr std::size_t kUsual = 3;  // vertices of a path [task]
    vertices.clear(), vertices.reserve(kUsual * paths);
    deposits.clear(), deposits.reserve(paths);
    vertexCount.assign(paths, 0), depositCount.assign(paths, 0);
    accounts.assign(paths, {}), termination.assign(paths, 0);
    rays = 0;
  }
  void addVertex(std::uint32_t path, const Vec3f& p, PrimitiveId there) {
    vertices.push_back({path, p, there});
    ++vertexCount[path];
  }
  void addDeposit(std::uint32_t path, const tracing::Hit& hit, const glm::vec2& at, const Rgb& flux) {
    deposits.push_back({path, hit.primitive, 2 * hit.triangle + (hit.front ? 0 : 1), at, flux});
    ++depositCount[path];
  }
};

/// Puts what blocks made of the paths from `begin` on (of `only`, or of all) behind what there is, by path.
void append(std::span<const PathBlock>, std::size_t begin, std::span<const std::uint32_t> only, Particles&);

}  // namespace deltalux::particles
