#include "hierarchy/direction_window.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

Vec3 anyDirection(Rng& rng) {
  const double z = 2 * rng.uniform() - 1, s = std::sqrt(1 - z * z), phi = 2 * kPi * rng.uniform();
  return {s * std::cos(phi), s * std::sin(phi), z};
}

/// A cell of a sky or a sun, anywhere.
struct Cell {
  Scene scene;
  Elements elements;
  ElementId id;

  explicit Cell(Rng& rng, bool sun) {
    if (sun)
      scene.lights.push_back({"sun", SunLight{anyDirection(rng), 0.2 * rng.uniform() + 0.004, Rgb(1.0f)}, Rgb(1.0f)});
    else
      scene.lights.push_back({"sky", DomeLight{}, Rgb(1.0f)});
    if (auto* dome = std::get_if<DomeLight>(&scene.lights[0].emitter))
      dome->axis = anyDirection(rng), dome->halfAngle = kPi * (0.2 + 0.8 * rng.uniform());
    id = elements.addChildren({}, ElementKind::Distant, 1);
    elements.light[id.index()] = LightId(0);
    if (sun) return;
    PatchDomain& d = elements.domain[id.index()];
    d.u0 = static_cast<float>(0.7 * rng.uniform()), d.u1 = d.u0 + static_cast<float>(0.3 * rng.uniform());
    d.v0 = static_cast<float>(0.7 * rng.uniform()), d.v1 = d.v0 + static_cast<float>(0.3 * rng.uniform());
  }
};

TEST(DirectionWindow, HoldsAllNearDirectionsAndFewOthers) {
  Rng rng(5);
  int near = 0, far = 0, farHeld = 0;
  for (int k = 0; k < 2000; ++k) {
    const Cell cell(rng, k % 5 == 0);
    const Vec3 middle(directionOf(cell.elements, cell.scene, cell.id, rng.uniform(), rng.uniform()));
    const double angle = 0.5 * rng.uniform() * rng.uniform();
    const Vec3 w = glm::normalize(middle + 2 * angle * anyDirection(rng));
    const DirectionWindow window(cell.elements, cell.scene, cell.id, w, angle);
    for (int i = 0; i < 200; ++i) {
      const double a = rng.uniform(), b = rng.uniform();
      const Vec3 d(directionOf(cell.elements, cell.scene, cell.id, a, b));
      const double apart = std::acos(std::clamp(glm::dot(glm::normalize(d), w), -1.0, 1.0));
      if (apart <= angle) {
        ++near;
        EXPECT_TRUE(window.holds(a, b)) << apart << ' ' << angle;
      } else if (apart > 2 * angle + 0.01) {
        ++far, farHeld += window.holds(a, b);
      }
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(far, 100000);
  EXPECT_LT(farHeld, 0.1 * far);
}

}  // namespace
}  // namespace deltalux
