#pragma once
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// visit(element) of `top` and of all that is below those where it returns true, each after its parent.
template <class Visit>
void forEachBelow(const Elements& elements, ElementId top, const Visit& visit) {
  std::vector<ElementId> stack{top};
  while (!stack.empty()) {
    const ElementId e = stack.back();
    stack.pop_back();
    if (!visit(e)) continue;
    for (std::size_t i = 0; i < elements.at(e).childCount; ++i) stack.push_back(elements.child(e, i));
  }
}

/// visit(leaf) of all leaves at or below `top`.
template <class Visit>
void forEachLeafBelow(const Elements& elements, ElementId top, const Visit& visit) {
  forEachBelow(elements, top, [&](ElementId e) {
    if (elements.isLeaf(e)) visit(e);
    return true;
  });
}

}  // namespace deltalux::hierarchy
