// Light that is taken out of receivers and put in again is the light that gathering everything finds.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "hierarchy/input_level.hpp"
#include "paper/update.hpp"
#include "support/furnished_room.hpp"
#include "support/solved.hpp"

namespace deltalux {
using hierarchy::ElementId;
using paper::IrradianceLists;

namespace {

/// A copy of a solution over links that is worked on by hand.
struct Work {
  explicit Work(Scene scene, double error = 0.1) : engine(test::solved(std::move(scene), error, SolveMethod::Paper)) {}

  Engine engine;
  Solution s = engine.solution().get();
  particles::ParticleTransfer transfer{s.particles, s.elements, s.scene};
  IrradianceLists lists{s.elements};

  paper::Parts parts() { return {s.scene, *s.tracer, s.elements, s.links}; }
  /// Diffuse light of each leaf.
  std::vector<float> light() const {
    std::vector<float> E;
    for (std::size_t i = 0; i < s.elements.size(); ++i)
      if (s.elements.isReceivingLeaf(ElementId(i)))
        E.push_back(gray(s.elements.radiometry[i].direct + s.elements.radiometry[i].indirect));
    return E;
  }
  void gatherAll() {
    paper::iterate(parts(), transfer, paper::kConvergedWell, [](const auto&) { return true; });
  }
};

double largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, double(std::abs(a[i] - b[i]))), largest = std::max(largest, double(b[i]));
  return most / largest;
}

void expectAsGathered(Work& w) {
  const std::vector<float> E = w.light();
  w.gatherAll();
  EXPECT_LT(largestDifference(E, w.light()), 2e-4);
}

TEST(IrradianceLists, AConvergedSolutionStaysAsItIs) {
  Work w(test::furnishedRoom());
  const std::vector<float> before = w.light();
  const paper::IterationReport iterated = w.lists.iterate(w.parts(), w.transfer, {}, paper::kConvergedWell);
  EXPECT_TRUE(iterated.whole);
  EXPECT_LT(largestDifference(w.light(), before), 1e-4);
  EXPECT_NO_THROW(w.lists.validate(w.s.elements, w.s.links));
}

TEST(IrradianceLists, ADimmedLampReachesItsReceivers) {
  Work w(test::furnishedRoom());
  for (std::size_t i = 0; i < w.s.elements.size(); ++i)
    if (w.s.elements.at(ElementId(i)).emitter) w.s.elements.radiometry[i].B *= 0.5f;
  for (hierarchy::ClusterLight& c : w.s.elements.clusters)
    if (&c == &w.s.elements.cluster(w.s.elements.lightRoot))
      for (Rgb& k : c.intensity.c) k *= 0.5f;
  w.lists.iterate(w.parts(), w.transfer, {}, paper::kConvergedWell);
  EXPECT_NO_THROW(w.lists.validate(w.s.elements, w.s.links));
  expectAsGathered(w);
}

TEST(IrradianceLists, AMotionIsFollowedByWhatItChanges) {
  Work w(test::furnishedRoom());
  for (const double x : {-0.3, -0.3, 0.5}) {
    Mat4 matrix(1.0);
    matrix[3] = glm::dvec4(x, 0.1, 0, 1);
    const AppliedEdit applied = applyEdit(w.s.scene, TransformObject{"box", matrix});
    w.s.tracer = tracing::makeEmbreeTracer(w.s.scene);
    paper::LinkMarks marks = paper::leave(w.parts(), applied.change.moved, {});
    paper::arrive(w.parts(), marks, {});
    paper::follow(w.parts(), marks, paper::oracleSettingsFor(0.1), w.lists);
    w.transfer = particles::ParticleTransfer(w.s.particles, w.s.elements, w.s.scene);
    std::vector<PrimitiveId> primitives;
    for (const auto& m : applied.change.moved) primitives.push_back(m.primitive);
    const std::vector<ElementId> moved = hierarchy::elementsOf(w.s.elements, primitives);
    const paper::IterationReport iterated = w.lists.iterate(w.parts(), w.transfer, moved, paper::kConvergedWell);
    EXPECT_TRUE(iterated.whole);
    ASSERT_NO_THROW(w.lists.validate(w.s.elements, w.s.links));
    Work copy = Work(test::furnishedRoom(), 0.5);
    copy.s = w.s, copy.transfer = w.transfer;
    expectAsGathered(copy);
  }
}

}  // namespace
}  // namespace deltalux
