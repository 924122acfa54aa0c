#pragma once
// Motion over lines: while something is dragged, shadows follow it on the mesh that there is. Direct light of leaves
// whose shadow rays an edit may have led elsewhere is asked again, those first that stand to gain or lose the most, as
// many as a frame has time for; what has changed is handed on over the lines as they were. Lights that are dimmed need
// no ray: all that they bring is there. The mesh, lines, skies' shadows, particles' ways and textures wait for the
// update, which makes of it all what a fresh solve would. [GD01 4.3]
#include <functional>

#include "direct/lamps.hpp"
#include "engine/relight.hpp"
#include "engine/scene_update.hpp"
#include "lines/iterate.hpp"
#include "particles/transfer.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

/// Seconds that a kind of work takes, by what it took last.
class LearnedCost {
 public:
  explicit LearnedCost(double guess) : seconds_(guess) {}

  double seconds() const { return seconds_; }
  /// `count` pieces took so long.
  void learn(double seconds, double count = 1) {
    if (count > 0) seconds_ = seconds / count;
  }

 private:
  double seconds_;
};

class LineMotion {
 public:
  /// Of a solution that has its memory, and keeps it until this is gone.
  explicit LineMotion(const Solution&);

  /// What an edit has changed waits from now on; what has moved has moved already. `particles`: on the mesh there is.
  void note(Solution&, const SceneUpdate&, const particles::ParticleTransfer* particles);
  /// As much as there is time for.
  void follow(Solution&, const std::function<double()>& secondsLeft);

  /// Leaves that wait, and the light that they have as long [W].
  std::size_t waiting() const { return waiting_; }
  double stale(const Solution&) const;

 private:
  std::vector<std::uint32_t> mostWorth(std::size_t count) const;
  void dim(Solution&, const particles::ParticleTransfer* particles);
  void light(Solution&, const direct::Lamps&, std::span<const std::uint32_t> leaves);

  hierarchy::LeafTable leaves_;
  lines::LeafLight light_;
  std::vector<std::vector<direct::LampLight>> lamps_;  // by leaf: what it has of suns and lamps
  std::vector<Rgb> direct_;                            // by leaf: all of that, dimmed [W/m2]
  Dimming dimming_;
  std::vector<float> worth_;  // by leaf: light that it may have [W]; 0: it does not wait
  std::size_t waiting_ = 0;
  LearnedCost leaf_{2e-5}, pass_{5e-3};
};

}  // namespace deltalux::engine
