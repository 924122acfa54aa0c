#pragma once
// Compiled parts of a scene, an instance's octree and a mesh of obj2mesh, by the source that lies beside them:
// `part.rad` for part.oct, `part.obj` for part.rtm. [Radiance reference manual, "Instance", "Mesh"]
#include <string>
#include <vector>

#include "io/radiance/rad_object.hpp"
#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

/// The name of the source that an instance or mesh was compiled from, by custom.
std::string sourceOfCompound(const RadObject&);
/// Where it stands, under its name; its modifier, where it has one, is that of all its surfaces. Throws InputError.
Placement placementOfCompound(const RadObject&);
/// The surfaces of a Wavefront file, with the names of their materials as modifiers; "void" where `definitions` have
/// none of that name. Throws InputError.
std::vector<RadObject> surfacesOfObj(const std::string& text, const std::string& name, const SourceLine&,
                                     const std::vector<RadObject>& definitions);

}  // namespace deltalux::io::radiance
