#include "direct/aim.hpp"

#include <gtest/gtest.h>

#include "direct/room_with_window.hpp"
#include "direct/tuning.hpp"

namespace deltalux {
namespace {

using namespace test;

struct Moments {
  double mean = 0, variance = 0, most = 0;  // most: of one ray
};

constexpr int kTimes = 4000;

Moments momentsOf(const direct::Aim& aim, const direct::PointSampler& light, const direct::Receiver& x,
                  std::uint64_t key) {
  double sum = 0, squares = 0;
  Moments m;
  for (int i = 0; i < kTimes; ++i) {
    double E = 0;
    aim.sample(light, x, 0, combineKeys(key, static_cast<std::uint64_t>(i)), [&](const direct::Arrival& a) {
      const double one = glm::dot(a.direction, x.normal) * gray(a.E);
      E += one, m.most = std::max(m.most, one);
    });
    sum += E, squares += E * E;
  }
  m.mean = sum / kTimes, m.variance = squares / kTimes - m.mean * m.mean;
  return m;
}

class AimTest : public testing::Test {
 protected:
  Scene scene_ = roomWithWindow();
  std::unique_ptr<tracing::RayTracer> tracer_ = tracing::makeBruteForceTracer(scene_);
  direct::PointSampler light_{scene_, *tracer_};
  direct::Receiver x_{{0, 1.9, 0.6}, {1, 0, 0}};  // on the wall that faces the window
};

TEST_F(AimTest, LearningKeepsTheMeanAndTakesNoiseAway) {
  const std::vector<direct::Source> sources = light_.sources(x_);
  const direct::Aim plain(sources);
  direct::Aim learnt(sources);
  learnt.learn(light_, {&x_, 1}, 4096, 7);
  const Moments a = momentsOf(plain.at(sources, 1.0f, 4), light_, x_, 1),
                b = momentsOf(learnt.at(sources, 1.0f, 4), light_, x_, 2);
  EXPECT_GT(b.mean, 0.0);
  EXPECT_NEAR(a.mean, b.mean, 5 * std::sqrt((a.variance + b.variance) / kTimes));
  EXPECT_LT(b.variance, 0.25 * a.variance);
}

TEST_F(AimTest, WhatItDoesNotExpectIsFoundWithoutSpecks) {
  // Learnt below the ceiling, from where the window shows no sky, and used where it does.
  const direct::Receiver above{{0, 1.9, 2.9}, {1, 0, 0}};
  const std::vector<direct::Source> sources = light_.sources(x_);
  direct::Aim learnt(sources);
  learnt.learn(light_, {&above, 1}, 4096, 7);
  const float level = 0.05f;
  const direct::Aim careless = learnt.at(sources, 1e6f, 4), careful = learnt.at(sources, level, 4);
  const Moments plain = momentsOf(direct::Aim(sources).at(sources, 1.0f, 4), light_, x_, 1);
  const Moments a = momentsOf(careless, light_, x_, 2), b = momentsOf(careful, light_, x_, 3);
  EXPECT_NEAR(b.mean, plain.mean, 5 * std::sqrt((b.variance + plain.variance) / kTimes));
  EXPECT_LT(b.most, a.most) << "rays for what is not expected";
  EXPECT_GE(careful.rays(), careless.rays());
  EXPECT_LE(careful.rays(), 2 * 4);
}

TEST_F(AimTest, PartsOfWhatWasLearntKnowTheirSources) {
  const std::vector<direct::Source> sources = light_.sources(x_);
  direct::Aim learnt(sources);
  learnt.learn(light_, {&x_, 1}, 1024, 7);
  const std::vector<direct::Source> few(sources.begin(), sources.begin() + 3);
  EXPECT_TRUE(learnt.holds(sources));
  EXPECT_TRUE(learnt.of(few).holds(few));
  EXPECT_FALSE(learnt.of(few).holds(sources));
  EXPECT_TRUE(direct::Aim().dark());
}

TEST_F(AimTest, MetersKnowHowExactTheyAre) {
  const std::vector<direct::Source> sources = light_.sources(x_);
  const auto reading = [&](double error, std::uint64_t key) {
    return direct::measure(light_, sources, x_, 0.1f, Rgb(0.0f), error, 1 << 20, key);
  };
  const double truth = gray(reading(5e-4, 999).irradiance);
  double squares = 0;
  constexpr int kReadings = 60;
  for (std::uint64_t key = 0; key < kReadings; ++key) {
    const ProbeResult r = reading(0.02, key);
    EXPECT_LE(gray(r.standardError), 0.02 * gray(r.irradiance) * 1.0001);
    squares += std::pow((gray(r.irradiance) - truth) / gray(r.standardError), 2);
  }
  EXPECT_LT(std::sqrt(squares / kReadings), 1.4);
  EXPECT_GT(std::sqrt(squares / kReadings), 0.3);
}

}  // namespace
}  // namespace deltalux
