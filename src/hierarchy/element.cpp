#include "hierarchy/element.hpp"

#include <numeric>

#include "hierarchy/below.hpp"

namespace deltalux::hierarchy {

ElementId Elements::addChildren(ElementId parent, ElementKind kind, std::size_t count) {
  const std::size_t first = size();
  const std::size_t total = first + count;
  topology.resize(total);
  geometry.resize(total);
  nodes.resize(total);
  domain.resize(total);
  moments.resize(total);
  light.resize(total);
  radiometry.resize(total);
  slot.resize(total, Id<void>::kNone);
  key.resize(total);
  for (std::size_t i = first; i < total; ++i) {
    topology[i].parent = parent;
    topology[i].kind = kind;
    if (kind == ElementKind::Cluster) {
      slot[i] = static_cast<std::uint32_t>(clusters.size());
      clusters.emplace_back();
    } else if (!parent.valid()) {
      inputs.emplace_back(i);
    }
  }
  if (parent.valid()) {
    topology[parent.index()].firstChild = ElementId(first);
    topology[parent.index()].childCount = static_cast<std::uint16_t>(count);
  }
  return ElementId(first);
}

std::vector<ElementId> Elements::sceneRoots() const {
  std::vector<ElementId> roots = grown;
  if (sceneRoot.valid()) roots.insert(roots.begin(), sceneRoot);
  return roots;
}

void Elements::listInputs() {
  inputs.clear();
  for (std::size_t i = 0; i < size(); ++i)
    if (const ElementId e(i); topology[i].depth == 0 && !isCluster(e)) inputs.push_back(e);
  sides = {};
  listSides(0);
}

void Elements::listSides(std::size_t firstInput) {
  for (std::size_t i = firstInput; i < inputs.size(); ++i) {
    const ElementId e = inputs[i];
    if (!isPatch(e) || at(e).emitter) continue;
    forEachBelow(*this, e, [&](ElementId patch) {
      const bool all = hasFaces(patch), lowest = !all || isLeaf(patch);
      if (lowest) holdSides(patch);
      return all;
    });
  }
}

void Elements::holdSides(ElementId patch) {
  Side side = sideOf(patch);
  if (!hasFaces(patch)) {
    sides.add(side) = patch;
    return;
  }
  const FaceOrder& order = orderOf(patch);
  side.triangle = order.faces() - 1;
  sides.add(side);  // room for all at once
  const FaceRange range = facesOf(patch);
  for (std::uint32_t i = 0; i < range.count; ++i) {
    side.triangle = order.faceAt(range.first + i);
    sides.add(side) = patch;
  }
}

std::size_t Elements::memoryBytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(topology) + bytes(geometry) + bytes(nodes) + bytes(domain) + bytes(moments) + bytes(light) +
         bytes(radiometry) + bytes(slot) + bytes(clusters) + bytes(key) + bytes(outlines) + bytes(frames) +
         bytes(inputs) + sides.memoryBytes() + contacts.memoryBytes() +
         std::transform_reduce(faceOrders.begin(), faceOrders.end(), std::size_t(0), std::plus<>(),
                               [](const FaceOrder& o) { return o.memoryBytes(); });
}

}  // namespace deltalux::hierarchy
