#pragma once
// Scenes in glTF 2.0, as .gltf (JSON with buffers beside it or inside) and as .glb.
//
// What becomes what:
//   node                  object; its name is the path of node names from the root, joined by '/'. A '/' inside a
//   node's
//                         name becomes '_'; a node without a name is node<index>; equal names beside each other get
//                         '#2', '#3' ...
//   mesh primitive        per node that shows it: its planar faces as polygons where that is exact, else one mesh
//                         (io/planar_faces.hpp); in world coordinates, +Y up, metres. Triangles, strips and fans.
//   material              io/gltf/material.hpp; photometric values are divided by ImportSettings::luminousEfficacy.
//   camera                view, named as its object; looks along -Z
//   KHR_lights_punctual   point, spot; directional as a sun of 0.2665 degrees angular radius with the same illuminance
//   EXT_lights_ies        measured light. Its candelas are real ones, whatever the exporter's convention: 179 lm/W.
// Surfaces reflect on both sides, whatever doubleSided says; it decides whether emission leaves the back too.
// Only the default scene is read (the first, if none is marked). Ignored, counted and said in one warning: skins, morph
// targets, animations, points and lines, normal and occlusion textures, and extensions that change none of the above.
// Refused: compressed geometry (Draco, meshopt), files outside the scene's folder, anything out of range.
//
// [glTF 2.0] is the specification of the Khronos Group, version 2.0.1, with the registered extensions named here.
#include <deltalux/io.hpp>
#include <filesystem>
#include <string>
#include <string_view>

namespace deltalux::io {

/// Throws InputError: file, place in the JSON document, what to do.
ImportedScene loadGltf(const std::filesystem::path& file, const ImportSettings&);

/// The same from the bytes of a file called `name` in messages, whose references are looked for in `folder`.
ImportedScene readGltf(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                       const ImportSettings&);

}  // namespace deltalux::io
