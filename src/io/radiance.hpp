#pragma once
// The Radiance reader: scene descriptions (.rad and files without a known extension) with their `!` lines evaluated
// natively.
//
// Text -> objects and commands (radiance/rad_parser) -> one flat list (expander, with xform and the generators) ->
// scene (scene_builder: modifiers resolved in order, shapes, lights, names). No shell is run and no text is printed in
// between. Skipped with a count in the report: patterns, textures, mixtures (their first part stays), instances and
// compiled meshes. Refused: materials without a counterpart (antimatter, prisms, BSDF data ...) where a surface uses
// them. Cost: linear in the expanded objects, about 1 microsecond each.
#include <deltalux/io.hpp>
#include <string>

#include "io/radiance/expander.hpp"

namespace deltalux::io {

/// The files as one scene, in order and with one namespace. Throws InputError.
ImportedScene loadRadiance(const std::vector<std::filesystem::path>& files, const ImportSettings&);

/// As above, from one text; what it includes comes through `files`.
ImportedScene readRadiance(const radiance::SourceFile&, radiance::FileAccess& files, const ImportSettings&,
                           const radiance::ExpansionLimits& = {});

}  // namespace deltalux::io
