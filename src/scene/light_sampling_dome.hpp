#pragma once
// Directions of a sky by importance: a table of equal solid angles over the dome's cap, each cell drawn in proportion
// to its radiance and uniformly within. The density is positive wherever the sky shines.
#include <deltalux/light.hpp>
#include <vector>

#include "base/sky_side.hpp"

namespace deltalux::scene {

class DomeTable {
 public:
  explicit DomeTable(const DomeLight&);

  /// A direction towards the sky from two numbers in [0,1), and its density [1/sr].
  struct Sample {
    Vec3 direction;
    double pdf;
  };
  Sample sample(const Vec2& u) const;
  /// Density of sample() at `towards` [1/sr]; 0 outside the dome.
  double pdf(const Vec3& towards) const;

 private:
  static constexpr int kRings = kSkySide;
  static constexpr int kSectors = 2 * kRings;  // around: twice as many [defined]

  Vec3 direction(double azimuth, double height) const;

  Frame frame_;
  double depth_;                    // 1 - cos(halfAngle)
  std::vector<double> cumulative_;  // of the cells' chances, kRings * kSectors
};

}  // namespace deltalux::scene
