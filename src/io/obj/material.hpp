#pragma once
// MTL materials. What the numbers mean here:
//   Kd, Ks   diffuse and specular reflectance; where their sum exceeds 1 both are scaled down to it (counted).
//   Ns       the lobe's rms slope is sqrt(2 / (Ns + 2)); illum 1 has no lobe. [WMLT07]
//   Ke       emitted radiance [W/(sr m2)], from the front side
//   d, Tr    below 1 (or illum 4, 6, 7, 9: "glass"): thin glass of transmissivity Tf, or 1 - d without Tf (1 if d is
//   1),
//            and of index Ni. Nothing says whether a body is closed, so it is never a refracting one.
//   map_Kd   texture of the diffuse part, in place of Kd's share where Kd is 0
// Ignored and counted: every other map, the Pr/Pm parameters, options of map_Kd.
#include <deltalux/io.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/obj/check.hpp"

namespace deltalux::io {

/// Appends the materials of every file that `survey` names, and the textures that they use. Files and textures that are
/// not there are counted and named in the report. Throws InputError when a file leads out of `folder`, or with the line
/// of what io/obj/mtl.hpp refuses.
std::map<std::string, MaterialId> addObjMaterials(const ObjSurvey& survey, const std::string& name,
                                                  const std::filesystem::path& folder, Scene&, ImportReport&);

}  // namespace deltalux::io
