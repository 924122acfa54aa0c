#include "direct/lamp_tree.hpp"

#include <algorithm>
#include <bit>

#include "base/box_tree.hpp"
#include "direct/tuning.hpp"

namespace deltalux::direct {

namespace {

constexpr double kWidened = 1 + 1e-5;  // [rounding]

Vec3f centerOf(const Lamp& lamp) { return 0.5f * (lamp.lower + lamp.upper); }

/// Order along an axis, the same for any order before.
void sortAlong(int axis, std::span<std::uint32_t> which, std::span<const Lamp> lamps) {
  std::sort(which.begin(), which.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float x = centerOf(lamps[a])[axis], y = centerOf(lamps[b])[axis];
    return x < y || (x == y && a < b);
  });
}

double squaredDiagonal(const BoxF& box) {
  const Vec3f d = box.upper - box.lower;
  return glm::dot(d, d);
}

}  // namespace

LampTree::LampTree(std::span<const Lamp> lamps, std::vector<std::uint32_t> which) {
  if (!which.empty()) build(which, lamps);
}

/// Sorts them so that those before the number returned and the others are far apart and small.
std::size_t LampTree::splitAt(std::span<std::uint32_t> which, std::span<const Lamp> lamps) const {
  struct Split {
    double cost = kInfinity;
    int axis = 0;
    std::size_t at = 0;
  } best;
  std::vector<double> above(which.size());
  for (int axis = 0; axis < 3; ++axis) {
    sortAlong(axis, which, lamps);
    const auto sweep = [&](std::size_t count, const auto& lampAt, const auto& cost) {
      BoxF box;
      double most = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Lamp& lamp = lamps[lampAt(i)];
        box.extend(lamp.lower), box.extend(lamp.upper), most += lamp.most;
        cost(i, most * squaredDiagonal(box));
      }
    };
    const std::size_t n = which.size();
    sweep(
        n, [&](std::size_t i) { return which[n - 1 - i]; },
        [&](std::size_t i, double cost) { above[n - 1 - i] = cost; });
    sweep(
        n - 1, [&](std::size_t i) { return which[i]; },
        [&](std::size_t i, double cost) {
          if (cost + above[i + 1] < best.cost) best = {cost + above[i + 1], axis, i + 1};
        });
  }
  sortAlong(best.axis, which, lamps);
  return best.at > 0 ? best.at : which.size() / 2;
}

void LampTree::build(std::span<std::uint32_t> which, std::span<const Lamp> lamps) {
  const std::size_t at = nodes_.size();
  Node node;
  BoxF box;
  node.smallest = std::numeric_limits<float>::infinity();
  for (const std::uint32_t i : which) {
    const Lamp& lamp = lamps[i];
    box.extend(lamp.lower), box.extend(lamp.upper), node.most += lamp.most;
    node.lamps |= lampBits(lamp.id);
    node.smallest = std::min(node.smallest, 0.5f * glm::length(lamp.upper - lamp.lower));
    node.sphere.cone = i == which.front() ? lamp.cone : joined(node.sphere.cone, lamp.cone);
  }
  node.sphere.center = 0.5f * (box.lower + box.upper), node.sphere.half = 0.5f * (box.upper - box.lower);
  node.sphere.radius = glm::length(node.sphere.half) * static_cast<float>(kWidened);
  if (which.size() == 1) {
    node.lamp = static_cast<std::uint32_t>(lamps_.size());
    lamps_.push_back(lamps[which.front()]), index_.push_back(which.front());
    nodes_.push_back(node);
    return;
  }
  nodes_.push_back(node);
  const std::size_t first = splitAt(which, lamps);
  build(which.first(first), lamps);
  nodes_[at].second = static_cast<std::uint32_t>(nodes_.size());
  build(which.subspan(first), lamps);
}

double LampTree::bound(std::uint32_t node, const hierarchy::ElementGeometry& g) const {
  const Node& n = nodes_[node];
  if (n.second == 0) return potential(lamps_[n.lamp], g);
  const float cosine = greatestCosine(n.sphere, g);
  if (!(cosine > 0)) return 0;
  const Vec3f beyond = glm::max(glm::abs(g.center - n.sphere.center) - n.sphere.half, Vec3f(0.0f));
  const double nearest = std::max<double>(glm::length(beyond) - g.radius, 0.5f * (g.radius + n.smallest));
  return kWidened * n.most * cosine / std::max(nearest * nearest, 1e-30);
}

void LampTree::cut(const hierarchy::ElementGeometry& g, double share, std::size_t most, std::uint64_t seen,
                   Cut& out) const {
  out.clear();
  if (nodes_.empty()) return;
  const auto less = [](const Branch& a, const Branch& b) {
    return a.rank < b.rank || (a.rank == b.rank && a.node > b.node);
  };
  const auto maySee = [&](const Node& n) {
    return n.second == 0 ? (n.lamps & ~seen) == 0 : std::popcount(n.lamps & seen) > 1;
  };
  std::vector<Branch>& open = out.rest;  // a heap
  const auto add = [&](std::uint32_t node, double atMost) {
    const double bounded = std::min(bound(node, g), atMost);
    if (!(bounded > 0)) return;
    open.push_back({node, bounded, bounded * (maySee(nodes_[node]) ? share / tuning::kMatters : 1.0)});
    out.restMost += bounded;
    std::push_heap(open.begin(), open.end(), less);
  };
  add(0, kInfinity);
  double asked = 0;
  while (!open.empty() && out.lamps.size() < most && open.front().rank > share * (asked + out.restMost)) {
    std::pop_heap(open.begin(), open.end(), less);
    const Branch branch = open.back();
    open.pop_back();
    out.restMost -= branch.most;
    const Node& n = nodes_[branch.node];
    if (n.second == 0) {
      asked += branch.most;
      out.lamps.push_back({index_[n.lamp], branch.most});
    } else {
      add(branch.node + 1, branch.most), add(n.second, branch.most);
    }
  }
  out.restMost = 0;  // what differences have left is not it
  for (const Branch& b : open) out.restMost += b.most;
}

std::optional<LampTree::Drawn> LampTree::draw(const Cut& cut, const hierarchy::ElementGeometry& g, double u) const {
  double left = u * cut.restMost, chance = 1 / cut.restMost;
  std::size_t i = 0;
  while (i + 1 < cut.rest.size() && left >= cut.rest[i].most) left -= cut.rest[i++].most;
  std::uint32_t node = cut.rest[i].node;
  chance *= cut.rest[i].most, u = std::clamp(left / cut.rest[i].most, 0.0, 1.0);
  while (nodes_[node].second != 0) {  // [CK18 (traversal)]
    const std::uint32_t second = nodes_[node].second;
    const double a = bound(node + 1, g), b = bound(second, g);
    if (!(a + b > 0)) return std::nullopt;
    const double share = a / (a + b);
    if (u < share || !(b > 0))
      node = node + 1, chance *= share, u /= share;
    else
      node = second, chance *= 1 - share, u = (u - share) / (1 - share);
  }
  return Drawn{index_[nodes_[node].lamp], chance};
}

}  // namespace deltalux::direct
