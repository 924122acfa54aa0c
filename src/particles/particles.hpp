#pragma once
// The particles of a scene: paths from lights and diffuse surfaces over mirrors, gloss and glass to the diffuse
// surfaces where they land, (L|D) S+ D [GD01 2.1]. They carry throughput, not power: what a particle deposits is its
// throughput times what its sender sends today, so iterations, dimmed lights and new diffuse colours trace nothing.
//
// They are a function of scene, seed and target count alone: not of the solution, the number of threads, or the history
// of edits. Every path keeps where it went, blocked ones too, so that an edit can find those it touches.
// Memory: about 12 bytes a vertex, 20 a path, 32 an impact.
#include "particles/ds_links.hpp"
#include "particles/impact.hpp"

namespace deltalux {

/// Paths of one link are contiguous.
struct ParticleLink {
  LinkEnds ends;
  std::uint64_t key = 0;
  std::uint32_t firstPath = 0, paths = 0;
  float scale = 0;  // one over the number of samples, or over the chance that there is the one
};

/// What became of particle flux, gray [W], with the coarse exitance of diffuse senders: emitted = passed on at the
/// first surface, and so on. Sampling makes each right in the mean only.
struct ParticleLedger {
  double arrived = 0;   // at a receiver, before its first non-diffuse event
  double absorbed = 0;  // by surfaces, of what they do not pass on; all of it, diffuse parts included
  double escaped = 0;   // out of the scene
  double ended = 0;     // cut by the depth limit
  double roulette = 0;  // lost less gained in chance decisions: its mean is 0

  double residue() const { return arrived - absorbed - escaped - ended - roulette; }
  ParticleLedger& operator+=(const ParticleLedger&);
};

struct Particles {
  // Who sends: surfaces their radiosity, lights their scale; and what it is taken to be before it is known.
  std::vector<SenderCell> senderCells;
  std::vector<float> nominal;  // gray

  std::vector<ParticleLink> links;

  // Per path.
  std::vector<std::uint32_t> link;            // index
  std::vector<std::uint32_t> sender;          // cell
  std::vector<std::uint32_t> originTriangle;  // of a mesh
  std::vector<std::uint32_t> vertexBegin{0};  // one more
  std::vector<std::uint32_t> impactBegin{0};  // one more

  // Per vertex: origin, then every surface met; a path that leaves ends at a point outside. None: never traced.
  std::vector<Vec3f> vertices;

  // Per impact.
  std::vector<PrimitiveId> primitive;
  std::vector<std::uint32_t> triangleAndSide;  // triangle * 2 + (front ? 0 : 1)
  std::vector<glm::vec2> uv;
  std::vector<Rgb> throughput;  // of its path alone; the link's scale comes on top

  ParticleLedger ledger;
  double quantum = 0;            // flux that one particle stands for, by the estimate [W]
  std::uint64_t rays = 0;        // of the particles
  std::uint64_t looks = 0;       // rays that decided about links and counts
  std::uint64_t arrived = 0;     // paths that reached a receiver of their link
  std::uint64_t depthLimit = 0;  // paths that it ended

  std::size_t paths() const { return link.size(); }
  std::size_t impacts() const { return primitive.size(); }
  /// Paths with an impact.
  std::uint64_t landed() const;
  std::size_t memoryBytes() const;
  /// Of everything that says where particles go and what they carry; equal for equal particles.
  std::uint64_t hash() const;
};

/// Recounts: ranges fit, throughputs are finite and not negative, impacts lie on surfaces of the scene. Throws
/// std::logic_error with the first violation.
void validate(const Particles&, const Scene&);

struct ParticleSettings {
  std::uint64_t count = 0;  // target
  std::uint64_t seed = 1;
  int maxDepth = 64;  // non-diffuse events
};

/// Traces the particles of a scene. Throws nothing of its own.
Particles traceParticles(const Scene&, const RayTracer&, const ParticleSettings&);

}  // namespace deltalux
