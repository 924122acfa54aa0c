#include "engine/growth.hpp"

#include <algorithm>

#include "hierarchy/below.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/pull.hpp"
#include "paper/covered_sides.hpp"
#include "particles/reached_sides.hpp"

namespace deltalux::engine {

namespace {

/// Where light may have got to that did not before: where things were, and around lights that moved.
std::vector<Box> newlyLit(const SceneUpdate& edits, const Scene& scene) {
  std::vector<Box> boxes;
  for (const SceneChange::Moved& m : edits.moved) boxes.push_back(m.before);
  for (const LightId light : edits.movedLights)
    std::visit(
        [&](const auto& emitter) {
          if constexpr (requires { emitter.position; }) boxes.push_back({emitter.position, emitter.position});
        },
        scene[light].emitter);
  return boxes;
}

void addDeposit(std::vector<hierarchy::SurfaceSide>& sides, const Solution& s,
                const particles::ParticleUpdate& update) {
  std::vector<std::uint32_t> paths(update.all ? s.particles.paths() : update.paths.size());
  for (std::uint32_t i = 0; i < paths.size(); ++i) paths[i] = update.all ? i : update.paths[i].path;
  if (paths.empty()) return;
  particles::addReachedSides(sides, s.particles, paths, s.scene, *s.tracer,
                             [&](PrimitiveId primitive, std::uint32_t triangle, bool front) {
                               return s.elements.side(primitive, triangle, front).valid();
                             });
}

}  // namespace

std::vector<hierarchy::ElementId> leavesBelow(const hierarchy::Elements& elements, const Growth& growth) {
  std::vector<hierarchy::ElementId> tops = growth.reactivated, leaves;
  tops.insert(tops.end(), growth.inactive.begin(), growth.inactive.end());
  if (growth.root.valid()) tops.push_back(growth.root);
  for (const hierarchy::ElementId top : tops)
    hierarchy::forEachLeafBelow(elements, top, [&](hierarchy::ElementId leaf) { leaves.push_back(leaf); });
  return leaves;
}

Growth growInLight(Solution& s, const SceneUpdate& edits, const particles::ParticleUpdate& particles) {
  paper::CoveredSides sides;
  if (!edits.moved.empty() || !edits.movedLights.empty()) {
    sides = paper::coveredSides(s.scene, *s.tracer, s.elements, edits.primitives(), newlyLit(edits, s.scene));
  }
  addDeposit(sides.uncovered, s, particles);
  particles::dropReachedSides(sides.covered, s.particles);
  Growth growth;
  std::vector<hierarchy::SurfaceSide> fresh;
  const std::vector<hierarchy::ElementId> known = hierarchy::elementsOf(s.elements, sides.uncovered);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i].valid())
      fresh.push_back(sides.uncovered[i]);
    else if (std::binary_search(s.elements.inactive.begin(), s.elements.inactive.end(), known[i]))
      growth.reactivated.push_back(known[i]);
  }
  growth.inactive = hierarchy::elementsOf(s.elements, sides.covered);
  if (!growth.inactive.empty()) hierarchy::setInactive(s.elements, s.scene, growth.inactive, true);
  if (!growth.reactivated.empty()) hierarchy::setInactive(s.elements, s.scene, growth.reactivated, false);
  if (!fresh.empty()) growth.root = hierarchy::growElements(s.elements, s.scene, fresh);
  if (!growth.empty()) hierarchy::pull(s.elements);
  return growth;
}

}  // namespace deltalux::engine
