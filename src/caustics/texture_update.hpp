#pragma once
// Keeps caustic textures up to edits of the scene: what an edit did not change stays as it is, to the bit.
//
// Every impact knows the flux that it had when its side was last looked at: when its textures were made, or when it was
// found to need none. After an edit
//   - the sum over a tile of a side (surface_tiles.hpp) of the differences, each taken positive, so that light that
//   moves
//     within a tile counts too, is held against the light that is there: of particles and others, as errors are;
//   - a side where that is nowhere more than a tenth of the target error, nor a quarter of the particles' own noise, at
//     any size of tiles, is left alone; where there is no texture, half the target error is what a texture could be
//     for. Changes add up over edits, since they are counted from when the textures were made;
//   - light that became more or less as a whole, as of a dimmed lamp, is taken for a change only of what is left after
//   a
//     common factor; textures are multiplied by it;
//   - all other sides are evaluated and made again (adaptive_textures.hpp), and so are those where other light has
//   changed so
//     much that noise matters more, or less, than it did. [GD01 4: textures whose particles changed]
// Cost: some nanoseconds an impact, and 0.25 microseconds a texel of what is made again. Memory: 12 bytes an impact.
#include "caustics/caustics.hpp"
#include "caustics/surface_tiles.hpp"
#include "particles/transfer.hpp"

namespace deltalux::caustics {

class TextureUpdate {
 public:
  struct Parts {
    const Scene& scene;
    const hierarchy::Elements& elements;
    const particles::Particles& particles;
  };
  struct Report {
    std::uint64_t evaluated = 0;  // sides whose light has changed
    std::uint64_t rebuilt = 0;    // textures made again
    std::uint64_t scaled = 0;     // sides whose textures were multiplied
  };

  /// Of textures that show the particles as they are now, sent with the light that there is now. The parts must outlive
  /// this.
  TextureUpdate(const Parts&, const particles::ParticleTransfer&, double error);

  /// Brings the textures up to what was traced again, and to today's light. `transfer` has taken it in. Not for updates
  /// of all particles, or compacted ones: then make new textures, and a new one of these.
  Report follow(const particles::ParticleUpdate&, const particles::ParticleTransfer&, Caustics&);

  std::size_t memoryBytes() const;

 private:
  /// What was known of a side when it was last looked at.
  struct Look {
    RgbSum flux{0.0};
    double background = 0;
  };
  struct Tile {
    RgbSum now{0.0};
    double difference = 0, squares = 0;
  };

  void takeIn(const particles::ParticleUpdate&);
  LargeArray<Rgb> weigh(const particles::ParticleTransfer&);
  void compare();
  RgbSum fluxOf(std::size_t side) const;
  bool fewParticles(const SurfaceTiles::Side&) const;
  static std::vector<Tile> halved(const std::vector<Tile>&, std::uint32_t across);
  bool changed(std::size_t side, double background, bool textured) const;
  std::vector<particles::Impact> depositsOn(const std::vector<char>& sides, const LargeArray<Rgb>& powers) const;
  void remember(const std::vector<char>& sides, const std::vector<double>& background);

  Parts parts_;
  double error_;
  SurfaceTiles tiles_;
  LargeArray<std::uint32_t> tileOf_;  // by slot of impact
  LargeArray<float> then_, now_;      // gray flux by slot: when its side was last looked at; today
  std::vector<Look> looks_;           // by side
  std::vector<Tile> tile_;
};

}  // namespace deltalux::caustics
