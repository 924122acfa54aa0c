#include "render/sight.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>

#include "base/random.hpp"
#include "solution/solution.hpp"

namespace deltalux {
using namespace rendering;

namespace {

/// A black room of 4 x 4 x 3 under a sky, with a window of 0.6 x 0.6 in one wall, and a small lamp.
Scene roomWithWindow() {
  Scene scene;
  scene.materials.push_back({"black", Opaque{}, std::nullopt});
  scene.materials.push_back({"lamp", Opaque{}, Emission{Rgb(2.0f), false, std::nullopt}});
  const auto add = [&](std::vector<Vec3> v) {
    scene.primitives.push_back({*makePolygon(std::move(v)), MaterialId(0), ObjectId()});
  };
  add({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add({{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
  add({{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  add({{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  add({{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  const std::vector<Vec3> wall = {{4, 0, 0},     {4, 0, 3},     {4, 4, 3},     {4, 4, 0},     {4, 0, 0},
                                  {4, 1.6, 1.2}, {4, 2.2, 1.2}, {4, 2.2, 1.8}, {4, 1.6, 1.8}, {4, 1.6, 1.2}};
  add(wall);
  scene.primitives.push_back({Sphere{{2, 3, 2.5}, 0.1}, MaterialId(1), ObjectId()});
  scene.lights.push_back({"sky", DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}}, Rgb(1.0f)});
  addAreaLights(scene);
  return scene;
}

struct Moments {
  double mean = 0, variance = 0;
};

Moments momentsOf(const Sight& sight, const radiosity::DirectLight& direct, const radiosity::Receiver& x,
                  std::uint64_t key) {
  constexpr int kTimes = 4000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kTimes; ++i) {
    double E = 0;
    sight.sample(direct, x, 4, 0, combineKeys(key, i),
                 [&](const radiosity::LightArrival& a) { E += glm::dot(a.direction, x.normal) * gray(a.E); });
    sum += E, squares += E * E;
  }
  const double mean = sum / kTimes;
  return {mean, squares / kTimes - mean * mean};
}

class SightTest : public testing::Test {
 protected:
  void SetUp() override {
    engine_.emplace(roomWithWindow(), SolveSettings{.error = 0.3});
    engine_->solve();
    solution_ = &engine_->solution().get();
    reconstruction_ = std::make_unique<Reconstruction>(*solution_);
  }
  /// A point of the wall that faces the window, and its leaf.
  std::pair<hierarchy::ElementId, radiosity::Receiver> place(double y, double z) const {
    const radiosity::Receiver x{{0, y, z}, {1, 0, 0}};
    const hierarchy::ElementId side = reconstruction_->locator.side(PrimitiveId(4), 0, true);
    EXPECT_TRUE(side.valid());
    return {reconstruction_->locator.locate(side, x.position).leaf, x};
  }

  std::optional<Engine> engine_;
  const Solution* solution_ = nullptr;
  std::unique_ptr<Reconstruction> reconstruction_;
};

TEST_F(SightTest, LearningKeepsTheMeanAndTakesNoiseAway) {
  Sights learnt(solution_->elements, *reconstruction_), plain(solution_->elements, *reconstruction_);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      const auto [leaf, x] = place(1.6 + 0.05 * i, 0.4 + 0.05 * j);
      learnt.note(leaf, x);
    }
  learnt.learn(64, 4, 7);
  for (const double y : {1.63, 1.81, 1.92}) {
    const auto [leaf, x] = place(y, 0.57);
    const Moments a = momentsOf(plain.at(leaf), reconstruction_->direct, x, 1),
                  b = momentsOf(learnt.at(leaf), reconstruction_->direct, x, 2);
    EXPECT_GT(b.mean, 0.0);
    EXPECT_NEAR(a.mean, b.mean, 5 * std::sqrt((a.variance + b.variance) / 4000)) << y;
    EXPECT_LT(b.variance, 0.25 * a.variance) << y;
  }
}

TEST_F(SightTest, WhatItDoesNotExpectIsStillFound) {
  // Learnt where the window is, used where the lamp alone is near: the mean is what an unlearnt sight has.
  Sights learnt(solution_->elements, *reconstruction_), plain(solution_->elements, *reconstruction_);
  const auto [leaf, x] = place(2.0, 0.5);
  for (int i = 0; i < 32; ++i) learnt.note(leaf, x);
  learnt.learn(64, 4, 7);
  const hierarchy::ElementGeometry& g = solution_->elements.shape(leaf);
  const radiosity::Receiver corner{Vec3(0.98 * Vec3(g.upper) + 0.02 * Vec3(g.lower)), {1, 0, 0}};
  const Moments a = momentsOf(plain.at(leaf), reconstruction_->direct, corner, 1),
                b = momentsOf(learnt.at(leaf), reconstruction_->direct, corner, 2);
  EXPECT_GT(a.mean, 0.0);
  EXPECT_NEAR(a.mean, b.mean, 5 * std::sqrt((a.variance + b.variance) / 4000));
}

}  // namespace
}  // namespace deltalux
