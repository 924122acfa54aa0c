#pragma once
// GLSL 3.30 sources. Which of their parts are compiled is said by lines of #define (Program). All pictures have their
// first row at the top: texel (0, 0) of every target is the upper left pixel.
namespace deltalux::viewer::gl::shaders {

/// Triangles of a mesh store. SECTION: cuts at a box. TEXTURED: the material's texture multiplies what is reflected.
/// ILLUMINANCE: irradiance into the third target, too. OTHER_SIDE: seen from behind, light that passes diffusely.
/// CAUSTIC: irradiance from a caustic texture. PANE: what is behind times what passes straight, by dual source
/// blending. FLAT: one colour.
extern const char* const kSurfaceVertex;
extern const char* const kSurfaceFragment;

/// A triangle that covers all pixels, at the far end of depth.
extern const char* const kScreenVertex;
/// Sky, ground and suns.
extern const char* const kBackgroundFragment;
/// From light to the screen: TONE (with REINHARD or linear), or false colour of ILLUMINANCE or LUMINANCE, or OUTLINE,
/// of what is selected; with none of them radiance. CACHE, PICTURE: these layers are there. Each is compiled apart:
/// software OpenGL computes both ways of a branch.
extern const char* const kScreenFragment;

/// Lines, with the thickness of one pixel.
extern const char* const kLineVertex;
extern const char* const kLineFragment;

}  // namespace deltalux::viewer::gl::shaders
