#pragma once
// What all of a chart looks like on coarse texels, figures of light and the layer around them: what is left of the
// light when regions have been taken out of it, and what each of these goes over into.
//
// A region's own light has no share in what is beyond its border, and as few particles as the layer has leave both
// sides with noise of their own: without more, light steps along the border. So the layer that is shown inside of a
// region is
//   - that of the whole chart within the region's margin, where the layer is all that there is: entirely at the border;
//   - wherever the region's widest kernels leave more noise than a quarter of the target error and the layer, which has
//     wider ones, does not contradict them: as Lepski's method would go on.
// This moves flux between regions, of which the chart's whole is kept.
#include "caustics/adaptive_kernel.hpp"
#include "caustics/chart_part.hpp"

namespace deltalux::caustics {

/// Where a region fades into what is around it: over `width` inside of `box`, at those of its sides that are not the
/// chart's own.
struct FadingBorder {
  Region box;
  Vec2 width{0};
  TexelBox within;  // the box without its fading sides
  bool left = false, right = false, below = false, above = false;

  FadingBorder(const CellGrid& whole, const TexelBox&, int margin);
  /// 1 on such a side, 0 where the width is behind.
  double at(const Vec2& st) const;
};

class LowFrequencyLayer {
 public:
  /// `all`: the chart before anything was taken out of it, whose grid and reconstruction these are. What is shown of
  /// the layer has no light from within the borders, and is halved as often as the part that is left.
  LowFrequencyLayer(const ChartSurface&, ChartPart all, const CellGrid&, const AdaptiveEstimate&,
                    std::span<const FadingBorder>, int halvings);

  /// Gives the cells of a region, whose light is reconstructed, as much of the layer as they want.
  void over(const CellGrid&, const FadingBorder&, const BandwidthRule&, AdaptiveEstimate&) const;

  /// Its texture where it is shown. `left`: the part that regions were taken out of.
  CausticTexture shownOn(const ChartPart& left) const;

 private:
  CausticTexture all_;    // with what regions hold
  CausticTexture shown_;  // without, but for their margins
};

}  // namespace deltalux::caustics
