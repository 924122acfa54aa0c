#pragma once
// Radiance's scene generators, evaluated natively. Each takes the words after its name, as its manual page has them,
// and returns the objects that its output would hold, in its order and under its names. Wrong arguments are
// InputErrors. [Radiance manual pages genbox(1), genprism(1), genrev(1), gensurf(1), genworm(1), gensky(1),
// gendaylit(1)]
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/radiance/file_access.hpp"
#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

struct GeneratorInput {
  std::span<const std::string> words;
  SourceLine where;
  std::function<SourceFile(const std::string& name)> open;  // throws InputError when there is no such file
  std::size_t mostObjects = 0;                              // more than this are an InputError
};

/// A box with the origin as one corner. Departure: rounded boxes stay exact with -i (tubes and bubbles) and with -n
/// (cylinders and spheres), where genbox would tessellate; -s is then implied, and -o is refused.
std::vector<RadObject> genbox(const GeneratorInput&);
std::vector<RadObject> genprism(const GeneratorInput&);
std::vector<RadObject> genrev(const GeneratorInput&);
/// Departure: with -s the surface is one mesh with genuine vertex normals, where gensurf writes polygons with textures.
/// Data files for z and -o are refused.
std::vector<RadObject> gensurf(const GeneratorInput&);
std::vector<RadObject> genworm(const GeneratorInput&);
std::vector<RadObject> gensky(const GeneratorInput&);
/// Departures: the sky is normalised by quadrature where gendaylit adds 145 patches (1 to 2 % apart), and the ground
/// gets what sun and sky send to it; with -ang the sun is at its mean distance. -i and -C are refused.
std::vector<RadObject> gendaylit(const GeneratorInput&);

}  // namespace deltalux::io::radiance
