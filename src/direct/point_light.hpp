#pragma once
// Direct light at single points: which suns, lamps and cells of the skies may shine there, about how much each may
// bring and how likely it is open, and what one shadow ray to one of them finds. Skies are taken by cells, so that rays
// can go to the part that a window shows; such as are no wider than a cell count as lamps.
#include <deltalux/probe.hpp>
#include <optional>

#include "direct/lamps.hpp"
#include "direct/sky_light.hpp"

namespace deltalux::direct {

/// A point with the unit normal of the side that light falls on.
struct Receiver {
  Vec3 position, normal;
};

/// A lamp, or a cell of a sky, as one place may see it.
struct Source {
  std::uint32_t id = 0;  // of PointSampler
  float potential = 0;   // irradiance that it may bring unshadowed, about [W/m2, gray]; > 0
  float open = 1;        // chance that it is seen, about; > 0
};

/// What one shadow ray found: unit direction towards the light, and the irradiance of a plane that faces it, over the
/// density of the sample [W/m2].
struct Arrival {
  Vec3 direction;
  LightId light;
  Rgb E{0.0f};
};

/// A point as a patch of no extent.
hierarchy::ElementGeometry pointPatch(const Receiver&);

class PointSampler {
 public:
  /// Both must outlive this.
  PointSampler(const Scene&, const tracing::RayTracer&);

  const Lamps& lamps() const { return lamps_; }
  /// All that may shine on a patch, ascending by id. `openOf(cell)`: chance that a ray into a cell of the sky escapes.
  template <class OpenOf>
  std::vector<Source> sources(const hierarchy::ElementGeometry& patch, const OpenOf& openOf) const {
    std::vector<Source> out = lampsOver(patch);
    addSkies(patch, out);
    for (Source& s : out)
      if (s.id >= whole_.size()) s.open = openOf(cellOf(s.id));
    return out;
  }
  /// The same on a point, of whose surroundings nothing is known.
  std::vector<Source> sources(const Receiver&) const;

  /// What a shadow ray finds of a source by the numbers `u` in [0,1)^2, uniform ones; nullopt where it is blocked or
  /// does not shine.
  std::optional<Arrival> arrival(std::uint32_t source, const Receiver&, const Vec2& u) const;

 private:
  struct Sky {
    LightId id;
    DomeLight light;
    Rgb scale;
    std::array<float, SkyCells::kCount> strength{};  // mean gray radiance, by cell
  };
  std::vector<Source> lampsOver(const hierarchy::ElementGeometry&) const;
  void addSkies(const hierarchy::ElementGeometry&, std::vector<Source>&) const;
  int cellOf(std::uint32_t source) const {
    return curve_[(source - whole_.size()) % static_cast<std::size_t>(SkyCells::kCount)];
  }

  const tracing::RayTracer& tracer_;
  Lamps lamps_;
  std::vector<Lamp> whole_;  // that are taken whole
  std::vector<Sky> skies_;
  std::array<int, SkyCells::kCount> curve_{};                   // cells in an order that keeps neighbours together
  std::array<std::array<Vec3f, 5>, SkyCells::kCount> looks_{};  // into the middle and the corners of each cell
};

}  // namespace deltalux::direct
