#pragma once
// Ways up and down the tree of links: which arrive at a leaf below one that has been split, and which stands for the
// whole of a light that has been.
#include <vector>

#include "hierarchy/link.hpp"

namespace deltalux::paper {

/// Whether `leaf` is `e` or below it.
inline bool holds(const hierarchy::Elements& elements, hierarchy::ElementId e, hierarchy::ElementId leaf) {
  while (leaf.valid() && leaf != e) leaf = elements.at(leaf).parent;
  return leaf.valid();
}

/// Appends the links at `link` or below it that are not split and arrive at the leaf or above it.
inline void activeBelow(const hierarchy::Links& links, const hierarchy::Elements& elements, hierarchy::LinkId link,
                        hierarchy::ElementId leaf, std::vector<hierarchy::LinkId>& out) {
  const hierarchy::Link& l = links[link];
  if (l.state != hierarchy::LinkState::Interior) {
    out.push_back(link);
    return;
  }
  for (std::size_t i = 0; i < l.childCount; ++i) {
    const hierarchy::LinkId child = links.child(link, i);
    if (holds(elements, links[child].receiver, leaf)) activeBelow(links, elements, child, leaf, out);
  }
}

/// Whether a light's patch is part of a curved one.
inline bool isPartOfCurved(const hierarchy::Elements& elements, hierarchy::ElementId sender) {
  const hierarchy::ElementTopology& t = elements.at(sender);
  return t.kind == hierarchy::ElementKind::Patch && !t.flat && t.depth > 0;
}

/// The link at `link` or above it whose sender is the whole curved light that `link` takes a part of; else `link`.
inline hierarchy::LinkId toWholeLight(const hierarchy::Links& links, const hierarchy::Elements& elements,
                                      hierarchy::LinkId link) {
  while (isPartOfCurved(elements, links[link].sender)) link = links[link].parent;
  return link;
}

}  // namespace deltalux::paper
