// The bare mesh for debugging: flat leaf values, outlines where the leaf changes from pixel to pixel, links as lines.
#include <algorithm>
#include <deltalux/render.hpp>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "hierarchy/side_locator.hpp"
#include "scene/light_sampling.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr int kMaxPanes = 32;      // [limit]
constexpr float kOutline = 0.35f;  // of the radiance next to it [shown]

class MeshPainter {
 public:
  MeshPainter(const Solution& s, const View& view, const MeshViewSettings& settings)
      : s_(s), view_(view), settings_(settings), locator_(s.elements, s.scene), lights_(s.scene) {}

  Image paint() const {
    Image image;
    image.luminousEfficacy = s_.scene.luminousEfficacy;
    image.width = settings_.width, image.height = settings_.height;
    const auto w = static_cast<std::size_t>(image.width), h = static_cast<std::size_t>(image.height);
    image.pixels.resize(w * h);
    std::vector<hierarchy::ElementId> seen(w * h);
    parallelFor(h, 4, [&](std::size_t y) {
      for (std::size_t x = 0; x < w; ++x)
        seen[y * w + x] = look(static_cast<int>(x), static_cast<int>(y), image.pixels[y * w + x]);
    });
    for (std::size_t y = 0; y + 1 < h; ++y)
      for (std::size_t x = 0; x + 1 < w; ++x)
        if (seen[y * w + x] != seen[y * w + x + 1] || seen[y * w + x] != seen[(y + 1) * w + x])
          image.pixels[y * w + x] *= kOutline;
    if (settings_.linksOf) {
      const glm::ivec2 p = *settings_.linksOf;
      DELTALUX_CHECK(p.x >= 0 && p.y >= 0 && p.x < image.width && p.y < image.height, "the pixel lies in the picture");
      drawLinks(seen[static_cast<std::size_t>(p.y) * w + static_cast<std::size_t>(p.x)], image);
    }
    return image;
  }

 private:
  /// The leaf at a pixel's centre, and its radiance.
  hierarchy::ElementId look(int x, int y, Rgb& radiance) const {
    const ViewRay from = viewRay(view_, (x + 0.5) / settings_.width, (y + 0.5) / settings_.height);
    tracing::Ray ray;
    ray.origin = Vec3f(from.origin), ray.direction = Vec3f(from.direction);
    for (int pane = 0; pane < kMaxPanes; ++pane) {
      const tracing::Hit hit = s_.tracer->closestHit(ray);
      if (!hit) {
        for (const LightId id : lights_.atInfinity()) radiance += lights_.radianceFrom(id, from.direction);
        return {};
      }
      const Vec3f p = hit.position;
      if (isPane(s_.scene.materialOf(hit.primitive))) {
        ray.origin = tracing::offsetOrigin(p, hit.normal, ray.direction);
        continue;
      }
      if (const LightId id = lights_.lightOf(hit.primitive); id.valid())
        radiance += lights_.emittedRadiance(id, -from.direction, double(hit.t), hit.front);
      const hierarchy::ElementId side = locator_.side(hit.primitive, hit.triangle, hit.front);
      if (!side.valid()) return {};
      const hierarchy::ElementId leaf = locator_.locate(side, Vec3(p)).leaf;
      radiance += s_.elements.radiometry[leaf.index()].B * float(1 / kPi);
      return leaf;
    }
    return {};
  }

  void drawLinks(hierarchy::ElementId leaf, Image& image) const {
    if (!leaf.valid()) return;
    std::vector<char> above(s_.elements.size(), 0);
    for (hierarchy::ElementId e = leaf; e.valid(); e = s_.elements.at(e).parent) above[e.index()] = 1;
    const double brightness = std::exp2(-automaticEv(image));
    const Vec3 from(s_.elements.shape(leaf).center);
    for (const hierarchy::Link& l : s_.links.all) {
      if (l.state != hierarchy::LinkState::Active || !above[l.receiver.index()]) continue;
      const hierarchy::ElementGeometry& g = s_.elements.shape(l.sender);
      const bool distant = s_.elements.isDistant(l.sender);
      const Vec3 to = distant ? from + s_.elements.sceneBox.diagonal() * Vec3(g.center) : Vec3(g.center);
      const float V = l.visibility == hierarchy::Visibility::Clear ? 1.0f : gray(l.V);
      const Rgb color = V >= 0.999f ? Rgb(0, 1, 0) : V > 0 ? Rgb(1, 1, 0) : Rgb(1, 0, 0);
      drawLine(from, to, static_cast<float>(0.5 * brightness) * color, image);
    }
  }

  /// Pixel of a point; nullopt behind the eye.
  std::optional<Vec2> project(const Vec3& p) const {
    const Vec3 forward = glm::normalize(view_.direction), right = glm::normalize(glm::cross(forward, view_.up));
    const Vec3 upward = glm::cross(right, forward), d = p - view_.position;
    Vec2 half(view_.horizontal / 2, view_.vertical / 2);
    double depth = 1;
    if (view_.kind == View::Kind::Perspective) {
      half = {std::tan(glm::radians(view_.horizontal) / 2), std::tan(glm::radians(view_.vertical) / 2)};
      depth = glm::dot(d, forward);
      if (!(depth > 1e-9)) return std::nullopt;
    }
    const double x = glm::dot(d, right) / depth / half.x, y = glm::dot(d, upward) / depth / half.y;
    return Vec2(0.5 * (x + 1) * settings_.width, 0.5 * (1 - y) * settings_.height);
  }

  void drawLine(const Vec3& a, Vec3 b, const Rgb& color, Image& image) const {
    const auto start = project(a);
    if (!start) return;
    auto end = project(b);
    for (int i = 0; i < 40 && !end; ++i) end = project(b = 0.5 * (a + b));  // clip at the eye's plane
    if (!end) return;
    const Vec2 d = *end - *start;
    const double length = std::max(std::abs(d.x), std::abs(d.y));
    const int steps = static_cast<int>(std::min(length, 4.0 * (settings_.width + settings_.height)));
    for (int i = 0; i <= steps; ++i) {
      const Vec2 q = *start + d * (double(i) / std::max(length, 1.0));
      if (q.x >= 0 && q.y >= 0 && q.x < image.width && q.y < image.height)
        image.at(static_cast<int>(q.x), static_cast<int>(q.y)) += color;
    }
  }

  const Solution& s_;
  const View& view_;
  const MeshViewSettings& settings_;
  hierarchy::SideLocator locator_;
  scene::LightSampler lights_;
};

}  // namespace

Image renderMesh(const SolutionView& solution, const View& view, const MeshViewSettings& settings) {
  DELTALUX_CHECK(settings.width > 0 && settings.height > 0, "a picture has pixels");
  return MeshPainter(solution.get(), view, settings).paint();
}

}  // namespace deltalux
