#pragma once
// What a small place sees of the lights, so that shadow rays go where light comes from: through the window, not at the
// wall around it. The unit square of numbers that samples a sender (direct_light.hpp) is divided where some of it is
// seen and some is not, or where it brings more here than there; shadow rays are shared among the squares in proportion
// to their area times the root mean square of what one of their rays brings, which is least variance. It is learnt from
// rays of the very points that will be shaded, and not from those that shade them: so what these bring stays unbiased.
// Squares that no ray has found lit keep a share that falls with the number of rays that looked.
//
// Squares are in the order of a curve that fills the sky, and rays are dealt to them by systematic sampling: a pixel's
// rays are spread over all that it sees. (Adaptive importance sampling, as [Lepage78], by quadtrees.)
// Cost: the rays that are learnt from; a search by halves and a shadow ray a sample.
#include <span>
#include <unordered_map>
#include <vector>

#include "base/sobol.hpp"
#include "radiosity/direct_light.hpp"
#include "render/reconstruction.hpp"

namespace deltalux::rendering {

class Sight {
 public:
  /// As the choice of a leaf has it, in whole senders.
  Sight(const hierarchy::Elements&, const radiosity::SenderChoice&);
  /// To learn from, for several leaves at once: as the choice of any of them has it.
  Sight(const hierarchy::Elements&, std::span<const radiosity::SenderChoice* const>);
  /// Of its senders, those of one leaf.
  Sight of(const radiosity::SenderChoice&) const;

  /// Learns by `rays` shadow rays from these places.
  void learn(const radiosity::DirectLight&, std::span<const radiosity::Receiver> places, int rays, std::uint64_t key);

  bool dark() const { return !(total() > 0); }
  /// visit(LightArrival) for each of `rays` shadow rays that is not blocked: the sum of all of them is the estimate.
  /// `index` and `key` name the stratified numbers to use.
  template <class Visit>
  void sample(const radiosity::DirectLight& direct, const radiosity::Receiver& x, int rays, std::uint32_t index,
              std::uint64_t key, const Visit& visit) const {
    if (dark()) return;
    const double shift = scrambledSobol(index, combineKeys(key, 1)).x;
    for (int k = 0; k < rays; ++k) {
      const Square& square = squareAt(static_cast<float>((k + shift) / rays));
      const UnitPair u =
          scrambledSobol(index * static_cast<std::uint32_t>(rays) + static_cast<std::uint32_t>(k), combineKeys(key, 2));
      auto arrival = direct.arrival(square.sender, x, square.at(u));
      if (!arrival) continue;
      arrival->E *= total() / (square.strength * static_cast<float>(rays));
      visit(*arrival);
    }
  }

 private:
  Sight() = default;

  /// A part of a sender's unit square.
  struct Square {
    hierarchy::ElementId sender;
    Vec2 lower{0};
    double size = 1;
    float guess = 0;     // of its strength, before any ray looked at the square alone
    float strength = 0;  // root mean square of what a ray brings, by the sender's whole square

    Vec2 at(const UnitPair& u) const { return lower + size * Vec2(u.x, u.y); }
    float share() const { return static_cast<float>(size * size) * strength; }
  };
  /// What a ray that was learnt from brought.
  struct Look {
    std::uint32_t square;
    Vec2 u;
    float E;
  };

  float total() const { return cumulative_.empty() ? 0.0f : cumulative_.back(); }
  std::size_t indexAt(float part) const;
  const Square& squareAt(float part) const { return squares_[indexAt(part)]; }
  void limitBrightest();
  void sumShares();
  void look(const radiosity::DirectLight&, std::span<const radiosity::Receiver> places, int rays, std::uint64_t key,
            std::vector<Look>&) const;
  void judge(std::vector<Look>&);
  static bool uneven(const Square&, std::span<const Look>);
  void divide(const Square&, std::span<Look>, std::vector<Square>& squares, std::vector<Look>& looks) const;

  std::vector<Square> squares_;
  std::vector<float> cumulative_;
};

/// The sights of a part of a picture, by leaf: places are noted, learnt from, and then looked up. The leaves of one
/// side of a surface learn together, over lines from what all of the picture's part has learnt before.
class Sights {
 public:
  /// Both must outlive this.
  Sights(const hierarchy::Elements& elements, const Reconstruction& reconstruction)
      : elements_(elements), reconstruction_(reconstruction) {}

  void note(hierarchy::ElementId leaf, const radiosity::Receiver& place) { places_.push_back({leaf, place}); }
  /// For `rays` shadow rays a sample, by so many rays a place that was noted; places are forgotten then.
  void learn(int raysOfPlace, int rays, std::uint64_t key);
  const Sight& at(hierarchy::ElementId leaf);

  /// visit(arrival) for each of about `rays` shadow rays from a point of a leaf that is not blocked: the sum of all is
  /// the estimate. `index` and `key` name the stratified numbers to use.
  template <class Visit>
  void sample(hierarchy::ElementId leaf, const radiosity::Receiver& x, int rays, std::uint32_t index, std::uint64_t key,
              const Visit& visit) {
    if (const PointSources* points = reconstruction_.points.get())
      aimAt(leaf, rays).sample(points->light(), {x.position, x.normal}, index, key, visit);
    else
      at(leaf).sample(reconstruction_.direct, x, rays, index, key, visit);
  }

 private:
  const hierarchy::Elements& elements_;
  const Reconstruction& reconstruction_;
  struct Place {
    hierarchy::ElementId leaf;
    radiosity::Receiver at;
  };
  std::vector<Place> places_;
  std::unordered_map<hierarchy::ElementId, Sight> known_;
  // Of a solution over lines: of all that the picture's part shows, and by leaf.
  direct::Aim around_;
  std::unordered_map<hierarchy::ElementId, direct::Aim> aims_;

  std::uint64_t sideOf(hierarchy::ElementId leaf) const;
  void learn(std::span<const Place> ofSide, int learning, std::uint64_t key);
  void learnOverLines(int raysOfPlace, int rays, std::uint64_t key);
  const direct::Aim& aimAt(hierarchy::ElementId leaf, int rays);
};

}  // namespace deltalux::rendering
