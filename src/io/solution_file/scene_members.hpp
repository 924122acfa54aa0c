#pragma once
// The members of a scene, for archives. Structured bindings name every member: one added to a struct breaks the build
// here, where it has to be stored too.
#include <deltalux/scene.hpp>

#include "io/solution_file/archive.hpp"

namespace deltalux::io {

template <>
struct EnumRange<SpecularLobe::Distribution> {
  static constexpr auto first = SpecularLobe::Distribution::Ward, last = SpecularLobe::Distribution::Ggx;
};
template <>
struct EnumRange<RadianceSky::Kind> {
  static constexpr auto first = RadianceSky::Kind::Clear, last = RadianceSky::Kind::Intermediate;
};
template <>
struct EnumRange<View::Kind> {
  static constexpr auto first = View::Kind::Perspective, last = View::Kind::Parallel;
};

/// `T` or `const T`.
template <class T, class Value>
concept Is = std::same_as<std::remove_const_t<T>, Value>;

// Shapes

void members(auto& archive, Is<Polygon> auto& p) {
  auto& [vertices, normal, origin, edgeU, edgeV, dualU, dualV, area, fillsFrame, triangles, outline, cumulative] = p;
  transferAll(archive, vertices, normal, origin, edgeU, edgeV, dualU, dualV, area, fillsFrame, triangles, outline,
              cumulative);
}
void members(auto& archive, Is<Sphere> auto& s) {
  auto& [center, radius, inward] = s;
  transferAll(archive, center, radius, inward);
}
void members(auto& archive, Is<Cylinder> auto& s) {
  auto& [p0, p1, radius, inward] = s;
  transferAll(archive, p0, p1, radius, inward);
}
void members(auto& archive, Is<Cone> auto& s) {
  auto& [p0, p1, radius0, radius1, inward] = s;
  transferAll(archive, p0, p1, radius0, radius1, inward);
}
void members(auto& archive, Is<Ring> auto& s) {
  auto& [center, normal, inner, outer] = s;
  transferAll(archive, center, normal, inner, outer);
}
void members(auto& archive, Is<Mesh> auto& m) {
  auto& [positions, normals, texcoords, triangles, cumulative] = m;
  transferAll(archive, positions, normals, texcoords, triangles, cumulative);
}

// Materials

void members(auto& archive, Is<SpecularLobe> auto& l) {
  auto& [reflectance, roughness, distribution] = l;
  transferAll(archive, reflectance, roughness, distribution);
}
void members(auto& archive, Is<Opaque> auto& s) {
  auto& [diffuse, texture, specular] = s;
  transferAll(archive, diffuse, texture, specular);
}
void members(auto& archive, Is<Mirror> auto& s) {
  auto& [reflectance] = s;
  transferAll(archive, reflectance);
}
void members(auto& archive, Is<ThinGlass> auto& s) {
  auto& [transmissivity, ior] = s;
  transferAll(archive, transmissivity, ior);
}
void members(auto& archive, Is<Dielectric> auto& s) {
  auto& [transmission, ior] = s;
  transferAll(archive, transmission, ior);
}
void members(auto& archive, Is<Trans> auto& s) {
  auto& [diffuse, through, reflection, transmission] = s;
  transferAll(archive, diffuse, through, reflection, transmission);
}
void members(auto& archive, Is<SpotCone> auto& c) {
  auto& [fullAngle, direction] = c;
  transferAll(archive, fullAngle, direction);
}
void members(auto& archive, Is<DirectionTable> auto& t) {
  auto& [rows, columns, values] = t;
  transferAll(archive, rows, columns, values);
}
void members(auto& archive, Is<EmissionPattern> auto& p) {
  auto& [table, frame, scale, normal] = p;
  transferAll(archive, table, frame, scale, normal);
}
void members(auto& archive, Is<Emission> auto& e) {
  auto& [radiance, bothSides, spot, pattern, seenOnly] = e;
  transferAll(archive, radiance, bothSides, spot, pattern, seenOnly);
}
void members(auto& archive, Is<Material> auto& m) {
  auto& [name, surface, emission, coverage, filter] = m;
  transferAll(archive, name, surface, emission, coverage, filter);
}

// Lights

void members(auto& archive, Is<AreaLight> auto& l) {
  auto& [primitive] = l;
  transferAll(archive, primitive);
}
void members(auto& archive, Is<PointLight> auto& l) {
  auto& [position, intensity] = l;
  transferAll(archive, position, intensity);
}
void members(auto& archive, Is<SpotLight> auto& l) {
  auto& [position, direction, intensity, cosInner, cosOuter] = l;
  transferAll(archive, position, direction, intensity, cosInner, cosOuter);
}
void members(auto& archive, Is<LambertPointLight> auto& l) {
  auto& [position, direction, intensity] = l;
  transferAll(archive, position, direction, intensity);
}
void members(auto& archive, Is<Photometry> auto& p) {
  auto& [verticals, horizontals, candela, opening] = p;
  transferAll(archive, verticals, horizontals, candela, opening);
}
void members(auto& archive, Is<PhotometricLight> auto& l) {
  auto& [position, frame, photometry, scale] = l;
  transferAll(archive, position, frame, photometry, scale);
}
void members(auto& archive, Is<SunLight> auto& l) {
  auto& [direction, angularRadius, radiance] = l;
  transferAll(archive, direction, angularRadius, radiance);
}
void members(auto& archive, Is<UniformSky> auto& s) {
  auto& [radiance] = s;
  transferAll(archive, radiance);
}
void members(auto& archive, Is<RadianceSky> auto& s) {
  auto& [kind, zenith, ground, normalization, sun] = s;
  transferAll(archive, kind, zenith, ground, normalization, sun);
}
void members(auto& archive, Is<CieSky> auto& s) {
  auto& [type, zenith, ground, sun] = s;
  transferAll(archive, type, zenith, ground, sun);
}
void members(auto& archive, Is<PerezSky> auto& s) {
  auto& [diffuse, ground, coefficients, sun] = s;
  transferAll(archive, diffuse, ground, coefficients, sun);
}
void members(auto& archive, Is<TabulatedSky> auto& s) {
  auto& [table, frame] = s;
  transferAll(archive, table, frame);
}
void members(auto& archive, Is<DomeLight> auto& l) {
  auto& [axis, halfAngle, scale, distribution, up] = l;
  transferAll(archive, axis, halfAngle, scale, distribution, up);
}
void members(auto& archive, Is<Light> auto& l) {
  auto& [name, emitter, scale, standby] = l;
  transferAll(archive, name, emitter, scale, standby);
}

// The rest

void members(auto& archive, Is<Primitive> auto& p) {
  auto& [shape, material, object] = p;
  transferAll(archive, shape, material, object);
}
void members(auto& archive, Is<Object> auto& o) {
  auto& [name, parent] = o;
  transferAll(archive, name, parent);
}
void members(auto& archive, Is<Texture> auto& t) {
  auto& [name, width, height, texels] = t;
  transferAll(archive, name, width, height, texels);
}
void members(auto& archive, Is<View> auto& v) {
  auto& [name, kind, position, direction, up, horizontal, vertical] = v;
  transferAll(archive, name, kind, position, direction, up, horizontal, vertical);
}
void members(auto& archive, Is<Placement> auto& p) {
  auto& [primitive, rest, matrix, present] = p;
  transferAll(archive, primitive, rest, matrix, present);
}
void members(auto& archive, Is<SwitchedOff> auto& s) {
  auto& [light, scale] = s;
  transferAll(archive, light, scale);
}
void members(auto& archive, Is<Scene> auto& s) {
  auto& [metres, origin, efficacy, up, materials, primitives, objects, lights, backdrops, textures, views, placements,
         off] = s;
  transferAll(archive, metres, origin, efficacy, up, materials, primitives, objects, lights, backdrops, textures, views,
              placements, off);
}

}  // namespace deltalux::io
