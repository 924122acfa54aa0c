#include "render/solution_mesh/mesher.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "render/solution_mesh/caustic_mesh.hpp"
#include "render/solution_mesh/plane_groups.hpp"
#include "render/solution_mesh/scene_copy.hpp"
#include "render/solution_mesh/side_light.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kSidesBlock = 8;  // [task]

/// What was there before, or what is there now with its versions.
std::shared_ptr<const SurfaceMesh> withVersions(SurfaceMesh side, const std::shared_ptr<const SurfaceMesh>& before,
                                                std::uint64_t version) {
  side.shapeVersion = side.lightVersion = version;
  if (before && sameShape(side, *before)) {
    side.shapeVersion = before->shapeVersion;
    if (sameLight(side, *before)) return before;
  }
  return std::make_shared<const SurfaceMesh>(std::move(side));
}

std::shared_ptr<const SurfaceCausticMesh> withVersions(SurfaceCausticMesh side,
                                                       const std::shared_ptr<const SurfaceCausticMesh>& before,
                                                       std::uint64_t version) {
  if (before && sameTextures(side, *before)) return before;
  side.version = version;
  return std::make_shared<const SurfaceCausticMesh>(std::move(side));
}

/// A side that is gone stays as an empty one: it tells when it went.
SurfaceMesh nothingOn(std::size_t side) {
  SurfaceMesh empty;
  empty.primitive = PrimitiveId(side / 2), empty.front = side % 2 == 0;
  return empty;
}

}  // namespace

std::vector<char> SolutionMesher::findChanged(const Solution& s) {
  Standing now(s.scene);
  const std::vector<char> moved = now.changedSince(standing_);
  standing_ = std::move(now);
  const std::size_t sides = 2 * s.scene.primitives.size();
  cuts_.resize(sides), pieces_.resize(sides), shapes_.resize(sides), sources_.resize(sides);
  readings_.resize(sides);
  std::vector<char> changed(sides, 0);
  const double size = s.elements.sceneBox.diagonal();
  parallelFor(sides, kSidesBlock, [&](std::size_t i) {
    const PrimitiveId primitive(i / 2);
    Cut cut{leavesOf(s.elements, s.scene, primitive, i % 2 == 0), stepsRound(s.scene[primitive].shape, size),
            lagOf(s.elements, s.scene, primitive, i % 2 == 0)};
    changed[i] = moved[i / 2] || cut != cuts_[i];
    cuts_[i] = std::move(cut);
  });
  if (std::find(moved.begin(), moved.end(), char{1}) == moved.end()) return changed;
  // Who moved may have left a group, or come to another.
  auto groups = planeGroups(s.scene);
  std::vector<const std::vector<std::uint32_t>*> groupOf(sides, nullptr);
  for (const auto& group : groups_)
    for (const std::uint32_t side : group) groupOf[side] = &group;
  for (const auto& group : groups)
    if (!groupOf[group.front()] || *groupOf[group.front()] != group)
      for (const std::uint32_t side : group) changed[side] = 1;
  groups_ = std::move(groups);
  return changed;
}

void SolutionMesher::findShapes(const Solution& s, const std::vector<char>& changed) {
  parallelFor(pieces_.size(), kSidesBlock, [&](std::size_t i) {
    if (!changed[i]) return;
    pieces_[i] = piecesOf(s.elements, s.scene, PrimitiveId(i / 2), i % 2 == 0);
    shapes_[i] = nullptr;
  });
  reshaped_ = changed;
  parallelFor(groups_.size(), 1, [&](std::size_t g) {
    const std::vector<std::uint32_t>& group = groups_[g];
    if (std::none_of(group.begin(), group.end(), [&](std::uint32_t side) { return changed[side]; })) return;
    std::vector<const SurfacePieces*> sides;
    for (const std::uint32_t side : group) sides.push_back(&pieces_[side]);
    auto shapes = shapesOf(sides, s.scene, touchingDistance(s.scene, group));
    for (std::size_t i = 0; i < group.size(); ++i) shapes_[group[i]] = std::move(shapes[i]), reshaped_[group[i]] = 1;
  });
}

std::shared_ptr<const SurfaceMesh> SolutionMesher::surfaceAt(std::size_t side, const Solution& s,
                                                             const Reconstruction& reconstruction,
                                                             const SolutionMesh& before, std::uint64_t version) {
  const auto was = side < before.surfaces.size() ? before.surfaces[side] : nullptr;
  const bool there = shapes_[side] && !shapes_[side]->triangles.empty();
  SideReading& reading = readings_[side];
  if (!there) {
    reading = {};
    return was ? withVersions(nothingOn(side), was, version) : nullptr;
  }
  const SideShape& shape = *shapes_[side];
  if (was && !reshaped_[side] && isStillLit(shape, s.scene, reconstruction, *was, generation_)) return was;
  if (was && !reshaped_[side] && reading.holds(shape, reconstruction.field)) {
    SurfaceMesh now = litAgain(*was, reading, shape, s.scene, reconstruction, generation_);
    if (sameLight(now, *was)) return was;
    now.lightVersion = version;
    return std::make_shared<const SurfaceMesh>(std::move(now));
  }
  return withVersions(litSide(shape, s.scene, reconstruction, was.get(), generation_, reading), was, version);
}

std::shared_ptr<const SurfaceCausticMesh> SolutionMesher::causticsAt(std::size_t side, const Solution& s,
                                                                     const SurfaceMesh* surface,
                                                                     const SolutionMesh& before,
                                                                     std::uint64_t version) {
  const auto was = side < before.caustics.size() ? before.caustics[side] : nullptr;
  const PrimitiveId primitive(side / 2);
  const bool front = side % 2 == 0;
  const auto* textures = surface && !surface->triangles.empty() ? s.caustics.of(primitive, front) : nullptr;
  if (!textures) {
    sources_[side] = nullptr;
    return was ? withVersions(SurfaceCausticMesh{primitive, front, 0, {}}, was, version) : nullptr;
  }
  if (was && !reshaped_[side] && sources_[side] && sameTextures(*sources_[side], *textures)) return was;
  sources_[side] = std::make_shared<const caustics::SurfaceCaustics>(*textures);
  return withVersions(causticMeshOf(*textures, s.scene[primitive].shape, *surface), was, version);
}

SolutionMesh SolutionMesher::snapshot(const Solution& s, const Reconstruction& reconstruction,
                                      const SolutionMesh& before, std::uint64_t version) {
  findShapes(s, findChanged(s));
  if (!scene_ || !isUpToDate(*scene_, s.scene)) scene_ = std::make_shared<const Scene>(s.scene);
  SolutionMesh now;
  now.version = version;
  now.scene = scene_;
  now.surfaces.resize(shapes_.size());
  now.caustics.resize(shapes_.size());
  parallelFor(shapes_.size(), 1, [&](std::size_t i) {
    now.surfaces[i] = surfaceAt(i, s, reconstruction, before, version);
    now.caustics[i] = causticsAt(i, s, now.surfaces[i].get(), before, version);
  });
  generation_ = reconstruction.field.generation();
  return now;
}

}  // namespace deltalux::rendering
