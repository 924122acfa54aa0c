#pragma once
// Glare: how much luminaires and bright parts of the view disturb somebody who looks somewhere. UGR is about electric
// lighting [CIE 117; CIE 147], DGP about daylight [WC06]. docs/glare.md has the equations.
#include <deltalux/image.hpp>
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace deltalux {

/// Where somebody looks from, and the line of sight; neither direction nor up need be unit, nor at right angles.
struct Eye {
  Vec3 position{0}, direction{0, 1, 0}, up{0, 0, 1};  // [scene units]
};

/// Level lines of sight from a place, all round in equal steps, `along` first; `along` and `up` are unit, at right
/// angles.
std::vector<Eye> eyesAllRound(const Vec3& position, const Vec3& along, const Vec3& up, int directions);

/// Something bright, seen from an eye.
struct GlareSource {
  Vec3 direction{0, 1, 0};   // unit, towards its middle by luminance
  double luminance = 0;      // L, mean [cd/m2]
  double solidAngle = 0;     // omega [sr]
  double positionIndex = 1;  // P
};

/// How little a source at `towards` disturbs, relative to one on the line of sight: Guth's above it, and of one below
/// it Iwata's and Tokura's. [Guth63; IT97] At least 1; not to be asked behind the eye.
double positionIndex(const Eye&, const Vec3& towards);

/// 8 log10(0.25 / Lb * sum L^2 omega / P^2) [CIE 117]. -infinity where nothing shines, infinity where `background`, Lb
/// [cd/m2], is 0 beside something that does.
double unifiedGlareRating(std::span<const GlareSource>, double background);

/// In [0, 1]; `illuminance` on the eye, facing the line of sight [lux]. [WC06; Wienold09]
double daylightGlareProbability(std::span<const GlareSource>, double illuminance);

// Pictures of 180 degrees: square, x and y in [-1, 1] rightwards and upwards, their distance from the middle is the
// angle to the line of sight over 90 degrees (Radiance's -vta).

/// Unit; nullopt beyond the rim.
std::optional<Vec3> fisheyeDirection(const Eye&, double x, double y);
/// Where a direction is in the picture.
Vec2 fisheyePlace(const Eye&, const Vec3& towards);

struct GlareSourceSettings {
  double threshold = 2000;   // brighter parts are sources [cd/m2]
  double withinAngle = 0.2;  // parts this near are one source [radians]
};

/// The sources in such a picture of radiance, the brightest by L^2 omega / P^2 first. `of`, when given, becomes for
/// every pixel the number of its source, -1 for none. [Wienold09]
std::vector<GlareSource> glareSources(const Image& fisheye, const Eye&, const GlareSourceSettings& = {},
                                      std::vector<int>* of = nullptr);

struct GlareSettings {
  int size = 512;  // of the picture's side [pixels]
  int samplesPerPixel = 16;
  double error = 0.01;  // relative standard error of illuminances on the eye
  GlareSourceSettings sources;
  std::optional<Vec3> task;  // a place that is looked at: sources are `taskContrast` times as bright as what is within
  double taskAngle = 0.25;   // `taskAngle` of its direction [radians], on average
  double taskContrast = 5;
  std::uint64_t seed = 1;
};

/// A luminaire in front of an eye, as far as it is seen: the lights of it, by what they send towards the eye.
struct LuminaireSeen {
  std::string name;
  std::vector<LightId> lights;
  GlareSource source;
  double illuminance = 0;  // straight from it on the eye [lux]
  bool small = false;      // it is taken to have a luminous area of 0.005 m2, across the line to the eye [CIE 147]
};

/// Of the luminaires: all lights but suns and skies.
struct UnifiedGlare {
  Eye eye;
  double rating = -std::numeric_limits<double>::infinity();  // UGR
  double background = 0;                                     // Lb: illuminance on the eye without them over pi [cd/m2]
  std::vector<LuminaireSeen> luminaires;                     // those that disturb most first
};

/// UGR for each eye. Lights of one object, or of parts of one, that touch are one luminaire. Luminance is the mean over
/// the parts that are seen, by rays to the luminous area; of measured lights intensity over the projected luminous
/// area that their file tells. Cost: some ten thousand rays an eye. Throws Interrupted.
std::vector<UnifiedGlare> unifiedGlare(const SolutionView&, std::span<const Eye>, const GlareSettings& = {},
                                       Progress* = nullptr);

struct DaylightGlare {
  Eye eye;
  double probability = 0;            // DGP
  double illuminance = 0;            // on the eye [lux]
  double threshold = 0;              // from which something is a source [cd/m2]
  std::vector<GlareSource> sources;  // those that disturb most first
  std::vector<int> sourceOf;         // by pixel of the picture: its source, or -1
  Image picture;                     // fisheye, radiance; the discs of suns are left out
};

/// DGP for an eye, by a fisheye picture; discs of suns, as far as they are seen, are sources by themselves. Throws
/// Interrupted.
DaylightGlare daylightGlare(const SolutionView&, const Eye&, const GlareSettings& = {}, Progress* = nullptr);

/// The picture for a screen: sources tinted and numbered, luminaires (when given) outlined by a ring of their size.
DisplayImage markGlare(const DaylightGlare&, const UnifiedGlare* = nullptr);

/// What was found, as JSON text; positions in the coordinates of the scene's files. Numbers that are infinite are null.
std::string toJson(const Scene&, const DaylightGlare*, std::span<const UnifiedGlare>);
/// Into a file, atomically. Throws OutputError.
void writeGlare(const std::filesystem::path&, const Scene&, const DaylightGlare*, std::span<const UnifiedGlare>);

}  // namespace deltalux
