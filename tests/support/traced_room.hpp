#pragma once
// A room of things that can be moved one by one, and lines over a mesh of it: before a change and after it.
#include <unordered_map>

#include "change/known_samples.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "support/rooms.hpp"

namespace deltalux::test {

/// Open to the sky on one side. Things: a box, a mirror, a pane, a rug, a block of rough metal, a ball of glass.
struct RoomOfThings {
  static constexpr int kThings = 6;

  /// Thing `moved` stands elsewhere by `by`; none does where there is no such thing.
  explicit RoomOfThings(int moved = kThings, const Vec3& by = Vec3(0)) {
    const MaterialId white = addMaterial(scene, "white", lambert(0.6f)),
                     wood = addMaterial(scene, "wood", lambert(0.4f));
    const MaterialId silver = addMaterial(scene, "silver", Mirror{Rgb(0.85f)});
    const MaterialId pane = addMaterial(scene, "pane", ThinGlass{Rgb(0.9f), 1.52f});
    const MaterialId metal =
        addMaterial(scene, "metal", Opaque{Rgb(0.2f), {}, {Rgb(0.5f), 0.2f, SpecularLobe::Distribution::Ggx}});
    const MaterialId glass = addMaterial(scene, "glass", Dielectric{Rgb(0.95f), 1.5f});
    addBox(scene, white, Vec3(0), {3, 4, 2.5}, true);
    scene.primitives.pop_back();
    const auto at = [&](int thing) {
      first[static_cast<std::size_t>(thing)] = scene.primitives.size();
      return thing == moved ? by : Vec3(0);
    };
    Vec3 o = at(0);
    addBox(scene, wood, o + Vec3(2, 0.4, 0), o + Vec3(2.5, 0.9, 0.5), false);
    o = at(1);
    addPolygon(scene, silver,
               {o + Vec3(0.1, 1, 0.5), o + Vec3(0.1, 2, 0.5), o + Vec3(0.1, 2, 1.5), o + Vec3(0.1, 1, 1.5)});
    o = at(2);
    addPolygon(scene, pane, {o + Vec3(1, 3, 0), o + Vec3(2, 3, 0), o + Vec3(2, 3, 2), o + Vec3(1, 3, 2)});
    o = at(3);
    addBox(scene, wood, o + Vec3(0.6, 0.5, 4e-6), o + Vec3(1.6, 1.5, 0.01), false);  // so near that it covers the floor
    o = at(4);
    addBox(scene, metal, o + Vec3(2.2, 2, 0), o + Vec3(2.6, 2.4, 0.8), false);
    o = at(5);
    addShape(scene, glass, Sphere{o + Vec3(1.4, 2, 0.5), 0.25, false});
    first[kThings] = scene.primitives.size();
  }

  Scene scene;
  std::array<std::size_t, kThings + 1> first;  // primitives by thing
};

/// What of it has moved.
inline std::vector<SceneChange::Moved> movedThing(const RoomOfThings& before, const RoomOfThings& after, int thing) {
  std::vector<SceneChange::Moved> moved;
  const auto t = static_cast<std::size_t>(thing);
  for (std::size_t i = before.first[t]; i < before.first[t + 1]; ++i)
    moved.push_back(
        {PrimitiveId(i), bounds(before.scene.primitives[i].shape), bounds(after.scene.primitives[i].shape)});
  return moved;
}

/// How the mesh of a room is made.
struct MeshOfRoom {
  int levels = 2;           // that all surfaces are split by
  std::uint64_t finer = 0;  // seed of which leaves are split once more, one of four; 0: none
  bool backwards = false;   // split in the other order: leaves have other numbers
};

/// A scene, a mesh of it, and what traces its lines.
class TracedRoom {
 public:
  TracedRoom(Scene room, const MeshOfRoom& mesh)
      : scene(std::move(room)),
        embree(tracing::makeEmbreeTracer(scene)),
        elements(split(scene, mesh)),
        leaves(elements),
        locator(elements, scene, leaves),
        responses(scene, true),
        tracer(scene, *embree, responses),
        cover(scene, *embree),
        enclosed(elements.size(), 0) {}

  /// From lines that are there, if any.
  lines::TracedLines trace(std::span<const std::uint32_t> counts, const lines::KnownLines* known = nullptr,
                           lines::TracedLines from = {}) const {
    lines::traceLines({elements, leaves, locator, tracer, cover, enclosed, {}, known}, counts, from);
    lines::trim(leaves, counts, from);
    return from;
  }
  /// By leaf: `least` lines or some octaves more, by chance.
  std::vector<std::uint32_t> counts(std::uint32_t least, std::uint64_t seed) const {
    std::vector<std::uint32_t> all;
    for (const hierarchy::ElementId leaf : leaves.leaves)
      all.push_back(least << (combineKeys(elements.key[leaf.index()], seed) % 3));
    return all;
  }

  Scene scene;
  std::unique_ptr<tracing::RayTracer> embree;
  hierarchy::Elements elements;
  hierarchy::LeafTable leaves;
  hierarchy::LeafLocator locator;
  lines::SurfaceResponses responses;
  lines::LineTracer tracer;
  lines::Cover cover;
  std::vector<char> enclosed;

 private:
  static hierarchy::Elements split(const Scene& scene, const MeshOfRoom& mesh) {
    hierarchy::Elements elements = hierarchy::buildElements(scene, hierarchy::surfaceSides(scene));
    const auto splitAll = [&](const auto& chosen) {
      std::vector<hierarchy::ElementId> all;
      for (const hierarchy::ElementId leaf : hierarchy::LeafTable(elements).leaves)
        if (chosen(elements.key[leaf.index()])) all.push_back(leaf);
      if (mesh.backwards) std::ranges::reverse(all);
      hierarchy::subdivide(elements, scene, all);
    };
    for (int level = 0; level < mesh.levels; ++level) splitAll([](std::uint64_t) { return true; });
    if (mesh.finer > 0) splitAll([&](std::uint64_t key) { return combineKeys(key, mesh.finer) % 4 == 0; });
    return elements;
  }
};

/// By element of `before`: which leaf of `after` stands there, as large, of surfaces that have not moved;
/// LeafTable::kNone.
inline std::vector<std::uint32_t> leavesAfter(const TracedRoom& before, const TracedRoom& after,
                                              const change::MovedSpace& space) {
  std::unordered_map<std::uint64_t, hierarchy::ElementId> byKey;
  for (const hierarchy::ElementId leaf : before.leaves.leaves) byKey[before.elements.key[leaf.index()]] = leaf;
  std::vector<std::uint32_t> now(before.elements.size(), hierarchy::LeafTable::kNone);
  for (const hierarchy::ElementId leaf : after.leaves.leaves) {
    const auto at = byKey.find(after.elements.key[leaf.index()]);
    if (at == byKey.end() || space.moved(after.elements.domain[leaf.index()].primitive)) continue;
    const hierarchy::ElementGeometry &a = before.elements.shape(at->second), &b = after.elements.shape(leaf);
    if (a.lower == b.lower && a.upper == b.upper) now[at->second.index()] = leaf.value;
  }
  return now;
}

/// What lines of leaves, by where those are `now`, are worth over a mesh: marks them.
inline lines::KnownLines knownAfter(const change::MovedSpace& space, std::span<const std::uint32_t> now,
                                    const hierarchy::Elements& elements, lines::TracedLines& all) {
  std::vector<char> stands(elements.size(), false);
  for (const std::uint32_t e : now)
    if (e != hierarchy::LeafTable::kNone) stands[e] = true;
  all = lines::renumbered(all, now, elements.size());
  return change::knownLines(space, all, stands, elements);
}

/// Lines over a room before a change, and what they are worth after it.
struct RoomChange {
  /// Thing `moved` goes by `by`; the mesh becomes another, and so do the numbers of lines where `recount`.
  RoomChange(int moved, const Vec3& by, const MeshOfRoom& meshBefore, const MeshOfRoom& meshAfter, bool recount)
      : RoomChange(RoomOfThings(), RoomOfThings(moved, by), moved, meshBefore, meshAfter, recount) {}

  TracedRoom before, after;
  change::MovedSpace space;
  std::vector<std::uint32_t> countsAfter;
  lines::TracedLines tracedBefore;
  std::vector<std::uint32_t> elementNow;  // leavesAfter()
  lines::TracedLines marked;              // the same lines over the mesh after it
  lines::KnownLines known;

  lines::TracedLines taken() const { return after.trace(countsAfter, &known, marked); }

 private:
  RoomChange(RoomOfThings then, RoomOfThings now, int moved, const MeshOfRoom& meshBefore, const MeshOfRoom& meshAfter,
             bool recount)
      : before(then.scene, meshBefore), after(now.scene, meshAfter), countsAfter(after.counts(24, recount ? 2 : 1)) {
    if (moved < RoomOfThings::kThings) space = change::MovedSpace(now.scene, movedThing(then, now, moved));
    tracedBefore = before.trace(before.counts(24, 1));
    elementNow = leavesAfter(before, after, space);
    marked = tracedBefore;
    known = knownAfter(space, elementNow, after.elements, marked);
  }
};

}  // namespace deltalux::test
