#pragma once
// The passes that draw light on surfaces. Light is added up: first the smooth mesh, which leaves depths, then the
// caustic textures, at depths up to these, without leaving any. [GD01 6.1] has them the other way round, after depths
// alone have been drawn; the sum is the same, all triangles pass once less, and the mesh needs no offset against what
// lies on it: one offset, of the textures towards the eye, decides between surfaces that share a plane.
#include <map>

#include "gl/caustic_store.hpp"
#include "gl/draw_list.hpp"
#include "gl/texture_store.hpp"

namespace deltalux::viewer::gl {

/// One snapshot as one camera sees it.
struct SurfaceView {
  MeshStore& mesh;
  CausticStore& caustics;
  const DrawList& list;
  const Eye& eye;
  glm::dmat4 toClip{1.0};
  glm::mat4 ahead{1.0f};
  std::optional<Box> section;
  bool illuminance = false;  // irradiance is drawn, too
};

/// Depths of surfaces differ by rounding between meshes of the same plane: as much is let pass, towards the eye.
/// On while it lives.
class NearerBySome {
 public:
  NearerBySome();
  ~NearerBySome();
};

class SurfacePasses {
 public:
  /// Radiance into colour 0, primitives into colour 1, irradiance into colour 2, depths.
  void drawOpaque(const SurfaceView&, std::uint64_t& uploaded);
  /// Adds to colour 0 what passes diffusely from the other sides.
  void addOtherSides(const SurfaceView&);
  /// Adds to colours 0 and 2.
  void addCaustics(const SurfaceView&, std::uint64_t& uploaded);
  /// Colour 0 times what passes, plus the panes' own light.
  void drawPanes(const SurfaceView&, std::uint64_t& uploaded);
  /// Primitives into colour 1, depths.
  void drawPanePrimitives(const SurfaceView&);
  /// Where caustic textures show, each in a colour, over colour 0.
  void tintCaustics(const SurfaceView&, std::uint64_t& uploaded);

 private:
  const Program& use(unsigned parts, const SurfaceView&, bool ahead);
  void drawCaustic(CausticStore::Shown&, unsigned parts, const SurfaceView&, std::uint64_t& uploaded);

  std::map<unsigned, Program> programs_;  // by the parts that they are made of
  TextureStore textures_;
};

}  // namespace deltalux::viewer::gl
