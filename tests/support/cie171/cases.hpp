#pragma once
// The analytical cases of CIE 171: scenes, points, and what their illuminance is. [CIE 171, 5]
#include <deltalux/engine.hpp>
#include <deltalux/probe.hpp>
#include <deltalux/scene.hpp>
#include <string>
#include <vector>

#include "support/cie171/facets.hpp"
#include "support/cie171/general_sky.hpp"

namespace deltalux::test::cie171 {

struct Case {
  std::string name, variant;  // "5.9", "1x1"
  Scene scene;
  std::vector<ProbePoint> points;
  std::vector<double> expected;  // [lx]; one, where the mean over all points is meant
  std::vector<double> known{};   // light of lamps at the points that is not a part of it [lx]; empty: none
};

/// Illuminance as `expected` has it, of readings at the points.
std::vector<double> valuesOf(const Case&, const std::vector<ProbeResult>&);
/// |value - expected| over the expected value, or over a hundredth of the largest where that is more; one by one.
std::vector<double> relativeErrors(const Case&, const std::vector<ProbeResult>&);

// 5.2 to 5.8: lamps, panes and reflection.

Scene blackRoom();
Case pointSource();                     // 5.2
Case areaSource();                      // 5.3
Case fluxInABlackRoom();                // 5.4: points of equal area over all faces
Case glassPane(int angle);              // 5.5: angle 0 to 4, of kPaneDegrees
Case diffuseReflection(bool onAWall);   // 5.6: meters in the air, or on a black wall
Case reflectionPastAScreen();           // 5.7
Case interreflection(int reflectance);  // 5.8: 0 to 5, of kWallReflectances
std::vector<Case> electricCases();      // all of them
constexpr double kPaneDegrees[] = {0, 30, 50, 60, 70};
constexpr double kWallReflectances[] = {.05, .2, .4, .5, .7, .9};

// 5.9 to 5.14: a black room of 4 x 4 x 3 m under a general sky.

/// What is around the room and how it is open.
struct Daylight {
  std::string name, variant;
  std::vector<Facet> facets;
  bool roof = false;  // open there, otherwise to the south
};

/// 5.9 (1x1, 4x4), 5.10 glazed, 5.11 (2x1, 4x3), 5.12 glazed, 5.13 under a horizontal mask, 5.14 behind a vertical one,
/// black before a grey ground and grey before a black one.
std::vector<Daylight> daylightVariants();
/// The first of such a name and variant.
Daylight findDaylight(const std::string& name, const std::string& variant);
/// The same, what is grey near the room cut into squares of a metre: the solver splits no leaf for light of the sky.
Daylight inTiles(Daylight);
/// A case of it with its surfaces in tiles.
void cutIntoTiles(Case&, const Daylight&);
/// Under a sky of that type, 10 klx on open ground: A to F on a wall from above, G to N on the floor.
Case daylightCase(const Daylight&, int sky);
constexpr std::size_t kFirstOnFloor = 6;  // of its points
/// The case's expected values alone, by Gauss's rule of that order, of the program's glass or of CIE 171's polynomial.
std::vector<double> daylightReference(const Daylight&, int sky, int order = 8, bool polynomialGlass = false);

}  // namespace deltalux::test::cie171
