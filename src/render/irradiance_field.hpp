#pragma once
// Irradiance at any point of a surface side, reconstructed from one value a leaf patch: every leaf carries a linear
// function fitted to the leaves around it, and a point blends the functions of all leaves whose supports hold it
// (Shepard's method with local linear fits [FN80; Renka88]), finer leaves counting more.
//
//   E(p) = sum_i w_i(p) (E_i + g_i . (p - c_i)) / sum_i w_i(p),  w_i = k_i(p) / A_i
//
// Continuous whatever the mesh (supports move with their patch, patch_support.hpp), exact for linear fields, so there
// is no darkening at edges; slopes are limited by what the surrounding leaves differ, so there is no overshoot. Leaves
// blend across polygons that lie in one plane, and across a mesh's triangles where it is smooth; never across creases
// or sides. Two leaves that disagree, with something standing between them, do not blend: no light leaks under a wall
// that stands on a floor. Nor do the floor and the bottom of a closed box, as it is seen from inside. All of that is
// decided once per pair of leaves, none of it per query.
//
// Leaves gather by rays of their own, so neighbours differ by chance, in colour too, which an eye sees as blotches.
// What indirect light of joined leaves differs by less than the error that was asked for, or than the rays of their own
// rows vary, is taken for noise and averaged (bilateral filter [Tomasi98]); larger differences stay. The lower the
// error, the less is averaged.
//
// A field takes over from the one of the solution before what is the same: neighbours where no leaf came or went, rays
// where nothing moved, averages and fits where no light changed around. It is the field that would be made from
// nothing.
//
// Rejected: vertex interpolation (needs a conforming mesh), one moving least-squares fit per query (a solve each, and
// fits that jump as leaves enter them).
// Cost: about 15 neighbours a leaf to build (a ray for pairs that disagree), 0.2-0.5 microseconds a query (a ray per
// neighbour where leaves are torn), no memory.
#include <array>
#include <span>

#include "base/tuning.hpp"
#include "hierarchy/side_locator.hpp"
#include "hierarchy/tuning.hpp"
#include "render/leaf_irradiance.hpp"
#include "render/leaf_sites.hpp"
#include "render/tuning.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::rendering {

/// Irradiance at a point, by where it came from [W/m2].
struct PointIrradiance {
  Rgb direct{0.0f}, indirect{0.0f}, particle{0.0f};
};

class IrradianceField {
 public:
  /// `values` by element; those of receiving leaves are used. `noise`: of their indirect light, relative to all light.
  /// The others must outlive this. `before`: of the same elements and scene, as they were; it is not needed afterwards.
  /// What differs from it by less than `tolerance`, a fraction, is left as it was.
  IrradianceField(const hierarchy::Elements&, const Scene&, const tracing::RayTracer&,
                  const std::vector<LeafIrradiance>& values, float noise = 0.0f,
                  const IrradianceField* before = nullptr, float tolerance = 0.0f);

  /// At the surface point `p`, which `at` locates [W/m2].
  Rgb direct(const hierarchy::LeafPoint& at, const Vec3f& p) const { return blend(direct_, at, p); }
  Rgb indirect(const hierarchy::LeafPoint& at, const Vec3f& p) const { return blend(indirect_, at, p); }
  /// All at once, and what particles brought apart from the rest of indirect light.
  PointIrradiance all(const hierarchy::LeafPoint& at, const Vec3f& p) const;
  /// Whether something stands on or cuts through the leaf, or between it and its neighbours.
  bool torn(hierarchy::ElementId leaf) const {
    const std::uint32_t i = sites_.of(leaf);
    return torn_[i] < end_[i];
  }
  /// How many fields this one took over from, one after the other; and in which of them what is read in a leaf last
  /// changed, or could have.
  std::uint64_t generation() const { return generation_; }
  std::uint64_t changedIn(hierarchy::ElementId leaf) const { return changedIn_[sites_.of(leaf)]; }

  // What a leaf's points read, for who watches it change.

  std::size_t sites() const { return sites_.size(); }
  /// Light below which changes are compared with that: a share of the mean of light(site) over all that is lit [W/m2].
  template <class Light>
  float floorOf(const Light& light) const {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < sites(); ++i) {
      const double lit = elements_.shape(leafOf(i)).litArea();
      sum += lit * double(light(i)), area += lit;
    }
    return area > 0 ? static_cast<float>(deltalux::tuning::kChangeMatters * sum / area) : 0.0f;
  }
  hierarchy::ElementId leafOf(std::size_t site) const { return sites_[site].leaf; }
  /// Irradiance as a site has it, to first order: at its centre, and by unit of length along the axes.
  struct Trend {
    Rgb value{0.0f}, slope[3] = {Rgb(0.0f), Rgb(0.0f), Rgb(0.0f)};
  };
  Trend trend(std::size_t site) const {
    Trend t{direct_[site].value + indirect_[site].value};
    for (int k = 0; k < 3; ++k) t.slope[k] = direct_[site].slope[k] + indirect_[site].slope[k];
    return t;
  }
  /// The sites that blend at points of one, itself first; those with something in between come last.
  std::span<const std::uint32_t> blended(std::size_t site) const {
    return std::span(neighbours_).subspan(begin_[site], end_[site] - begin_[site]);
  }
  std::size_t blendedFreely(std::size_t site) const { return torn_[site] - begin_[site]; }

 private:
  /// A leaf's linear function, kept within `low` and `high`.
  struct Linear {
    Rgb value{0.0f}, low{0.0f}, high{0.0f};
    std::array<Rgb, 3> slope{Rgb(0.0f), Rgb(0.0f), Rgb(0.0f)};  // along x, y, z

    bool operator==(const Linear&) const = default;
  };
  /// Whether the middle of one leaf can be seen from that of another, where it was asked.
  enum class Sight : char { Unknown, Clear, Blocked };
  /// Values of the leaves, by site, on their way from what they gathered to what is fitted.
  enum Stage { Gathered, Filled, Mended, WithoutOutliers, Quiet, kStages = Quiet + tuning::kQuietPasses };

  /// Takes in the first stage.
  void gather(const std::vector<LeafIrradiance>& values, const IrradianceField* before, float tolerance);
  void relate(const IrradianceField* before);
  /// Whether no light at all comes to one of two surfaces: the inside of what stands flush on the other.
  bool oneIsHollow(std::size_t home, std::size_t other) const;
  bool disagreeing(std::size_t home, std::size_t other) const;
  /// Whether `center` of a leaf can be seen from `p` of the same surface, a little above it.
  bool inSight(const Vec3f& p, hierarchy::ElementId home, hierarchy::ElementId other) const;

  /// Fills a stage: value(i) where anything that it is made of has changed, and as it was elsewhere.
  template <class Value>
  void fill(Stage, const IrradianceField* before, const Value&);
  /// With means of what is around leaves that are all but covered: what peeps out is lit as that is, and its own value,
  /// of few rays, would tilt the slopes of all that is beside it.
  LeafIrradiance filled(std::size_t site) const;
  /// Mended values of leaves that are cut in two.
  LeafIrradiance mended(std::size_t site);
  /// With indirect light kept within what the joined leaves have.
  LeafIrradiance withoutOutliers(std::size_t site) const;
  /// With indirect light averaged as far as it differs by no more than noise.
  LeafIrradiance quiet(std::size_t site, const std::vector<LeafIrradiance>& before) const;
  float exposed(hierarchy::ElementId leaf) const;
  bool isLittleExposed(std::size_t site) const;

  template <class Visit>
  void forEachCorner(hierarchy::ElementId leaf, const Visit&) const;
  using Quantity = Rgb LeafIrradiance::*;
  Linear fit(std::size_t site, Quantity) const;
  void fitAll(const IrradianceField* before);
  /// visit(site, weight) for all that take part at a point; the sum of the weights.
  template <class Visit>
  float forEachWeight(const hierarchy::LeafPoint&, const Vec3f& p, const Visit&) const;
  Rgb at(const Linear&, const LeafSite&, const Vec3f& p) const;
  Rgb blend(const std::vector<Linear>&, const hierarchy::LeafPoint&, const Vec3f& p) const;

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  float noise_;
  LeafSites sites_;
  std::vector<float> coverage_;  // by site: how much of the leaf light can reach (ElementGeometry::exposed)
  // Per site, those that may take part at its points: itself, the joined ones, then from torn_ on those with something
  // in between, until end_: there is room for all that are near.
  std::vector<std::uint32_t> begin_, torn_, end_, neighbours_;
  std::vector<Sight> sights_;   // of pairs that are near
  std::vector<float> exposed_;  // by site, of torn leaves; negative: not asked
  std::vector<char> related_;   // by site: whether other neighbours take part than before, or rays may differ
  std::array<std::vector<LeafIrradiance>, kStages> stages_;
  std::array<std::vector<char>, kStages> differs_;  // by site: whether the value is another one than before
  std::vector<Linear> direct_, indirect_;
  std::vector<Linear> particle_;  // of indirect_; empty: none anywhere
  std::uint64_t generation_ = 0;
  std::vector<std::uint64_t> changedIn_;  // by site
};

}  // namespace deltalux::rendering
