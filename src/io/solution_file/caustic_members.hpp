#pragma once
// The members of caustic textures, and of light by groups of lights, for archives.
#include "caustics/caustics.hpp"
#include "io/solution_file/scene_members.hpp"
#include "solution/light_columns.hpp"

namespace deltalux::io {

void members(auto& archive, Is<caustics::PlaneChart> auto& c) {
  auto& [origin, alongS, alongT] = c;
  transferAll(archive, origin, alongS, alongT);
}
void members(auto& archive, Is<caustics::TurnChart> auto& c) {
  auto& [radius0, slope, sphere] = c;
  transferAll(archive, radius0, slope, sphere);
}
void members(auto& archive, Is<caustics::Chart> auto& c) {
  auto& [map, size] = c;
  transferAll(archive, map, size);
}
void members(auto& archive, Is<caustics::Charts> auto& c) {
  auto& [all, ofTriangle] = c;
  transferAll(archive, all, ofTriangle);
}
void members(auto& archive, Is<caustics::Region> auto& r) {
  auto& [lower, upper] = r;
  transferAll(archive, lower, upper);
}
void members(auto& archive, Is<caustics::CausticTexture> auto& t) {
  auto& [chart, region, width, height, closed, poleAtStart, poleAtEnd, texels, areas, flux, particles] = t;
  transferAll(archive, chart, region, width, height, closed, poleAtStart, poleAtEnd, texels, areas, flux, particles);
}
void members(auto& archive, Is<caustics::SurfaceCaustics> auto& s) {
  auto& [primitive, front, charts, textures] = s;
  transferAll(archive, primitive, front, charts, textures);
}
void members(auto& archive, Is<caustics::Caustics> auto& c) {
  auto& [surfaces, ofPrimitive] = c;
  transferAll(archive, surfaces, ofPrimitive);
}

void members(auto& archive, Is<LightGroup> auto& g) {
  auto& [name, lights] = g;
  transferAll(archive, name, lights);
}
void members(auto& archive, Is<LightColumn> auto& c) {
  auto& [scales, direct, indirect, particle, deviation, caustics] = c;
  transferAll(archive, scales, direct, indirect, particle, deviation, caustics);
}
void members(auto& archive, Is<LightColumns> auto& c) {
  auto& [groups, of] = c;
  transferAll(archive, groups, of);
}

}  // namespace deltalux::io
