#pragma once
// How the shadow rays of a small place are shared among lights, so that they go where light comes from: through the
// window, not at the wall around it. The unit square of numbers that samples a source (point_light.hpp) is divided
// where some of it is seen and some is not, or where it brings more here than there; rays are shared among the squares
// in proportion to their area times the root mean square of what one of their rays brings, which is least variance for
// few rays. That is known from the visibility estimates that stored lines have found, and learnt from rays of the very
// points that will be shaded, never from those that shade them: what these bring stays unbiased.
//
// No ray is to bring much more than the light there is, unless it is all of its light's: for that the number of rays
// grows, up to a limit, so that where something is seen after all that was thought to be hidden, it is no speck.
//
// Squares are in the order of the sources, whose neighbours stand side by side, and rays are dealt to them by
// systematic sampling: a pixel's rays are spread over all that it sees. (Adaptive importance sampling, as [Lepage78],
// by quadtrees.) Cost: the rays that are learnt from; a search by halves and a shadow ray a sample.
#include <span>
#include <vector>

#include "base/sobol.hpp"
#include "base/tuning.hpp"
#include "direct/point_light.hpp"
#include "direct/sky_light.hpp"

namespace deltalux::direct {

/// Rays that a point of its own learns from: one a cell of the sphere in each round.
inline constexpr int kLearnAtPoint = deltalux::tuning::kEverCloser * SkyCells::kCount;
/// Rays of one independent estimate of a meter: a first idea of a few.
inline constexpr int kEstimateRays = deltalux::tuning::kFewRays * deltalux::tuning::kPilots;

class Aim {
 public:
  Aim() = default;
  /// At one place, or at several together: `sources` ascending by id, each once.
  explicit Aim(std::span<const Source> sources);

  /// What was learnt of the sources that some of the places have, to learn more from there.
  Aim of(std::span<const Source> places) const;
  /// The same for shadow rays of one of the places: about `rays`, of which none is to
  /// bring much more than `light` [W/m2, gray].
  Aim at(std::span<const Source> place, float light, int rays) const;

  /// Learns by `rays` shadow rays from these places.
  void learn(const PointSampler&, std::span<const Receiver> places, int rays, std::uint64_t key);

  /// Whether it knows all these sources, ascending by id.
  bool holds(std::span<const Source>) const;
  bool dark() const { return !(total() > 0); }
  int rays() const { return rays_; }
  /// visit(Arrival) for each of rays() shadow rays that is not blocked: the sum of all of them is the estimate. `index`
  /// and `key` name the stratified numbers to use.
  template <class Visit>
  void sample(const PointSampler& light, const Receiver& x, std::uint32_t index, std::uint64_t key,
              const Visit& visit) const {
    if (dark()) return;
    const double shift = scrambledSobol(index, combineKeys(key, 1)).x;
    const ScrambledSobol numbers(combineKeys(key, 2));
    for (int k = 0; k < rays_; ++k) {
      const Square& square = squares_[indexAt(static_cast<float>((k + shift) / rays_))];
      const UnitPair u = numbers(index * static_cast<std::uint32_t>(rays_) + static_cast<std::uint32_t>(k));
      auto arrival = light.arrival(square.source, x, square.at(u));
      if (!arrival) continue;
      arrival->E *= total() / (square.weight * static_cast<float>(rays_));
      visit(*arrival);
    }
  }

 private:
  /// A part of a source's unit square.
  struct Square {
    std::uint32_t source = 0;
    Vec2 lower{0};
    double size = 1;
    float potential = 0;  // of the whole source
    float guess = 0;      // of its strength, before any ray looked at the square alone
    float strength = 0;   // root mean square of what a ray brings, by the source's whole square
    float weight = 0;     // that rays are shared by, over the square's area

    float area() const { return static_cast<float>(size * size); }
    float share() const { return area() * strength; }
    Vec2 at(const UnitPair& u) const { return lower + size * Vec2(u.x, u.y); }
  };
  /// What a ray that was learnt from brought.
  struct Look {
    std::uint32_t square;
    Vec2 u;
    float E;
  };

  float total() const { return cumulative_.empty() ? 0.0f : cumulative_.back(); }
  std::size_t indexAt(float part) const;
  void sumWeights();
  void share();
  void keepFromSpecks(float light, int rays);
  void look(const PointSampler&, std::span<const Receiver> places, int rays, std::uint64_t key,
            std::vector<Look>&) const;
  void evaluate(std::vector<Look>&);
  static bool uneven(const Square&, std::span<const Look>);
  void divide(const Square&, std::span<Look>, std::vector<Square>& squares, std::vector<Look>& looks) const;

  int rays_ = 1;
  std::vector<Square> squares_;  // by source
  std::vector<float> cumulative_;
};

/// The sources of several places, each with its most.
std::vector<Source> joined(std::span<const std::vector<Source>> places);

/// Irradiance at a point to a relative standard error of `error` of itself plus `ambient`, by batches of rays of their
/// own. `light`: about how much there is [W/m2, gray].
ProbeResult measure(const PointSampler&, std::span<const Source>, const Receiver&, float light, const Rgb& ambient,
                    double error, int maxSamples, std::uint64_t key);

}  // namespace deltalux::direct
