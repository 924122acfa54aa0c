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

constexpr std::size_t kSidesBlock = 8;

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

void SolutionMesher::findGroups(const Scene& scene) {
  groups_ = planeGroups(scene);
  pieces_.resize(2 * scene.primitives.size());
  shapes_.resize(pieces_.size());
}

void SolutionMesher::findShapes(const Solution& s) {
  std::vector<char> changed(pieces_.size(), 0);
  parallelFor(pieces_.size(), kSidesBlock, [&](std::size_t i) {
    SurfacePieces now = piecesOf(s.elements, s.scene, PrimitiveId(i / 2), i % 2 == 0);
    if (shapes_[i] && samePieces(pieces_[i], now)) return;
    changed[i] = 1;
    pieces_[i] = std::move(now);
  });
  parallelFor(groups_.size(), 1, [&](std::size_t g) {
    const std::vector<std::uint32_t>& group = groups_[g];
    if (std::none_of(group.begin(), group.end(), [&](std::uint32_t side) { return changed[side]; })) return;
    std::vector<const SurfacePieces*> sides;
    for (const std::uint32_t side : group) sides.push_back(&pieces_[side]);
    auto shapes = shapesOf(sides, s.scene, touchingDistance(s.scene, group));
    for (std::size_t i = 0; i < group.size(); ++i) shapes_[group[i]] = std::move(shapes[i]);
  });
}

SolutionMesh SolutionMesher::snapshot(const Solution& s, const Reconstruction& reconstruction,
                                      const SolutionMesh& before, std::uint64_t version) {
  if (!scene_ || !hasSameShapes(*scene_, s.scene)) findGroups(s.scene);
  if (!scene_ || !isUpToDate(*scene_, s.scene)) scene_ = std::make_shared<const Scene>(s.scene);
  findShapes(s);
  SolutionMesh now;
  now.version = version;
  now.scene = scene_;
  now.surfaces.resize(shapes_.size());
  now.caustics.resize(shapes_.size());
  parallelFor(shapes_.size(), 1, [&](std::size_t i) {
    const auto surface = i < before.surfaces.size() ? before.surfaces[i] : nullptr;
    const auto caustic = i < before.caustics.size() ? before.caustics[i] : nullptr;
    const bool there = shapes_[i] && !shapes_[i]->triangles.empty();
    if (there || surface)
      now.surfaces[i] =
          withVersions(there ? litSide(*shapes_[i], s.scene, reconstruction) : nothingOn(i), surface, version);
    const caustics::SurfaceCaustics* textures = there ? s.caustics.of(PrimitiveId(i / 2), i % 2 == 0) : nullptr;
    if (textures || caustic)
      now.caustics[i] =
          withVersions(textures ? causticMeshOf(*textures, s.scene.primitives[i / 2].shape, *now.surfaces[i])
                                : SurfaceCausticMesh{PrimitiveId(i / 2), i % 2 == 0, 0, {}},
                       caustic, version);
  });
  return now;
}

}  // namespace deltalux::rendering
