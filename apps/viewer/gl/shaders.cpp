#include "gl/shaders.hpp"

namespace deltalux::viewer::gl::shaders {

const char* const kSurfaceVertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in uint side;
layout(location = 2) in vec2 texcoord;
layout(location = 3) in vec3 irradiance;
uniform mat4 toClip;            // from where the mesh has it
uniform samplerBuffer sides;    // by side: rho / pi; emitted radiance, row of the transmittance table; tau / pi
#if defined(SECTION) || defined(PANE)
uniform mat4 model;             // to where it is
#endif
#ifdef SECTION
uniform vec3 sectionLower, sectionUpper;
out float gl_ClipDistance[6];
#endif
#ifdef PANE
out vec3 place;
flat out float row;
#endif
#if defined(TEXTURED) || defined(CAUSTIC)
out vec2 uv;
flat out vec3 emitted;
#endif
#ifdef ILLUMINANCE
out vec3 E;
#endif
#ifdef CAUSTIC
flat out vec3 factor;
#ifdef TEXTURED
layout(location = 4) in vec2 materialTexcoord;
out vec2 materialUv;
#endif
#else
out vec3 radiance;
#endif
flat out uint primitive;

void main() {
  gl_Position = toClip * vec4(position, 1.0);
  primitive = (side >> 1u) + 1u;
#ifdef SECTION
  vec3 p = (model * vec4(position, 1.0)).xyz;
  for (int i = 0; i < 3; ++i) {
    gl_ClipDistance[i] = p[i] - sectionLower[i];
    gl_ClipDistance[i + 3] = sectionUpper[i] - p[i];
  }
#endif
#ifdef FLAT
#ifdef CAUSTIC
  uv = texcoord;
  emitted = factor = vec3(0.0);
#else
  radiance = vec3(0.0);
#endif
#else
#ifdef OTHER_SIDE
  vec3 reflects = texelFetch(sides, 3 * int(side ^ 1u) + 2).rgb;
#else
  vec3 reflects = texelFetch(sides, 3 * int(side)).rgb;
#endif
  vec4 emission = texelFetch(sides, 3 * int(side) + 1);
#if defined(TEXTURED) || defined(CAUSTIC)
  uv = texcoord;
  emitted = emission.rgb;
#endif
#ifdef ILLUMINANCE
  E = irradiance;
#endif
#ifdef PANE
  place = (model * vec4(position, 1.0)).xyz;
  row = emission.a;
#endif
#ifdef CAUSTIC
  factor = reflects;
#ifdef TEXTURED
  materialUv = materialTexcoord;
#endif
#elif defined(TEXTURED) || defined(OTHER_SIDE)
  radiance = reflects * irradiance;
#else
  radiance = reflects * irradiance + emission.rgb;
#endif
#endif
}
)glsl";

const char* const kSurfaceFragment = R"glsl(
#if defined(TEXTURED) || defined(CAUSTIC)
in vec2 uv;
flat in vec3 emitted;
uniform sampler2D image;  // the material's texture, or E and where it shows
#endif
#ifdef ILLUMINANCE
in vec3 E;
out vec4 irradianceOut;
#endif
#ifdef CAUSTIC
flat in vec3 factor;
#ifdef TEXTURED
in vec2 materialUv;
uniform sampler2D tint;  // the material's texture
#endif
#else
in vec3 radiance;
#endif
flat in uint primitive;
#ifdef PANE
in vec3 place;
flat in float row;
uniform vec4 eye;           // where it is and 1, or where it looks and 0
uniform sampler2D passes;   // straight transmittance by cosine and row
out vec4 transmitted;
#else
out uint primitiveOut;
#endif
#ifdef FLAT
uniform vec4 flatColour;
#endif
out vec4 colour;

void main() {
#ifdef CAUSTIC
  ivec2 size = textureSize(image, 0);
  ivec2 texel = clamp(ivec2(floor(uv * vec2(size))), ivec2(0), size - 1);
  if (texelFetch(image, texel, 0).a < 0.5) discard;
#ifdef FLAT
  colour = flatColour;
#else
  vec3 found = texture(image, uv).rgb;
  colour = vec4(factor * found, 0.0);
#ifdef TEXTURED
  colour.rgb *= texture(tint, materialUv).rgb;
#endif
#ifdef ILLUMINANCE
  irradianceOut = vec4(found, 0.0);
#endif
#endif
#else
#ifdef TEXTURED
  colour = vec4(radiance * texture(image, uv).rgb + emitted, 1.0);
#elif defined(FLAT)
  colour = flatColour;
#else
  colour = vec4(radiance, 1.0);
#endif
#ifdef PANE
  vec3 n = normalize(cross(dFdx(place), dFdy(place)));
  vec3 towards = eye.w > 0.5 ? normalize(eye.xyz - place) : eye.xyz;
  float size = float(textureSize(passes, 0).x);
  float cosine = clamp(abs(dot(n, towards)), 0.0, 1.0);
  float rows = float(textureSize(passes, 0).y);
  transmitted = texture(passes, vec2((cosine * (size - 1.0) + 0.5) / size, (row + 0.5) / rows));
#endif
#ifdef ILLUMINANCE
  irradianceOut = vec4(E, 1.0);
#endif
#endif
#ifndef PANE
  primitiveOut = primitive;
#endif
}
)glsl";

const char* const kScreenVertex = R"glsl(
void main() {
  gl_Position = vec4(float(gl_VertexID >> 1) * 4.0 - 1.0, float(gl_VertexID & 1) * 4.0 - 1.0, 1.0, 1.0);
}
)glsl";

const char* const kBackgroundFragment = R"glsl(
uniform vec3 corner, across, down;  // direction of pixel (x, y): corner + x across + y down
uniform sampler2D sky;              // radiance by azimuth and polar angle
uniform int suns;
uniform vec4 sunDirection[8];       // and the chord of its angular radius
uniform vec3 sunRadiance[8];
out vec4 colour;

void main() {
  vec3 w = normalize(corner + gl_FragCoord.x * across + gl_FragCoord.y * down);
  const float pi = 3.14159265358979;
  vec3 L = textureLod(sky, vec2(atan(w.y, w.x) / (2.0 * pi) + 0.5, acos(clamp(w.z, -1.0, 1.0)) / pi), 0.0).rgb;
  for (int i = 0; i < suns; ++i)
    if (distance(w, sunDirection[i].xyz) < sunDirection[i].w) L += sunRadiance[i];
  colour = vec4(L, 1.0);
}
)glsl";

const char* const kScreenFragment = R"glsl(
uniform sampler2D radiance;
uniform usampler2D primitives;  // value + 1 of what is seen first
#ifdef CACHE
uniform sampler2D cache;        // radiance, and how well it is known
#endif
#ifdef PICTURE
uniform sampler2D picture;      // radiance, and its weight
#endif
uniform int wipe;               // columns from here on show another snapshot, without these layers
out vec4 colour;

vec3 composed(ivec2 p) {
  vec3 L = texelFetch(radiance, p, 0).rgb;
  float layers = p.x < wipe ? 1.0 : 0.0;
#ifdef CACHE
  vec4 known = texelFetch(cache, p, 0);
  // However few samples it was filled from: what is under it is a mirror without a reflection.
  if (known.a > 0.0 && layers > 0.0) L = known.rgb;
#endif
#ifdef PICTURE
  vec4 better = texelFetch(picture, p, 0);
  L = mix(L, better.rgb, better.a * layers);
#endif
  return L;
}

const vec3 weights = vec3(0.265, 0.670, 0.065);
bool finite(vec3 c) { return !any(isnan(c)) && !any(isinf(c)); }

#ifdef TONE
uniform float exposure;

// As toneMap() of the library has it [Reinhard02 (4)].
vec3 shown(vec3 L) {
  vec3 c = exposure * max(L, 0.0);
  float Y = dot(c, weights);
#ifdef REINHARD
  float compressed = Y * (1.0 + Y / 16.0) / (1.0 + Y);
#else
  float compressed = Y;
#endif
  c *= compressed / Y;
  float brightest = max(max(c.r, c.g), c.b);
  if (brightest > 1.0) c = mix(vec3(compressed), c, (1.0 - compressed) / (brightest - compressed));
  if (compressed >= 1.0) c = vec3(1.0);
  vec3 curved = 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055;
  return finite(L) && Y > 0.0 ? mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308))) : vec3(0.0);
}
#endif

#if defined(ILLUMINANCE) || defined(LUMINANCE)
uniform sampler2D irradiance;   // E, and 1 where there is a surface
uniform float efficacy;         // lm/W
uniform float top, decades;     // of the scale
uniform int scale;              // 0: linear; 1: logarithmic; 2: bands
uniform sampler2D levels;       // values of the bands, or where isolines run
uniform int levelCount, isolines;
uniform sampler2D ramp;

// Below 0: nothing to tell.
float value(ivec2 p) {
#ifdef LUMINANCE
  vec3 L = composed(p);
  return finite(L) ? efficacy * dot(max(L, 0.0), weights) : -1.0;
#else
  vec4 E = texelFetch(irradiance, p, 0);
  return E.a > 0.5 && finite(E.rgb) ? efficacy * dot(max(E.rgb, 0.0), weights) : -1.0;
#endif
}

int levelOf(float v) {
  int level = 0;
  for (int i = 0; i < levelCount; ++i)
    if (texelFetch(levels, ivec2(i, 0), 0).r <= v) ++level;
  return level;
}

vec3 falseColour(ivec2 p) {
  float v = value(p);
  if (v < 0.0) return vec3(96.0 / 255.0);
  float position = 0.0;
  if (scale == 2)
    position = float(levelOf(v)) / float(max(levelCount, 1));
  else if (v > 0.0)
    position = scale == 1 ? 1.0 + log2(v / top) / (log2(10.0) * decades) : v / top;
  float size = float(textureSize(ramp, 0).x);
  vec3 c = textureLod(ramp, vec2((clamp(position, 0.0, 1.0) * (size - 1.0) + 0.5) / size, 0.5), 0.0).rgb;
  if (isolines != 0) {
    int level = levelOf(v);
    uint here = texelFetch(primitives, p, 0).r;
    for (int i = 0; i < 2; ++i) {
      ivec2 q = min(p + ivec2(1 - i, i), textureSize(radiance, 0) - 1);
      float w = value(q);
      if (texelFetch(primitives, q, 0).r == here && w >= 0.0 && levelOf(w) != level)
        c = vec3(dot(c, weights) > 0.5 ? 0.0 : 1.0);
    }
  }
  return c;
}
#endif

#ifdef OUTLINE
uniform samplerBuffer selected;  // by primitive, from 1

float selectedAt(ivec2 p) {
  uint here = texelFetch(primitives, clamp(p, ivec2(0), textureSize(primitives, 0) - 1), 0).r;
  return texelFetch(selected, int(here)).r;
}
#endif

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(OUTLINE)
  // Within two pixels of what is selected, and no part of it.
  float near = 0.0;
  for (int i = -1; i <= 1; i += 2)
    near += selectedAt(p + ivec2(i, 0)) + selectedAt(p + ivec2(0, i)) + selectedAt(p + ivec2(2 * i, 0)) +
            selectedAt(p + ivec2(0, 2 * i)) + selectedAt(p + ivec2(i, i)) + selectedAt(p + ivec2(i, -i));
  if (near < 0.5 || selectedAt(p) > 0.5) discard;
  colour = vec4(1.0, 0.55, 0.1, 1.0);
#elif defined(TONE)
  colour = vec4(shown(composed(p)), 1.0);
#elif defined(ILLUMINANCE) || defined(LUMINANCE)
  colour = vec4(falseColour(p), 1.0);
#else
  colour = vec4(composed(p), 1.0);
#endif
}
)glsl";

const char* const kLineVertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colourOfVertex;
uniform mat4 toClip;
uniform float nearer;  // towards the eye, in depth
#ifdef SECTION
uniform vec3 sectionLower, sectionUpper;
out float gl_ClipDistance[6];
#endif
out vec4 colourBetween;

void main() {
  gl_Position = toClip * vec4(position, 1.0);
  gl_Position.z -= nearer * gl_Position.w;
  colourBetween = colourOfVertex;
#ifdef SECTION
  for (int i = 0; i < 3; ++i) {
    gl_ClipDistance[i] = position[i] - sectionLower[i];
    gl_ClipDistance[i + 3] = sectionUpper[i] - position[i];
  }
#endif
}
)glsl";

const char* const kLineFragment = R"glsl(
in vec4 colourBetween;
out vec4 colour;
void main() { colour = colourBetween; }
)glsl";

}  // namespace deltalux::viewer::gl::shaders
