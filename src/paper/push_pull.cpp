#include "paper/push_pull.hpp"

#include "hierarchy/pull.hpp"

namespace deltalux::paper {

namespace {

/// Light from above each element where `marked(index)`: scalar below the input level, directional at clusters.
template <class Marked>
void push(hierarchy::Elements& elements, const Marked& marked) {
  std::vector<hierarchy::DirectionalRgb> direct(elements.clusters.size()), indirect(elements.clusters.size());
  std::vector<std::uint32_t> source(elements.size(), Id<void>::kNone);  // slot of the cluster above a patch
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementTopology& t = elements.topology[i];
    if (t.emitter) continue;
    if (t.kind == hierarchy::ElementKind::Cluster) {
      const std::uint32_t slot = elements.slot[i];
      const hierarchy::ClusterLight& own = elements.clusters[slot];
      direct[slot] = own.directGathered;
      indirect[slot] = own.indirectGathered;
      if (t.parent.valid()) {
        direct[slot] += direct[elements.slot[t.parent.index()]];
        indirect[slot] += indirect[elements.slot[t.parent.index()]];
      }
      continue;
    }
    const bool input = t.depth == 0;
    source[i] = input ? elements.slot[t.parent.index()] : source[t.parent.index()];
    if (!marked(i)) continue;
    hierarchy::ElementLight& light = elements.radiometry[i];
    light.direct = light.directGathered;
    light.indirect = light.indirectGathered;
    if (!input) {
      light.direct += elements.radiometry[t.parent.index()].direct;
      light.indirect += elements.radiometry[t.parent.index()].indirect;
    }
    // A flat surface takes its clusters' light once, a curved one where its orientation is known best: at the leaves.
    if (t.flat ? input : t.childCount == 0) {
      light.direct += direct[source[i]].mean(elements.moments[i]);
      light.indirect += indirect[source[i]].mean(elements.moments[i]);
    }
  }
}

}  // namespace

RgbSum pushPull(hierarchy::Elements& elements) {
  push(elements, [](std::size_t) { return true; });
  return hierarchy::pull(elements);
}

RgbSum pushPull(hierarchy::Elements& elements, std::vector<char>& marked) {
  const auto parentOf = [&](std::size_t i) { return elements.topology[i].parent; };
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (parentOf(i).valid() && marked[parentOf(i).index()]) marked[i] = 1;
  for (std::size_t i = marked.size(); i-- > 0;)
    if (marked[i] && parentOf(i).valid()) marked[parentOf(i).index()] = 1;
  push(elements, [&](std::size_t i) { return marked[i] != 0; });
  return hierarchy::pull(elements, marked);
}

}  // namespace deltalux::paper
