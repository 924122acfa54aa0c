#include "paper/update.hpp"

#include "base/check.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"

namespace deltalux::paper {

Motion leave(const Parts& x, std::span<const SceneChange::Moved> moved, std::span<const LightId> movedLights,
             const OracleSettings& settings) {
  Motion motion;
  std::vector<PrimitiveId> primitives;
  SpaceChange before, after;
  for (const SceneChange::Moved& m : moved) {
    primitives.push_back(m.primitive);
    before.add(m.before), motion.all.add(m.before);
    motion.all.addMoved(m.primitive, x.scene);
  }
  for (const PrimitiveId id : primitives)
    if (const Box box = bounds(x.scene[id].shape); !box.empty()) after.add(box), motion.all.add(box);
  motion.inputs = hierarchy::elementsOf(x.elements, primitives);
  const std::vector<hierarchy::ElementId> lights = hierarchy::elementsOf(x.elements, movedLights);
  motion.inputs.insert(motion.inputs.end(), lights.begin(), lights.end());
  motion.all.addMoved(motion.inputs, x.elements, x.scene);
  if (primitives.empty() && motion.inputs.empty()) return motion;
  motion.all.findHidden(x.elements, x.scene);
  motion.marks = LineSpace(x.links, x.elements, x.scene, motion.all, before, after, settings.trusted).visit();
  hierarchy::reshape(x.elements, x.scene, motion.inputs);
  return motion;
}

void arrive(const Parts& x, Motion& motion, const Newcomers& newcomers, const OracleSettings& settings) {
  if (motion.marks.changes.empty() || !newcomers.woken.empty()) {
    SpaceChange woken;
    woken.addMoved(newcomers.woken, x.elements, x.scene);
    add(LineSpace(x.links, x.elements, x.scene, woken, {}, {}, settings.trusted).visit(), motion.marks);
    motion.inputs.insert(motion.inputs.end(), newcomers.woken.begin(), newcomers.woken.end());
    motion.all.addMoved(motion.inputs, x.elements, x.scene);
  }
  if (newcomers.root.valid()) addRootLinks(x.links, x.elements, newcomers.root);
}

RefineReport follow(const Parts& x, Motion& motion, const OracleSettings& settings,
                    std::vector<hierarchy::LinkId>& changed) {
  const RefineReport refined = rejudge(x.links, x.elements, x.scene, x.tracer, settings, motion.marks, changed);
  DELTALUX_VALIDATED(validate(x.links, x.elements));
  return refined;
}

}  // namespace deltalux::paper
