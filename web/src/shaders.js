// GLSL of the page. What is drawn of a point: L = E rho / pi + L emitted, or E itself for false colour; both linear,
// into a half-float picture that a last pass shows.

/** Row of the table of materials: rho / pi, emitted L, tau / pi, and what mirrors and gloss reflect of the average. */
export const kMaterialTexels = 4;
export const kMaterialsPerRow = 256;

export const surfaceVertex = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
in vec3 position;
#ifdef CAUSTIC
in vec2 texel;
uniform float size_u, size_v;
centroid out vec2 place;
#else
in vec3 irradiance;
centroid out vec3 E;
#endif
in vec2 bend;       // normal, octahedral
in float material;
#ifdef TEXTURED
in vec2 uv;
centroid out vec2 materialUv;
#endif
uniform mat4 modelViewMatrix, projectionMatrix;
uniform sampler2D materials;
uniform vec3 eye;
flat out vec3 reflects, emitted, gloss;
centroid out vec3 towards, normal;

vec4 entry(int k) {
  int id = int(material + 0.5);
  return texelFetch(materials, ivec2((id % ${kMaterialsPerRow}) * ${kMaterialTexels} + k, id / ${kMaterialsPerRow}), 0);
}

void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
#ifdef CAUSTIC
  place = texel;
#else
  E = irradiance;
#endif
#ifdef BEHIND
  reflects = entry(2).rgb;
  emitted = gloss = vec3(0.0);
#else
  reflects = entry(0).rgb;
#ifdef CAUSTIC
  emitted = gloss = vec3(0.0);
#else
  emitted = entry(1).rgb;
  gloss = entry(3).rgb;
#endif
#endif
#ifdef TEXTURED
  materialUv = uv;
#endif
  towards = eye - position;
  vec3 n = vec3(bend, 1.0 - abs(bend.x) - abs(bend.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  normal = normalize(n);
}
`;

export const surfaceFragment = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
#ifdef CAUSTIC
centroid in vec2 place;
uniform sampler2D light;   // E of the particles
uniform sampler2D shows;   // 1 where it shows
uniform vec3 weight;
#else
centroid in vec3 E;
#endif
#ifdef TEXTURED
centroid in vec2 materialUv;
uniform sampler2D image;
#endif
#ifdef PASSES
uniform vec3 transmissivity;
uniform float index;
#endif
#ifdef MIRROR
uniform sampler2D mirrored;
uniform vec2 pixels;
uniform float mirrorOn;
#endif
uniform bool showsIrradiance;
uniform vec3 ambient;      // L, what a mirror shows that nothing is drawn in
uniform vec3 upwards;
flat in vec3 reflects, emitted, gloss;
centroid in vec3 towards, normal;
out vec4 colour;

float fresnel(float c, float n) {
  float g = sqrt(max(n * n - 1.0 + c * c, 0.0));
  float a = (g - c) / (g + c), b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
  return 0.5 * a * a * (1.0 + b * b);
}

void main() {
#ifdef CAUSTIC
  ivec2 size = textureSize(shows, 0);
  if (texelFetch(shows, clamp(ivec2(floor(place * vec2(size))), ivec2(0), size - 1), 0).r < 0.5) discard;
  vec3 E = weight * texture(light, place).rgb;
#endif
#ifdef PASSES
  // A pane: all that goes through after every reflection inside, per channel. [Radiance, glass]
  float c = max(abs(dot(normalize(normal), normalize(towards))), 0.05);
  float r = fresnel(c, index);
  float inside = sqrt(1.0 - (1.0 - c * c) / (index * index));
  vec3 t = pow(max(transmissivity, 1e-4), vec3(1.0 / inside));
  vec3 through = index <= 1.0 ? transmissivity : t * (1.0 - r) * (1.0 - r) / (1.0 - r * r * t * t);
  colour = vec4(showsIrradiance ? vec3(1.0) : through, 1.0);
#else
  vec3 tinted = reflects;
#ifdef TEXTURED
  tinted *= texture(image, materialUv).rgb;
#endif
  if (showsIrradiance) {
    colour = vec4(E, 1.0);
  } else {
    vec3 L = E * tinted + emitted;
#ifndef CAUSTIC
    vec3 n = normalize(normal), v = normalize(towards);
    vec3 seen = ambient * (1.0 + 0.35 * dot(reflect(-v, n), upwards));
#ifdef MIRROR
    seen = mix(seen, texture(mirrored, vec2(1.0 - gl_FragCoord.x / pixels.x, gl_FragCoord.y / pixels.y)).rgb, mirrorOn);
#endif
    L += gloss * seen;
#endif
    colour = vec4(min(L, vec3(6e4)), 1.0);
  }
#if defined(CAUSTIC) || defined(BEHIND)
  colour.a = 0.0;
#endif
#endif
}
`;

export const screenVertex = /* glsl */ `
precision highp float;
in vec3 position;
out vec2 at;
void main() {
  at = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`;

export const skyFragment = /* glsl */ `
precision highp float;
precision highp sampler2D;
in vec2 at;
uniform sampler2D sky;
uniform vec3 forward, across, above;   // the picture's middle, and half its width and height
uniform vec4 suns[4];                  // direction, chord of the radius
uniform vec3 sunRadiance[4];
uniform bool showsIrradiance;
out vec4 colour;
void main() {
  if (showsIrradiance) { colour = vec4(0.0); return; }
  vec3 w = normalize(forward + (2.0 * at.x - 1.0) * across + (2.0 * at.y - 1.0) * above);
  const float pi = 3.14159265358979;
  vec3 L = textureLod(sky, vec2(atan(w.y, w.x) / (2.0 * pi) + 0.5, acos(clamp(w.z, -1.0, 1.0)) / pi), 0.0).rgb;
  for (int i = 0; i < 4; ++i)
    if (distance(w, suns[i].xyz) < suns[i].w) L += sunRadiance[i];
  colour = vec4(min(L, vec3(6e4)), 1.0);
}
`;

export const shownFragment = /* glsl */ `
precision highp float;
precision highp sampler2D;
in vec2 at;
uniform sampler2D picture, ramp;
uniform float exposure, top, decades, efficacy;
uniform bool showsIrradiance, linearTone;
out vec4 colour;
const vec3 weights = vec3(0.265, 0.670, 0.065);

// As toneMap() of the library: luminance is compressed, the ratio of the channels kept. [Reinhard02 (4)]
vec3 shown(vec3 L) {
  vec3 c = exposure * max(L, 0.0);
  float Y = dot(c, weights);
  if (!(Y > 0.0)) return vec3(0.0);
  float y = linearTone ? Y : Y * (1.0 + Y / 16.0) / (1.0 + Y);
  c *= y / Y;
  float brightest = max(max(c.r, c.g), c.b);
  if (brightest > 1.0) c = mix(vec3(y), c, (1.0 - y) / (brightest - y));
  if (y >= 1.0) c = vec3(1.0);
  vec3 curved = 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055;
  return mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
  vec4 p = texture(picture, at);
  if (!showsIrradiance) {
    colour = vec4(shown(p.rgb), 1.0);
  } else if (p.a < 0.5) {
    colour = vec4(vec3(96.0 / 255.0), 1.0);
  } else {
    float lux = efficacy * dot(p.rgb / p.a, weights);
    float t = lux > 0.0 ? clamp(1.0 + log(lux / top) / (log(10.0) * decades), 0.0, 1.0) : 0.0;
    colour = vec4(texture(ramp, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb, 1.0);
  }
}
`;
