// Light along single rays, for a Render Cache: direct light from the mesh, so that a ray costs what its corners cost.
#include <deltalux/solution_reader.hpp>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "render/eye_path.hpp"
#include "render/reader_state.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kRays = 64;              // of a block [task]
constexpr float kFar = 1024;                   // where paths that leave the scene end, over its diagonal [sentinel]
constexpr std::uint64_t kStreamKey = 1 << 17;  // of the pixels' stratified numbers [key]

/// Shows what is behind it, or in front, undistorted: light that it passes on comes from where it seems to.
bool showsImages(const Scene& scene, PrimitiveId primitive) {
  const Material& material = scene.materialOf(primitive);
  if (isPane(material)) return true;
  const Shape& shape = scene[primitive].shape;
  if (!std::holds_alternative<Polygon>(shape) && !std::holds_alternative<Ring>(shape)) return false;
  if (std::holds_alternative<Mirror>(material.surface)) return true;
  const auto* opaque = std::get_if<Opaque>(&material.surface);
  return opaque && isBlack(opaque->diffuse) && !isBlack(opaque->specular.reflectance) &&
         !(opaque->specular.roughness > 0);
}

/// The image of the first surface that shows none itself: as far along the ray from the eye as the path to it is long.
/// Of a pane it is what stands behind.
Vec3f apparentPoint(const Scene& scene, const PixelSample& s, const Vec3f& direction) {
  std::uint8_t at = 0;
  float length = glm::length(s.path[0].position - s.eye);
  while (s.path[at].primitive.valid() && showsImages(scene, s.path[at].primitive)) {
    std::uint8_t next = at;
    for (std::uint8_t i = at + 1; i < s.corners; ++i)
      if (s.path[i].before == at) next = i;
    if (next == at) break;
    length += glm::length(s.path[next].position - s.path[at].position);
    at = next;
  }
  return at == 0 ? s.position : s.eye + length * direction;
}

}  // namespace

std::vector<PixelSample> SolutionReader::trace(std::span<const PixelRay> rays) const {
  const Solution& solution = state_->solution();
  const rendering::Reconstruction& reconstruction = *state_->reconstruction;
  const rendering::EyeSettings settings{0, RenderSettings{}.maxSpecularDepth};
  const rendering::EyePaths paths(solution, reconstruction, settings);
  const float far = kFar * static_cast<float>(std::max(solution.elements.sceneBox.diagonal(), 1.0));
  std::vector<PixelSample> samples(rays.size());
  parallelBlocks(rays.size(), kRays, [&](std::size_t begin, std::size_t end) {
    rendering::Sights sights(solution.elements, reconstruction.sources);  // stay empty: there are no shadow rays
    for (std::size_t i = begin; i < end; ++i) {
      const PixelRay& ray = rays[i];
      PixelSample& s = samples[i];
      s.pixel = ray.pixel, s.version = state_->version, s.eye = ray.origin;
      rendering::EyeTrail trail(s, far);
      rendering::EyeRay eye;
      eye.ray.origin = ray.origin, eye.ray.direction = ray.direction;
      eye.key = combineKeys(kStreamKey, ray.pixel), eye.index = ray.index;
      eye.trail = &trail;
      s.radiance = paths.radiance(eye, sights);
      s.position = s.path[0].position, s.primitive = s.path[0].primitive;
      s.apparent = apparentPoint(solution.scene, s, ray.direction);
    }
  });
  return samples;
}

}  // namespace deltalux
