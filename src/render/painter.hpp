#pragma once
// How a picture is put together from camera rays, whoever draws it and in whichever order: a picture is cut into tiles,
// each tile looks around first (sight.hpp), and every pixel then has a fixed list of rays.
#include <deltalux/image.hpp>
#include <deltalux/progress.hpp>
#include <deltalux/render.hpp>
#include <functional>

#include "render/eye_path.hpp"

namespace deltalux::rendering {

/// An empty picture of that size. The settings are checked.
Image blankImage(const Solution&, const RenderSettings&);

/// The ray of a picture at x in [0,1] from the left and y in [0,1] from the top; direction is unit.
using PictureRay = std::function<ViewRay(double x, double y)>;

class Painter {
 public:
  /// Solution and reconstruction must outlive this.
  Painter(const Solution&, const Reconstruction&, const View&, const RenderSettings&);
  Painter(const Solution&, const Reconstruction&, PictureRay, const RenderSettings&);

  struct Tile {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // pixels, the ends excluded
  };
  std::size_t tiles() const { return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_); }
  Tile tile(std::size_t index) const;

  /// Where the lights are, as seen from what the tile shows.
  Sights lookAround(const Tile&) const;
  /// Radiance along the ray number `s` of a pixel, below samplesPerPixel: the pixel is the mean of all of them, added
  /// in this order. `sights` are those of its tile.
  Rgb radiance(int x, int y, std::uint32_t s, Sights& sights) const;

  const RenderSettings& settings() const { return settings_; }

 private:
  EyeRay eyeRay(int x, int y, std::uint32_t index, std::uint64_t key) const;

  const hierarchy::Elements& elements_;
  const Reconstruction& reconstruction_;
  PictureRay ray_;
  RenderSettings settings_;
  int across_, down_;
  EyePaths paths_;
};

/// Which pixels of a picture have rays.
using PixelChoice = std::function<bool(int x, int y)>;
/// All rays of the pixels, or of those chosen, tile by tile on all threads; `image` is of the painter's size. `phase`:
/// of the progress. Throws Interrupted.
void paint(const Painter&, Image& image, Progress*, std::string_view phase, const PixelChoice& chosen = {});

}  // namespace deltalux::rendering
