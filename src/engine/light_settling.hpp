#pragma once
// Light settles again after a change: only rows, and surfaces under particles, are gathered that the change can matter
// to, and only what stands above changed leaves is averaged anew. It serves whatever changes light: rows, particles
// traced anew, a lamp that is dimmed, paint.
//
// Every row knows its form factors towards 64 regions of the scene. When patches of a region send otherwise, a row is
// taken to miss so much of it as its factor says: it is gathered when what it misses, summed since it last was, matters
// beside its light, or when all rows together miss more than may be, those that miss the most first. So light that
// changes a little everywhere is gathered where it changes much, and small changes add up until they are heard.
// Cost: one look a pass at each row of blocks that have factors towards what changed, half a microsecond a row that is
// gathered; 98 bytes an element.
#include <array>

#include "engine/scene_regions.hpp"
#include "particles/transfer.hpp"
#include "radiosity/leaf_transfers.hpp"

namespace deltalux::engine {

/// What is another since light was settled.
struct LightChanges {
  std::vector<hierarchy::ElementId> rows;  // leaves whose rows are others, or gone; their direct light is up to date
  std::vector<hierarchy::ElementId> surfaces;  // that particles lie otherwise on
  bool allParticles = false;                   // they were placed anew
  std::vector<hierarchy::ElementId> painted;   // input-level patches of other reflectances
  bool lights = false;                         // some send otherwise
};

class LightSettling {
 public:
  struct Parts {
    const Scene& scene;
    const radiosity::LeafTransfers& rows;
    const particles::ParticleTransfer& particles;
  };

  /// From settled light: all was last gathered with the radiosities that there are.
  LightSettling(const Parts&, const hierarchy::Elements&);

  /// Gathers until what leaves fail to reflect of what they miss is less than `tolerated` [W, gray], or `most` passes
  /// are done. Returns that; the next call takes it up. Adds to `passes`.
  double settle(const Parts&, hierarchy::Elements&, const LightChanges&, double tolerated, int most,
                std::uint64_t& passes);

 private:
  static constexpr int kRegions = SceneRegions::kCount;
  using Factors = std::array<std::uint8_t, kRegions>;  // towards regions, in parts of 255, rounded up

  /// What to gather, and leaves that may reflect otherwise beside those.
  struct Work {
    std::vector<hierarchy::ElementId> rows, surfaces, leaves;  // rows: ascending, before others that share join
  };
  struct News {
    SceneRegions::Set regions = 0;
    std::array<float, kRegions> change{};  // of radiosity, gray mean over all that a region has [W/m2]
    double withheld = 0;                   // change that is too small to be told [W]
  };

  /// Patches whose radiosity may be another than seen.
  struct Unheard {
    std::vector<hierarchy::ElementId> patches;
    double change = 0, square = 0;  // of their radiosities, times area
    bool summed = true;             // whether these are up to date
  };

  void follow(const hierarchy::Elements&);
  void markRead(hierarchy::ElementId sender);
  void learn(const radiosity::LeafRow&);
  void addToBlock(std::size_t block, SceneRegions::Set);
  void learn(hierarchy::ElementId surface, const Parts&, const hierarchy::Elements&);
  Work firstWork(const Parts&, hierarchy::Elements&, const LightChanges&);
  void addRelit(const Parts&, hierarchy::Elements&, std::vector<hierarchy::ElementId>& leaves) const;
  void gather(const Parts&, hierarchy::Elements&, Work&, bool anew);
  void listen(const hierarchy::Elements&, std::span<const hierarchy::ElementId> leaves);
  News publish(const hierarchy::Elements&, double tolerated);
  /// Adds news to what rows miss; returns those that it matters to. `missed`: by those that it does not, as settle().
  Work readersOf(const News&, const Parts&, const hierarchy::Elements&, double tolerated, double& missed);

  SceneRegions regions_;
  // By element.
  std::vector<SceneRegions::Set> from_;           // regions that its row reads
  std::vector<Factors> factors_;                  // of its row
  std::vector<float> misses_;                     // irradiance that its row has not heard of, gray [W/m2]
  std::vector<SceneRegions::Set> particlesFrom_;  // of surfaces
  std::vector<char> read_;                        // rows or particles may have it for a sender
  std::vector<Rgb> seen_;                         // radiosity that is gathered
  radiosity::RowSurplus::Pools pools_;            // of rows that gather too much, as their neighbours have heard
  std::vector<char> listed_;                      // in unheard_

  // By blocks of elements one after another: what their rows have in common.
  static constexpr std::size_t kBlock = 1024;
  std::vector<SceneRegions::Set> blocksFrom_;  // regions that some of them read, or once did
  std::vector<char> blocksMiss_;               // whether some may have misses

  // By region.
  std::array<double, kRegions> area_{}, power_{};  // of its leaves, and what they send, about [W, gray]
  std::array<Unheard, kRegions> unheard_;
};

}  // namespace deltalux::engine
