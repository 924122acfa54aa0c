#include <cmath>
#include <stdexcept>
#include <string>

#include "hierarchy/patch.hpp"

namespace deltalux::hierarchy {

namespace {

void require(bool holds, ElementId e, const char* what) {
  if (!holds) throw std::logic_error("element " + std::to_string(e.value) + ": " + what);
}

bool near(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * (std::abs(a) + std::abs(b) + 1e-12);
}

}  // namespace

void validate(const Elements& elements) {
  std::vector<char> reached(elements.size(), 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementId e(i);
    const ElementTopology& t = elements.at(e);
    if (t.kind == ElementKind::Away) continue;
    const ElementGeometry& g = elements.shape(e);
    require(std::isfinite(g.area) && g.area >= 0, e, "area is finite and not negative");
    require(t.kind == ElementKind::Cluster || t.childCount <= 4, e, "a patch has at most four children");
    if (t.kind == ElementKind::Patch) {
      const ElementNodes& n = elements.nodes[i];
      require(near(n.weight[0] + n.weight[1] + n.weight[2] + n.weight[3], 1.0, 1e-3), e, "node weights sum to one");
      require(near(glm::length(g.normal), 1.0, 1e-3) || !t.flat, e, "a flat patch has a unit normal");
    }
    double area = 0;
    for (std::size_t c = 0; c < t.childCount; ++c) {
      const ElementId child = elements.child(e, c);
      require(child.index() > i && child.index() < elements.size(), e, "children stand behind their parent");
      require(elements.at(child).parent == e, child, "its parent knows it");
      require(!reached[child.index()], child, "it has one parent");
      reached[child.index()] = 1;
      const ElementGeometry& k = elements.shape(child);
      if (!elements.at(child).blocker || t.kind != ElementKind::Cluster) area += k.area;
      if (t.kind == ElementKind::Distant) continue;
      const float slack = 1e-4f * (1.0f + glm::length(g.upper - g.lower) + glm::length(g.center));
      if (t.kind == ElementKind::Cluster || t.flat)
        require(glm::all(glm::greaterThanEqual(k.lower, g.lower - slack)) &&
                    glm::all(glm::lessThanEqual(k.upper, g.upper + slack)),
                child, "its parent's box holds it");
    }
    if (t.childCount > 0) require(near(area, g.area, 2e-3), e, "child areas sum to the parent's");
    if (elements.isInputLevel(e) && !t.emitter)
      require(surfaceOf(elements, elements.sides.at(elements.sideOf(e))) == e, e, "its side knows it");
  }
}

}  // namespace deltalux::hierarchy
