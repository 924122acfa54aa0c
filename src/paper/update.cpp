#include "paper/update.hpp"

#include "base/check.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"

namespace deltalux::paper {

LinkMarks leave(const Parts& x, std::span<const SceneChange::Moved> moved, std::span<const LightId> movedLights) {
  std::vector<PrimitiveId> primitives;
  SpaceChange before, after, all;
  for (const SceneChange::Moved& m : moved) {
    primitives.push_back(m.primitive);
    before.add(m.before), all.add(m.before);
  }
  for (const PrimitiveId id : primitives)
    if (const Box box = bounds(x.scene[id].shape); !box.empty()) after.add(box), all.add(box);
  std::vector<hierarchy::ElementId> inputs = hierarchy::elementsOf(x.elements, primitives);
  const std::vector<hierarchy::ElementId> lights = hierarchy::elementsOf(x.elements, movedLights);
  inputs.insert(inputs.end(), lights.begin(), lights.end());
  if (primitives.empty() && inputs.empty()) return {};
  all.addMoved(inputs, x.elements);
  all.findHidden(x.elements, x.scene);
  LinkMarks marks = LineSpace(x.links, x.elements, x.scene, all, before, after).visit();
  hierarchy::reshape(x.elements, x.scene, inputs);
  return marks;
}

void arrive(const Parts& x, LinkMarks& marks, const Newcomers& newcomers) {
  if (!newcomers.reactivated.empty()) {
    SpaceChange reactivated;
    reactivated.addMoved(newcomers.reactivated, x.elements);
    add(LineSpace(x.links, x.elements, x.scene, reactivated, {}, {}).visit(), marks);
  }
  if (!newcomers.inactive.empty()) {
    SpaceChange inactive;
    inactive.addMoved(newcomers.inactive, x.elements);
    const LinkMarks found = LineSpace(x.links, x.elements, x.scene, inactive, {}, {}).visit();
    marks.shifted = found.moved, marks.visited += found.visited;
  }
  if (!newcomers.root.valid()) return;
  const std::size_t known = x.links.roots.size();
  addRootLinks(x.links, x.elements, newcomers.root);
  marks.made.assign(x.links.roots.begin() + static_cast<std::ptrdiff_t>(known), x.links.roots.end());
}

RefineReport follow(const Parts& x, LinkMarks& marks, const OracleSettings& settings, IrradianceLists& lists) {
  lists.remove(x.elements, x.links, marks);
  const RefineReport refined = evaluateAgain(x.links, x.elements, x.scene, x.tracer, settings, marks,
                                             [&](hierarchy::LinkId id) { lists.removeBelow(x.elements, x.links, id); });
  lists.add(x.elements, x.links);
  DELTALUX_VALIDATED(validate(x.links, x.elements));
  return refined;
}

}  // namespace deltalux::paper
