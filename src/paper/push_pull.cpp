#include "paper/push_pull.hpp"

#include "hierarchy/pull.hpp"

namespace deltalux::paper {

namespace {

/// Light from above each element: scalar below the input level, directional at clusters.
void push(hierarchy::Elements& elements) {
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
    hierarchy::ElementLight& light = elements.radiometry[i];
    light.direct = light.directGathered;
    light.indirect = light.indirectGathered;
    const bool input = t.depth == 0;
    source[i] = input ? elements.slot[t.parent.index()] : source[t.parent.index()];
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
  push(elements);
  return hierarchy::pull(elements);
}

}  // namespace deltalux::paper
