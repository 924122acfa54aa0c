#pragma once
// Direct light of skies at leaves: the leaf's lines that escape, balanced [VG95] with shadow rays that are drawn by the
// sky's radiance, the cosine, and the visibility estimates that lines below a common element have found, in octaves, so
// that what a few lines see is not told from chance.
#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/sky_side.hpp"
#include "base/tuning.hpp"
#include "hierarchy/leaf_table.hpp"
#include "hierarchy/tuning.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::direct {

/// The sphere in cells of equal solid angle: heights times azimuths.
struct SkyCells {
  static constexpr int kCount = kSkySide * kSkySide;
  static int of(const Vec3f& direction);
  static Vec3f direction(int cell, double a, double b);
  static constexpr double solidAngle() { return 4 * kPi / kCount; }
  /// Mean of a function of directions over a cell.
  template <class Value>
  static float meanOver(int cell, const Value& value) {
    constexpr int looks = hierarchy::tuning::kGrid;
    float sum = 0;
    for (int k = 0; k < looks * looks; ++k)
      sum += value(direction(cell, (k % looks + 0.5) / looks, (k / looks + 0.5) / looks)) / (looks * looks);
    return sum;
  }
};

/// Lines that tell visibility below one element: a first idea of each cell.
inline constexpr int kGuideLines = deltalux::tuning::kPilots * SkyCells::kCount;

/// All skies of a scene, at their nominal scales where all of them are dimmed alike.
class Skies {
 public:
  explicit Skies(const Scene&);
  bool empty() const { return domes_.empty(); }
  /// What their light is to be multiplied by.
  const Rgb& dimming() const { return dimming_; }
  bool dimmedAlike() const { return alike_; }
  Rgb radiance(const Vec3f& direction) const;
  /// Mean gray radiance of a few directions of a cell.
  float strength(int cell) const { return strength_[static_cast<std::size_t>(cell)]; }
  /// The same for skies that look the same.
  std::uint64_t key() const { return key_; }

 private:
  struct Dome {
    DomeLight light;
    Rgb scale;
  };
  std::vector<Dome> domes_;
  std::array<float, SkyCells::kCount> strength_{};
  std::uint64_t key_ = 0;
  Rgb dimming_{1.0f};
  bool alike_ = true;
};

/// Visibility estimates by guide: shares of lines into each cell that escape, in octaves.
class SkyVisibility {
 public:
  /// `forEachLineOf(leaf, sink)` calls sink(cell, escaped) for every line of a leaf. Counts below the lowest element
  /// above each leaf that has enough lines. Of leaves with `same(leaf)` the lines are those that `before` counted.
  template <class ForEachLineOf, class Same>
  SkyVisibility(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                std::span<const std::uint32_t> linesOf, const ForEachLineOf& forEachLineOf, const SkyVisibility* before,
                const Same& same) {
    const GuidedLeaves guided = placeGuides(elements, leaves, linesOf);
    share_.resize(guides_ * SkyCells::kCount), keys_.resize(guides_);
    std::vector<std::uint64_t> guidedKeys(guides_, 0);
    parallelFor(guides_, 1, [&](std::size_t guide) {
      const std::span own =
          std::span(guided.leaf).subspan(guided.first[guide], guided.first[guide + 1] - guided.first[guide]);
      std::uint64_t& key = guidedKeys[guide];
      for (const std::uint32_t leaf : own) key = combineKeys(key, elements.key[leaves[leaf].index()]);
      if (before && std::ranges::all_of(own, same) && takeShares(guide, key, *before)) return;
      Counts counts;
      for (const std::uint32_t leaf : own)
        forEachLineOf(leaf, [&](int cell, bool escaped) {
          const auto c = static_cast<std::size_t>(cell);
          counts.all[c] += 1, counts.open[c] += escaped;
        });
      setShares(guide, counts);
    });
    for (std::uint32_t guide = 0; guide < guides_; ++guide) guideOfLeaves_[guidedKeys[guide]] = guide;
  }

  /// The same for leaves of equal shares.
  std::uint64_t key(std::uint32_t leaf) const { return keys_[guideOf_[leaf]]; }
  /// Chance that a line from the leaf into a cell escapes, about; never 0.
  float at(std::uint32_t leaf, int cell) const {
    return share_[std::size_t(guideOf_[leaf]) * SkyCells::kCount + static_cast<std::size_t>(cell)];
  }

 private:
  struct Counts {
    std::array<float, SkyCells::kCount> all{}, open{};
  };
  /// The leaves of each guide.
  struct GuidedLeaves {
    std::vector<std::uint32_t> first, leaf;  // first by guide, and one more for the end
  };
  GuidedLeaves placeGuides(const hierarchy::Elements&, const hierarchy::LeafTable&,
                           std::span<const std::uint32_t> linesOf);
  void setShares(std::size_t guide, const Counts&);
  /// Those of the guide of the leaves of that key, if there was one.
  bool takeShares(std::size_t guide, std::uint64_t leaves, const SkyVisibility& before);

  std::size_t guides_ = 0;
  std::vector<std::uint32_t> guideOf_;                              // by leaf
  std::vector<float> share_;                                        // by guide and cell
  std::vector<std::uint64_t> keys_;                                 // by guide: of its shares
  std::unordered_map<std::uint64_t, std::uint32_t> guideOfLeaves_;  // by a key of them
};

/// Own lines of a leaf that escape.
struct EscapedView {
  Vec3f direction;
  float cosine;
  Rgb weight;    // throughput over chance
  float chance;  // of its way, beside that of the direction
};

struct SkyAtLeaf {
  Rgb E{0.0f};          // [W/m2]
  float deviation = 0;  // standard error, gray
  std::uint32_t rays = 0;
};

/// What is known of a leaf before its sky light.
struct SkyLeaf {
  std::uint32_t leaf = 0;
  hierarchy::ElementId element;
  std::uint32_t lines = 0;                // own lines that were traced from open points
  std::span<const EscapedView> escaped;   // of those
  std::span<const std::uint32_t> points;  // numbers of open points of its sequence: a shadow ray each
};

/// Where a shadow ray runs: as far as what stops light there. Rays of one leaf, point and cell run the same way.
struct SkyRay {
  enum class Visibility : std::uint8_t { Unknown, Stopped, Open };
  static constexpr float kDimmed = 1e38f;  // length of those that pass panes [sentinel]
  static_assert(SkyCells::kCount <= 256);

  std::uint8_t cell = 0;
  Visibility known = Visibility::Unknown;  // before it is traced
  Vec3f direction{0.0f};
  float length = 0;  // 0: it was not traced

  bool traced() const { return length > 0; }
};

/// The skies' irradiance over what is not covered of a leaf. `rays`: what is known of those of its points, in order;
/// becomes what they have found.
SkyAtLeaf skyLight(const Skies&, const SkyVisibility&, const hierarchy::Elements&, const Scene&,
                   const tracing::RayTracer&, const SkyLeaf&, std::span<SkyRay> rays);
/// What sky light of a leaf follows from where nothing is in the way that was not: equal for equal points of its rays,
/// and for equal light by them.
struct SkyKey {
  std::uint64_t points = 0, light = 0;
  std::uint64_t guide = 0;  // of the visibility estimate
};
SkyKey skyKey(const Skies&, const SkyVisibility&, const SkyLeaf&);

}  // namespace deltalux::direct
