#pragma once
// What a solution looks like: light meters and pictures. Indirect light is reconstructed smoothly within surfaces;
// direct light is measured again with shadow rays, so that shadows are as sharp as they are.
#include <deltalux/image.hpp>
#include <deltalux/probe.hpp>
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>
#include <deltalux/view.hpp>
#include <optional>
#include <span>
#include <vector>

namespace deltalux {

struct ProbeSettings {
  bool mesh = false;         // the mesh's own value at points of surfaces: no reconstruction, no shadow rays
  double error = 0.01;       // relative standard error at which sampling stops, in (0, 1)
  int maxSamples = 1 << 14;  // lines, shadow rays, and in free space paths, of a point at most
  std::uint64_t seed = 1;
};

/// Irradiance at every point, in their order [W/m2]. A point on a surface whose side faces the normal (within 1 mm, or
/// some steps of single precision there) reads the solution there (indirect light by lines of that very point); any
/// other point gathers what it sees. Standard errors are those of the sampling, not of the solution. Does not depend on
/// the number of threads. Throws Interrupted.
std::vector<ProbeResult> probe(const SolutionView&, std::span<const ProbePoint>, const ProbeSettings& = {},
                               Progress* progress = nullptr);
/// By group of lights (lightGroups()), what it brings to every point: as probe() of lightOf() for each, but what groups
/// have in common is made ready once. Throws Interrupted.
std::vector<std::vector<ProbeResult>> probeByLight(const SolutionView&, std::span<const ProbePoint>,
                                                   const ProbeSettings& = {}, Progress* progress = nullptr);

struct RenderSettings {
  int width = 640, height = 480;
  int samplesPerPixel = 16;   // camera rays, stratified; at least 1
  int shadowRays = 8;         // towards lights at each surface that a camera ray meets; at least 2
  bool meshDirect = false;    // direct light from the mesh too, reconstructed: no shadow rays
  int maxSpecularDepth = 24;  // mirrors and panes that a camera ray follows
  std::uint64_t seed = 1;
};

/// Radiance seen through the view [W/(sr m2)]. Does not depend on the number of threads. Throws Interrupted.
Image render(const SolutionView&, const View&, const RenderSettings& = {}, Progress* progress = nullptr);

/// A caustic texture as it is stored: irradiance of the particles [W/m2], its own t axis upwards; negative where it
/// shows no surface.
struct TextureImage {
  std::string name;  // of the surface's object, the side, the texture's number on it: fit for a file
  Image image;
};

/// All caustic textures of a solution.
std::vector<TextureImage> textureImages(const SolutionView&);

/// All of them on one sheet, each enlarged or reduced to a square of `size` pixels, exposed for itself and numbered in
/// their order. Checkered where there is no surface.
DisplayImage contactSheet(const std::vector<TextureImage>&, int size = 160);

struct MeshViewSettings {
  int width = 640, height = 480;
  std::optional<glm::ivec2> linksOf;  // a pixel: draws the links that bring light to the element seen there, if any do
};

/// The mesh as it is, for debugging: radiance of the leaf patches without any reconstruction, their outlines, and the
/// links of one element as lines (green: unoccluded, yellow: partly, red: occluded; those of its ancestors included).
Image renderMesh(const SolutionView&, const View&, const MeshViewSettings& = {});

}  // namespace deltalux
