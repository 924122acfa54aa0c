#pragma once
// A Render Cache [WDP99; WDG02]: light that rays found is kept at its place in the scene, projected into every frame,
// and filled up between; where it is thin or old, new rays are asked for. Rays are traced elsewhere
// (SolutionReader::trace) and come back when they do. Plain CPU code over values; one thread at a time.
//
// Rays go through the middles of pixels. While the camera stands still a pixel keeps what its own ray found, and asks
// for no more; where chance chose the way (gloss, glass) rays are averaged, up to 64. Departures: samples are projected
// by where their image seems to be, so that what a flat mirror shows moves as it should; a sample is taken for hidden
// by how many of its neighbours are nearer, since their mean depth would also take the far side of every edge; what an
// edit made wrong is known, and need not be found by looking again.
#include <deltalux/pixel_sample.hpp>
#include <deltalux/view.hpp>
#include <memory>
#include <span>
#include <vector>

namespace deltalux {

struct RenderCacheSettings {
  double samplesPerPixel = 1.5;  // store, relative to the pixels of a frame
  double prediction = 0.25;      // share of the rays for where the camera is going, while it moves [WDG02]
};

/// A frame of the cache.
struct CacheFrame {
  int width = 0, height = 0;
  std::vector<glm::vec4> pixels;     // L [W/(sr m2)] and how well it is known: 0 nothing near, below 1 filled from
                                     // neighbours, 1 a sample of its own. Rows from the top
  std::size_t wanted = 0, held = 0;  // pixels to fill; of those, the ones with a sample of their own
};

class RenderCache {
 public:
  explicit RenderCache(RenderCacheSettings = {});
  ~RenderCache();
  RenderCache(RenderCache&&) noexcept;
  RenderCache& operator=(RenderCache&&) noexcept;

  /// Takes samples in; the oldest make room. Those that met no surface are not kept.
  void insert(std::span<const PixelSample>);
  /// Makes way for what an edit has changed: samples that are stale stay to be seen where there is nothing else, so
  /// that nothing turns black, until the rays that are wanted there before any other have come. The others count as
  /// traced now, so that no change is looked at twice. Returns how many were found stale.
  std::size_t retire(const SampleChanges&);
  /// All samples. Means of several rays are not `complete`: only one's path is there.
  std::span<const PixelSample> samples() const;
  void clear();

  /// Projects and fills. `surfaces`: by pixel the primitive that is seen there first, as value + 1, or 0 where the
  /// cache has nothing to do: samples of other surfaces are not shown there, so edges are the drawing's own.
  const CacheFrame& frame(const View&, int width, int height, std::span<const std::uint32_t> surfaces);
  /// Rays for the frame that was made last: at most `count`, where they are wanted most [WDP99, priority image with
  /// error diffusion]; none once every pixel has what it can have. What was asked for is not asked for again for some
  /// frames. `next`: where the camera will be by the time they are back.
  std::vector<PixelRay> wanted(std::size_t count, const View& next);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux
