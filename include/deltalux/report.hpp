#pragma once
// What a run did, as numbers: the contents of `--report FILE.json`. Field names are the JSON keys, in camel case here
// and in snake case there; seconds, bytes and counts.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace deltalux {

struct SceneStats {
  std::uint64_t objects = 0, primitives = 0, polygonsIfTessellated = 0, lights = 0;
  std::map<std::string, std::size_t> ignored;  // on import, by kind
};

struct PhaseTimes {  // [s]
  double import = 0, hierarchy = 0, refine = 0, visibility = 0, gather = 0, particles = 0, textures = 0, total = 0;
};

struct WorkCounts {
  std::uint64_t elements = 0, leafElements = 0, links = 0, linksDs = 0, lines = 0, particles = 0, impacts = 0,
                raysVisibility = 0, raysParticles = 0, iterations = 0, causticTextures = 0;
  double causticTextureMeanSize = 0;  // texels a side
};

struct MemoryBytes {
  std::uint64_t elements = 0, links = 0, lines = 0, particles = 0;
  // Of what knows the paths near an object in motion; 0 before. Over lines a region and a bit a path, over links the
  // octree.
  std::uint64_t octree = 0;
  std::uint64_t textures = 0, peakRss = 0;
};

/// Relative error of irradiance: what was asked for, and what the solution's own samples say, by area of what is lit;
/// empty where the method cannot tell (null in JSON).
struct ErrorEstimate {
  double asked = 0;
  std::optional<double> estimatedMedian, estimatedP95;
};

/// Flux summed over the channels' photometric weights [W]; empty where a run did not measure it (null in JSON).
struct EnergyLedger {
  std::optional<double> emittedW, absorbedW, escapedW, unsettledW;
};

/// One edit.
struct StepReport {
  std::string op, object;
  PhaseTimes times;
  std::uint64_t linksVisited = 0, linksChanged = 0;
  std::uint64_t leavesChanged = 0;  // whose lines are others, new or gone: each counted once
  std::uint64_t particlesRetraced = 0, particlesTotal = 0, texturesRebuilt = 0;
  std::uint64_t rays = 0;        // all that were traced, for whatever purpose
  std::uint64_t deferred = 0;    // in motion: leaves, surfaces, lights and links of particles that wait
  std::optional<double> staleW;  // in motion: light that is not yet where it would be [W]; absent in JSON otherwise
};

/// An updated solution against one solved from scratch.
struct CheckReport {
  double solveS = 0;
  double medianRelDiff = 0, p95RelDiff = 0, maxRelDiff = 0;  // of irradiance
  // By a hash of each: patches of the mesh; where lines go from it; where particles do.
  bool meshIdentical = false, linesIdentical = false, particlesIdentical = false;
};

/// What the unbiased integrator did; only `deltalux reference` has it.
struct ReferenceReport {
  std::uint64_t paths = 0, rays = 0;
  double seconds = 0;
};

/// The caustic textures of one side of a surface.
struct CausticReport {
  struct Texture {
    std::uint64_t width = 0, height = 0, particles = 0;
  };
  std::string surface;          // name of its object
  std::uint64_t primitive = 0;  // index in the scene
  bool front = true;
  std::vector<Texture> textures;  // of the lit regions, then those of the rest
  double fluxW = 0;               // of the particles that it shows, summed with the channels' photometric weights
};

struct RunReport {
  std::string command, version, scene;
  std::uint64_t threads = 0, seed = 0;
  SceneStats sceneStats;
  PhaseTimes times;
  WorkCounts counts;
  MemoryBytes memory;
  ErrorEstimate error;
  EnergyLedger energy;
  std::vector<StepReport> steps;
  std::optional<CheckReport> check;          // null in JSON when nothing was checked
  std::vector<CausticReport> caustics;       // absent in JSON when there are none
  std::optional<ReferenceReport> reference;  // absent in JSON for other commands
};

/// The report as JSON text, keys in the order above, ends with a newline.
std::string toJson(const RunReport&);
/// toJson into a file, atomically. Throws OutputError.
void writeReport(const std::filesystem::path&, const RunReport&);

/// Largest resident set of this process so far [bytes]; 0 where the system does not say.
std::uint64_t peakResidentBytes();

}  // namespace deltalux
