#pragma once
// The particles of a scene: paths from lights and diffuse surfaces over mirrors, gloss and glass to the diffuse
// surfaces where they land, (L|D) S+ D [GD01 2.1]. They carry throughput, not power: what a particle deposits is its
// throughput times what its sender sends today, so iterations, dimmed lights and new diffuse colours trace nothing.
//
// They are a function of scene, seed and target count alone: not of the solution, the number of threads, or the history
// of edits. Every path keeps where it went, blocked ones too, so that an edit can find those it touches.
//
// What links there are, and how many paths each has, depends on the shapes as they were read (rest), not on where edits
// have put them: a motion changes the paths that it touches and no others. (Departure: the paper's links follow every
// edit.) Estimates stay exact in the mean, whatever moved; what moves far into the light has fewer particles than it
// would deserve.
// Memory: about 16 bytes a vertex, 41 a path, 32 an impact.
#include <span>

#include "base/large_array.hpp"
#include "particles/ds_links.hpp"
#include "particles/impact.hpp"
#include "particles/path_account.hpp"

namespace deltalux::particles {

/// Paths of one link are contiguous.
struct ParticleLink {
  LinkEnds ends;
  std::uint64_t key = 0;
  std::uint32_t firstPath = 0, paths = 0;
  float scale = 0;   // one over the number of samples, or over the chance that there is the one
  float albedo = 1;  // greatest of its receiver: no more of light is passed on
};

/// What became of particle flux, gray [W], with the nominal exitance of senders: what goes in comes out, in the mean.
struct ParticleLedger {
  double entered = 0;    // from lights and diffuse surfaces, at surfaces that take no particles (mirrors, glass)
  double passed = 0;     // passed on by surfaces that take particles (plastic, brass), of light that they have anyway
  double deposited = 0;  // on surfaces that take particles
  double absorbed = 0;   // by mirrors, glass and media
  double escaped = 0;    // out of the scene
  double cut = 0;        // by the depth limit

  /// What chance decisions gained or lost.
  double residue() const { return entered + passed - deposited - absorbed - escaped - cut; }
};

/// Where a path's vertices and impacts stand.
struct PathRange {
  std::uint32_t vertex = 0, impact = 0;     // first
  std::uint16_t vertices = 0, impacts = 0;  // how many
};

struct Particles {
  // Who sends: surfaces their radiosity, lights their scale; and what it is taken to be before it is known.
  std::vector<SenderCell> senderCells;
  std::vector<float> nominal;  // gray

  std::vector<ParticleLink> links;

  // Per path.
  LargeArray<std::uint32_t> link;            // index
  LargeArray<std::uint32_t> sender;          // cell
  LargeArray<std::uint32_t> originTriangle;  // of a mesh
  LargeArray<PathRange> range;
  LargeArray<PathAccount> account;
  LargeArray<std::uint8_t> termination;

  // Ranges may leave gaps where paths were traced anew.

  // Per vertex: origin, then every surface met; a path that leaves ends at a point outside. None: never traced.
  LargeArray<Vec3f> vertices;
  LargeArray<PrimitiveId> met;  // there, if anything was; where a target was not reached, what stood before it

  // Per impact.
  LargeArray<PrimitiveId> primitive;
  LargeArray<std::uint32_t> triangleAndSide;  // triangle * 2 + (front ? 0 : 1)
  LargeArray<glm::vec2> uv;
  LargeArray<Rgb> throughput;  // of its path alone; the link's scale comes on top

  double quantum = 0;        // flux that one particle stands for, by the estimate [W]
  std::uint64_t rays = 0;    // of the particles
  std::uint64_t pilots = 0;  // rays that decided about links and counts

  std::size_t paths() const { return link.size(); }
  std::uint32_t firstImpact(std::size_t path) const { return range[path].impact; }
  std::uint32_t endImpact(std::size_t path) const { return range[path].impact + range[path].impacts; }
  std::span<const Vec3f> verticesOf(std::size_t path) const {
    return std::span(vertices).subspan(range[path].vertex, range[path].vertices);
  }
  std::span<const PrimitiveId> metBy(std::size_t path) const {
    return std::span(met).subspan(range[path].vertex, range[path].vertices);
  }
  /// Size of the arrays of impacts, with gaps.
  std::size_t impactSlots() const { return primitive.size(); }
  std::uint64_t impacts() const;
  /// Paths that reached a receiver of their link; that were deposited somewhere; that the depth limit ended.
  std::uint64_t arrived() const;
  std::uint64_t deposited() const;
  std::uint64_t cut() const;
  /// Flux that one unit of a path's throughput stands for, by its nominal sender.
  double weight(std::size_t path) const { return double(links[link[path]].scale) * nominal[sender[path]]; }
  ParticleLedger ledger() const;
  std::size_t memoryBytes() const;
  /// Closes the gaps.
  void compact();
  /// Room for paths that are traced anew, so that none of them has to wait for all to be copied.
  void makeRoom();
  /// Of everything that says where particles go and what they carry; equal for equal particles.
  std::uint64_t hash() const;
};

/// Recounts: ranges fit, throughputs are finite and not negative, impacts lie on surfaces of the scene. Throws
/// std::logic_error with the first violation.
void validate(const Particles&, const Scene&);

struct ParticleSettings {
  std::uint64_t count = 0;  // target
  std::uint64_t seed = 1;
  int maxDepth = 64;       // non-diffuse events
  bool ofSurfaces = true;  // diffuse surfaces send some, too, and not lights alone
};

/// Traces the particles of a scene. Throws nothing of its own. A scene with edits is evaluated at rest, with a tracer
/// of its own.
Particles traceParticles(const Scene&, const tracing::RayTracer&, const ParticleSettings&);

}  // namespace deltalux::particles
