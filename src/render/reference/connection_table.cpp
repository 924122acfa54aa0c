#include "render/reference/connection_table.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"

namespace deltalux::rendering {

namespace {

template <class Facings>
void addSeenFrom(const Vec3& direction, double value, Facings& facings) {
  for (int f = 0; f < 6; ++f) {
    const double cosine = f % 2 == 0 ? direction[f / 2] : -direction[f / 2];
    facings[f] += static_cast<float>(value * std::max(cosine + deltalux::tuning::kDefensive, 0.0));
  }
}

template <class Facings>
void lookAt(const ReferenceScene& scene, const LightConnections& connections, int connection, const Vec3& x,
            const Vec2& u, Facings& facings) {
  const Arrivals arrivals = connections.sample(connection, x, Vec3(0), u);
  for (int i = 0; i < arrivals.count; ++i) {
    const Arrival& a = arrivals.list[i];
    Rgb T(1.0f);
    for (int l = 0; l < a.legCount && !isBlack(T); ++l) T *= scene.rays().transmittance(a.legs[l]);
    addSeenFrom(a.direction, gray(a.value) * deltalux::tuning::kDefensive + gray(a.value * T), facings);
  }
}

}  // namespace

ConnectionTable::ConnectionTable(const ReferenceScene& scene, const LightConnections& connections, double budget)
    : connections_(connections.list().size()) {
  if (connections_ < 2) return;
  const Box box = bounds(scene.scene());
  if (!box.empty() && box.diagonal() > 0.0) {
    const double cells = std::max(budget / (deltalux::tuning::kPilots * static_cast<double>(connections_)), 1.0);
    const Vec3 extent = glm::max(box.extent(), Vec3(1e-3 * box.diagonal()));
    const double edge = std::cbrt(extent.x * extent.y * extent.z / cells);
    for (int i = 0; i < 3; ++i) resolution_[i] = std::clamp(static_cast<int>(extent[i] / edge), 1, 64);
    origin_ = box.lower;
    cellSize_ = extent / Vec3(resolution_);
  }
  const std::size_t cells = static_cast<std::size_t>(resolution_.x) * resolution_.y * resolution_.z;
  std::vector<std::vector<Facings>> learned(cells);
  parallelFor(cells, 8, [&](std::size_t cell) { learned[cell] = learn(scene, connections, cell); });
  smooth(learned);
}

std::size_t ConnectionTable::cellOf(const Vec3& position) const {
  const Vec3 relative = (position - origin_) / cellSize_;
  std::size_t cell = 0;
  for (int i = 2; i >= 0; --i) {
    const int at = static_cast<int>(std::clamp(relative[i], 0.0, resolution_[i] - 1.0));
    cell = cell * resolution_[i] + at;
  }
  return cell;
}

std::size_t ConnectionTable::rowOf(const Vec3& position, const Vec3& normal) const {
  const Vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return (cellOf(position) * 6 + 2 * axis + (normal[axis] < 0.0 ? 1 : 0)) * connections_;
}

std::vector<ConnectionTable::Facings> ConnectionTable::learn(const ReferenceScene& scene,
                                                             const LightConnections& connections,
                                                             std::size_t cell) const {
  const Vec3 corner(cell % resolution_.x, cell / resolution_.x % resolution_.y, cell / resolution_.x / resolution_.y);
  const Vec3 center = origin_ + (corner + 0.5) * cellSize_;
  std::vector<Facings> weights(connections_, Facings{});
  for (std::size_t c = 0; c < connections_; ++c) {
    const Connection& connection = connections.list()[c];
    if (connection.chain.curved() >= 0) {
      // Test samples would miss the caustic's bright lines: take the flux as if it left the bend evenly.
      const Box mirror = bounds(scene.scene()[connection.chain.bends[0].surface].shape);
      const Vec3 d = mirror.center() - center, outside = glm::max(Vec3(0), glm::abs(d) - 0.5 * mirror.extent());
      const double reach = 0.25 * (mirror.diagonal() + glm::length(cellSize_));
      const double distance = std::max(glm::length(outside), reach);
      const Vec3 direction = glm::length(d) > reach ? glm::normalize(d) : Vec3(0);
      addSeenFrom(direction,
                  connection.flux / (4 * kPi * distance * distance) /
                      (direction == Vec3(0) ? deltalux::tuning::kDefensive : 1.0),
                  weights[c]);
      continue;
    }
    Rng rng(cell, c);
    for (int i = 0; i < deltalux::tuning::kPilots; ++i) {
      const Vec3 x = origin_ + (corner + Vec3(rng.uniform(), rng.uniform(), rng.uniform())) * cellSize_;
      const Vec2 u(rng.uniform(), rng.uniform());
      lookAt(scene, connections, static_cast<int>(c), x, u, weights[c]);
    }
    for (float& w : weights[c]) w /= deltalux::tuning::kPilots;
  }
  return weights;
}

void ConnectionTable::smooth(const std::vector<std::vector<Facings>>& learned) {
  cumulative_.resize(learned.size() * 6 * connections_);
  parallelFor(learned.size(), 64, [&](std::size_t cell) {
    const glm::ivec3 at(cell % resolution_.x, cell / resolution_.x % resolution_.y,
                        cell / resolution_.x / resolution_.y);
    std::vector<std::array<double, 6>> sum(connections_, std::array<double, 6>{});
    for (int k = 0; k < 27; ++k) {
      const glm::ivec3 n = at + glm::ivec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (glm::any(glm::lessThan(n, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(n, resolution_))) continue;
      const double weight = k == 13 ? 8.0 : 1.0;
      const auto& other = learned[(static_cast<std::size_t>(n.z) * resolution_.y + n.y) * resolution_.x + n.x];
      for (std::size_t c = 0; c < connections_; ++c) {
        for (int f = 0; f < 6; ++f) sum[c][f] += weight * other[c][f];
      }
    }
    for (int f = 0; f < 6; ++f) {
      float* row = &cumulative_[(cell * 6 + f) * connections_];
      double total = 0, running = 0;
      for (const auto& s : sum) total += s[f];
      const double even = 1.0 / static_cast<double>(connections_);
      for (std::size_t c = 0; c < connections_; ++c) {
        running += total > 0
                       ? deltalux::tuning::kDefensive * even + (1 - deltalux::tuning::kDefensive) * sum[c][f] / total
                       : even;
        row[c] = static_cast<float>(running);
      }
      row[connections_ - 1] = 1.0f;
    }
  });
}

ConnectionTable::Choice ConnectionTable::choose(const Vec3& position, const Vec3& normal, double u) const {
  if (connections_ < 2) return {static_cast<int>(connections_) - 1, 1.0};
  const float* row = &cumulative_[rowOf(position, normal)];
  const float* it = std::upper_bound(row, row + connections_ - 1, static_cast<float>(u));
  const double below = it == row ? 0.0 : *(it - 1);
  return {static_cast<int>(it - row), *it - below};
}

double ConnectionTable::chance(const Vec3& position, const Vec3& normal, int connection) const {
  if (connections_ < 2) return 1.0;
  const float* row = &cumulative_[rowOf(position, normal)];
  return row[connection] - (connection > 0 ? static_cast<double>(row[connection - 1]) : 0.0);
}

}  // namespace deltalux::rendering
