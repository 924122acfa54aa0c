// Samples know what they were read from: those that an edit makes wrong are told, and few others.
#include <gtest/gtest.h>

#include <deltalux/solution_reader.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "render/mirror_room.hpp"

namespace deltalux {
namespace {

using test::mirrorRoom;

constexpr int kSize = 96;

SolutionView solvedMirrorRoom() {
  static const Engine engine = test::solved(mirrorRoom(), 0.1);
  return engine.solution();
}

struct Watched {
  Engine engine;
  SolutionReader reader;
  std::vector<PixelSample> samples;

  explicit Watched(SolutionView solution = solvedMirrorRoom())
      : engine(std::move(solution)), reader(engine.solution()), samples(trace()) {}
  std::vector<PixelSample> trace() const { return reader.trace(test::raysOf(test::towardsMirror(), kSize, kSize)); }
  void apply(const Edit& edit) {
    engine.apply(edit);
    engine.update();
    reader.refresh();
  }
};

/// Steps of eight bits between two radiances, as a screen shows them.
double stepsApart(const Rgb& a, const Rgb& b, double exposure) {
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    const auto shown = [&](float x) { return 255 * encodeSrgb(std::min(1.0, exposure * double(x))); };
    most = std::max(most, std::abs(shown(a[c]) - shown(b[c])));
  }
  return most;
}

bool samePath(const PixelSample& a, const PixelSample& b) {
  if (a.corners != b.corners || !a.complete || !b.complete) return false;
  for (int i = 0; i < a.corners; ++i)
    if (a.path[i].position != b.path[i].position || a.path[i].primitive != b.path[i].primitive) return false;
  return true;
}

struct Tally {
  int wrong = 0, missed = 0, same = 0, dropped = 0;  // too far off; of those, not told; unchanged; of those, told
};
Tally tally(const Watched& w) {
  const std::vector<PixelSample> now = w.trace();
  Image image;
  image.width = image.height = kSize;
  for (const PixelSample& s : now) image.pixels.push_back(s.radiance);
  const double exposure = std::exp2(automaticEv(image));
  const auto changes = w.reader.changes();
  Tally t;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const bool stale = changes->stale(w.samples[i]);
    if (stepsApart(now[i].radiance, w.samples[i].radiance, exposure) > 1) ++t.wrong, t.missed += !stale;
    if (samePath(now[i], w.samples[i]) && now[i].radiance == w.samples[i].radiance) ++t.same, t.dropped += stale;
  }
  return t;
}

TEST(SampleTrace, ReadsWhatAPictureOfTheMeshShows) {
  const Watched w;
  RenderSettings settings;
  settings.width = settings.height = kSize, settings.meshDirect = true, settings.samplesPerPixel = 1;
  const Image image = render(w.engine.solution(), test::towardsMirror(), settings);
  std::size_t close = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    close += std::abs(gray(image.pixels[i]) - gray(w.samples[i].radiance)) < 0.05f * gray(image.pixels[i]) + 1e-3f;
  EXPECT_GT(close, image.pixels.size() * 9 / 10) << "rays differ within pixels";
}

TEST(SampleTrace, NotesThePathAndWhereItsImageSeemsToBe) {
  const Watched w;
  int mirrored = 0;
  for (const PixelSample& s : w.samples) {
    ASSERT_TRUE(s.complete);
    ASSERT_GE(s.corners, 1);
    EXPECT_EQ(s.path[0].position, s.position);
    if (s.primitive != PrimitiveId(test::kRoomMirror)) {
      EXPECT_EQ(s.corners, 1);
      EXPECT_EQ(s.apparent, s.position);
      continue;
    }
    ++mirrored;
    ASSERT_EQ(s.corners, 2);
    EXPECT_EQ(s.path[1].before, 0);
    // The mirror's plane is y = 1.99: images are as far behind as things are before it.
    const Vec3f image(s.path[1].position.x, 2 * 1.99f - s.path[1].position.y, s.path[1].position.z);
    EXPECT_LT(glm::length(s.apparent - image), 1e-4f);
  }
  EXPECT_GT(mirrored, 1000);
}

TEST(SampleTrace, FollowsBothWaysOfAPane) {
  Scene scene = mirrorRoom();
  test::addPolygon(scene, test::addMaterial(scene, "pane", ThinGlass{}),
                   {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {1.5, 0.5, 1.5}, {0.5, 0.5, 1.5}});
  const PrimitiveId pane(scene.primitives.size() - 1);
  const Watched w(test::solved(std::move(scene), 0.1).solution());
  int through = 0;
  for (const PixelSample& s : w.samples) {
    if (s.primitive != pane) continue;
    ++through;
    ASSERT_GE(s.corners, 3);
    EXPECT_EQ(s.path[1].before, 0) << "what it reflects";
    EXPECT_LT(s.path[1].position.y, 0.5f);
    EXPECT_EQ(s.path[2].before, 0) << "what is behind it";
    EXPECT_GT(s.path[2].position.y, 0.5f);
    const Vec3f along = glm::normalize(s.position - s.eye);
    EXPECT_LT(glm::length(glm::cross(s.apparent - s.eye, along)), 1e-4f) << "the image is on the pixel's ray";
    EXPECT_GT(glm::dot(s.apparent - s.position, along), 0.1f);
  }
  EXPECT_GT(through, 1000);
}

TEST(SampleChanges, NothingIsStaleWhereNothingWasEdited) {
  Watched w;
  w.reader.refresh();
  for (const PixelSample& s : w.samples) ASSERT_FALSE(w.reader.changes()->stale(s));
}

TEST(SampleChanges, TellsAllThatAMovedBlockChanges) {
  Watched w;
  w.apply(TransformObject{"block", glm::translate(Mat4(1.0), Vec3(0.25, 0.1, 0.1))});
  const Tally t = tally(w);
  EXPECT_GT(t.wrong, 200);
  EXPECT_EQ(t.missed, 0);
  EXPECT_LE(t.dropped, t.same / 4) << "what is the same to the bit stays, but for what shares a patch";
}

/// A second room, closed, with a lamp and a block of its own.
Scene twoRooms() {
  Scene scene = mirrorRoom();
  test::addBox(scene, MaterialId(0), {10, 0, 0}, {12, 2, 2}, true);
  test::addPolygon(scene, MaterialId(2), {{10.7, 0.7, 1.98}, {10.7, 1.3, 1.98}, {11.3, 1.3, 1.98}, {11.3, 0.7, 1.98}});
  const std::size_t block = scene.primitives.size();
  test::addBox(scene, MaterialId(0), {10.3, 0.9, 0.3}, {10.5, 1.1, 0.5}, false);
  const ObjectId object = internObject(scene, "other", '.');
  for (std::size_t p = block; p < scene.primitives.size(); ++p) scene.primitives[p].object = object;
  addAreaLights(scene);
  return scene;
}

TEST(SampleChanges, LeaveAloneWhatAnEditDoesNotReach) {
  // Over links, whose elements keep their numbers; over lines all leaves are taken for others after an update.
  Watched w(test::solved(twoRooms(), 0.1, SolveMethod::Paper).solution());
  w.apply(TransformObject{"other", glm::translate(Mat4(1.0), Vec3(0.25, 0.1, 0.1))});
  EXPECT_EQ(tally(w).wrong, 0);
  for (const PixelSample& s : w.samples) ASSERT_FALSE(w.reader.changes()->stale(s));
}

TEST(SampleChanges, FollowManyStepsOfADrag) {
  Watched w;
  for (int i = 0; i < 70; ++i) {
    w.engine.apply(TransformObject{"block", glm::translate(Mat4(1.0), Vec3(0.01, 0, 0))});
    w.engine.frame(1e3);
    w.reader.refresh();
    EXPECT_LE(w.reader.changes()->places.size(), 64u);
  }
  w.engine.update();
  w.reader.refresh();
  const Tally t = tally(w);
  EXPECT_GT(t.wrong, 200);
  EXPECT_EQ(t.missed, 0);
}

TEST(SampleChanges, GoWithTheLampThatIsSeen) {
  Watched w;
  w.apply(ScaleLight{w.engine.solution().scene().lights[0].name, 1.5f});
  EXPECT_EQ(tally(w).missed, 0);
  for (const PixelSample& s : w.samples) EXPECT_TRUE(w.reader.changes()->stale(s));
}

}  // namespace
}  // namespace deltalux
