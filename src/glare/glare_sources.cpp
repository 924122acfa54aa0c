// What is brighter than a threshold, in pieces that lie together. Pieces are joined where any two of their pixels are
// near enough. Cost: pixels of sources times those within the angle.
#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/disjoint_sets.hpp"
#include "glare/fisheye.hpp"
#include "glare/sight_frame.hpp"

namespace deltalux {

namespace {

struct Bright {
  int x, y;
  double luminance;
  glare::FisheyePixel pixel;
};

std::vector<Bright> brightPixels(const Image& image, const Eye& eye, double threshold) {
  std::vector<Bright> all;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double L = photometric(glm::dvec3(image.at(x, y)), image.luminousEfficacy);
      if (!(L > threshold)) continue;
      if (const auto pixel = glare::fisheyePixel(eye, image.width, x, y)) all.push_back({x, y, L, *pixel});
    }
  return all;
}

}  // namespace

std::vector<GlareSource> glareSources(const Image& fisheye, const Eye& eye, const GlareSourceSettings& settings,
                                      std::vector<int>* of) {
  DELTALUX_CHECK(fisheye.width == fisheye.height && fisheye.width > 0, "a fisheye picture is square");
  const std::vector<Bright> bright = brightPixels(fisheye, eye, settings.threshold);
  const int size = fisheye.width;
  std::vector<int> at(fisheye.pixels.size(), -1);
  const auto indexOf = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
  };
  for (std::size_t i = 0; i < bright.size(); ++i) at[indexOf(bright[i].x, bright[i].y)] = static_cast<int>(i);

  // An angle is widest across the rim, by pi / 2 there.
  const double least = std::cos(settings.withinAngle);
  const int reach = static_cast<int>(std::ceil(settings.withinAngle * size / 2)) + 1;
  DisjointSets sets(bright.size());
  for (std::size_t i = 0; i < bright.size(); ++i) {
    const Bright& b = bright[i];
    for (int y = b.y; y <= std::min(b.y + reach, size - 1); ++y)
      for (int x = y == b.y ? b.x + 1 : std::max(b.x - reach, 0); x <= std::min(b.x + reach, size - 1); ++x) {
        const int j = at[indexOf(x, y)];
        if (j >= 0 && glm::dot(b.pixel.direction, bright[static_cast<std::size_t>(j)].pixel.direction) >= least)
          sets.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      }
  }

  std::vector<GlareSource> sources;
  std::vector<int> sourceOfSet(bright.size(), -1);
  for (std::uint32_t i = 0; i < bright.size(); ++i) {
    int& source = sourceOfSet[sets.of(i)];
    if (source < 0) source = static_cast<int>(sources.size()), sources.push_back({Vec3(0), 0, 0, 1});
    GlareSource& s = sources[static_cast<std::size_t>(source)];
    const double omega = bright[i].pixel.solidAngle;
    s.luminance += bright[i].luminance * omega, s.solidAngle += omega;
    s.direction += bright[i].luminance * omega * bright[i].pixel.direction;
  }
  for (GlareSource& s : sources) {
    s.luminance /= s.solidAngle, s.direction = glm::normalize(s.direction);
    s.positionIndex = positionIndex(eye, s.direction);
  }
  std::vector<int> order(sources.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::ranges::stable_sort(order, std::greater(),
                           [&](int i) { return glare::disturbance(sources[static_cast<std::size_t>(i)]); });
  std::vector<GlareSource> sorted;
  std::vector<int> rank(order.size());
  for (const int i : order) {
    rank[static_cast<std::size_t>(i)] = static_cast<int>(sorted.size());
    sorted.push_back(sources[static_cast<std::size_t>(i)]);
  }
  if (of) {
    of->assign(fisheye.pixels.size(), -1);
    for (std::uint32_t i = 0; i < bright.size(); ++i)
      (*of)[indexOf(bright[i].x, bright[i].y)] = rank[static_cast<std::size_t>(sourceOfSet[sets.of(i)])];
  }
  return sorted;
}

}  // namespace deltalux
