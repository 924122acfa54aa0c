#pragma once
// What tracing a block of paths yields, before it is put with the others.
#include <cstdint>
#include <vector>

#include "particles/particles.hpp"
#include "tracing/ray.hpp"

namespace deltalux {

/// What a block of paths made; vertices and impacts in the order in which they happened, then by path.
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

  /// Room for what so many paths usually make.
  void reserve(std::size_t paths) {
    vertexOf.reserve(3 * paths), vertices.reserve(3 * paths), met.reserve(3 * paths);
    impactOf.reserve(paths), primitive.reserve(paths), triangleAndSide.reserve(paths), uv.reserve(paths);
    throughput.reserve(paths);
  }
  void addVertex(std::uint32_t path, const Vec3f& p, PrimitiveId there) {
    vertexOf.push_back(path), vertices.push_back(p), met.push_back(there);
  }
  void addImpact(std::uint32_t path, const Hit& hit, const glm::vec2& at, const Rgb& flux) {
    impactOf.push_back(path);
    primitive.push_back(hit.primitive);
    triangleAndSide.push_back(2 * hit.triangle + (hit.front ? 0 : 1));
    uv.push_back(at);
    throughput.push_back(flux);
  }
};

/// Puts entries that belong to `of` in its order, keeping their own within.
template <class... Arrays>
std::vector<std::uint32_t> sortByPath(const std::vector<std::uint32_t>& of, std::size_t paths, Arrays&... arrays) {
  std::vector<std::uint32_t> counts(paths, 0), place(of.size());
  for (const std::uint32_t p : of) ++counts[p];
  std::vector<std::uint32_t> next(paths, 0);
  for (std::size_t p = 1; p < paths; ++p) next[p] = next[p - 1] + counts[p - 1];
  for (std::size_t i = 0; i < of.size(); ++i) place[i] = next[of[i]]++;
  const auto permute = [&](auto& array) {
    auto sorted = array;
    for (std::size_t i = 0; i < of.size(); ++i) sorted[place[i]] = array[i];
    array = std::move(sorted);
  };
  (permute(arrays), ...);
  return counts;
}

}  // namespace deltalux
