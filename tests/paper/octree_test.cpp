// The octree around an object that moves knows which links cross where it is.
#include <gtest/gtest.h>

#include "paper/octree.hpp"
#include "particles/segment_box.hpp"
#include "support/furnished_room.hpp"

namespace deltalux {
using paper::LinkTable;
using paper::Octree;
using paper::OctreeChange;

namespace {

constexpr double kMargin = 1e-4;

struct Room {
  Scene scene = test::furnishedRoom();
  std::unique_ptr<tracing::RayTracer> tracer = tracing::makeEmbreeTracer(scene);
  particles::Particles particles = particles::traceParticles(scene, *tracer, {10000, 1});

  Octree around(const Box& object) const { return {particles, bounds(scene), std::vector{object}, kMargin}; }
};

const Box kBall{Vec3(1.6, 1.7, 0.76), Vec3(1.8, 1.9, 0.96)};

Box moved(const Box& box, const Vec3& by) { return {box.lower + by, box.upper + by}; }

/// Links with a path through a box, asked one by one.
std::vector<std::uint32_t> crossing(const particles::Particles& p, const Box& box) {
  const particles::SegmentBox segments(box, 0.0);
  std::vector<std::uint32_t> links;
  for (std::size_t path = 0; path < p.paths(); ++path) {
    const std::span<const Vec3f> v = p.verticesOf(path);
    for (std::size_t i = 0; i + 1 < v.size(); ++i)
      if (segments.meets(v[i], v[i + 1]) && (links.empty() || links.back() != p.link[path]))
        links.push_back(p.link[path]);
  }
  return links;
}

TEST(Octree, KnowsTheLinksThatCrossItsCells) {
  const Room room;
  const Octree octree = room.around(kBall);
  EXPECT_NO_THROW(octree.validate(room.particles));
  EXPECT_GT(octree.cells(), 100u);
  EXPECT_GT(octree.memoryBytes(), 1000u);
}

TEST(Octree, AMotionYieldsAllLinksThroughTheObjectWhereItWasAndIs) {
  const Room room;
  Octree octree = room.around(kBall);
  Box at = kBall;
  for (const Vec3& by : {Vec3(0.05, 0, 0), Vec3(0.4, -0.3, 0.2), Vec3(-0.6, 0.1, -0.3)}) {
    const Box to = moved(at, by);
    OctreeChange change;
    ASSERT_TRUE(octree.hold(room.particles, std::vector{to}, change));
    EXPECT_NO_THROW(octree.validate(room.particles));
    EXPECT_GT(change.gained, 0u);
    EXPECT_GT(change.lost, 0u);
    for (const Box& box : {at, to}) EXPECT_TRUE(std::ranges::includes(change.links, crossing(room.particles, box)));
    EXPECT_LT(change.links.size(), room.particles.links.size());
    at = to;
  }
}

TEST(Octree, IsSimplifiedWhereTheObjectWas) {
  const Room room;
  Octree octree = room.around(kBall);
  const std::size_t cells = octree.cells();
  OctreeChange change;
  const Box away = moved(kBall, {1, 1.5, 1});
  ASSERT_TRUE(octree.hold(room.particles, std::vector{away}, change));
  EXPECT_EQ(octree.cells(), room.around(away).cells());
  ASSERT_TRUE(octree.hold(room.particles, std::vector{kBall}, change));
  EXPECT_EQ(octree.cells(), cells);
  EXPECT_NO_THROW(octree.validate(room.particles));
}

TEST(Octree, LetsNothingOutUnnoticed) {
  const Room room;
  Octree octree = room.around(kBall);
  OctreeChange change;
  EXPECT_FALSE(octree.hold(room.particles, std::vector{moved(kBall, {0, 50, 0})}, change));
  EXPECT_NO_THROW(octree.validate(room.particles));
}

TEST(Octree, PathsAreTakenOutAndPutIn) {
  const Room room;
  Octree octree = room.around(kBall);
  const particles::Particles& p = room.particles;
  int taken = 0;
  for (std::uint32_t link = 0; taken < 5; ++link) {
    ASSERT_LT(link, p.links.size());
    std::vector<std::span<const Vec3f>> paths;
    for (std::size_t i = 0; i < p.links[link].paths; ++i)
      if (const auto v = p.verticesOf(p.links[link].firstPath + i); v.size() > 1) paths.push_back(v);
    if (paths.empty()) continue;  // none was ever begun
    for (const auto& vertices : paths) octree.erase(p, link, vertices);
    EXPECT_ANY_THROW(octree.validate(p));
    for (const auto& vertices : paths) octree.insert(p, link, vertices);
    ++taken;
  }
  EXPECT_NO_THROW(octree.validate(p));
}

TEST(LinkTable, HoldsWhatWasPutInAndNotTakenOut) {
  LinkTable::AllLinks all(500);
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i].ends.receiver = i % 7;
  LinkTable table;
  std::vector<char> in(all.size(), 0);
  Rng rng(4);
  for (int step = 0; step < 5000; ++step) {
    const auto link = static_cast<std::uint32_t>(rng.uniform() * double(all.size()));
    if (rng.uniform() < 0.5)
      table.insert(link, all), in[link] = 1;
    else
      table.erase(link, all), in[link] = 0;
  }
  std::vector<char> found(all.size(), 0);
  table.forEach([&](std::uint32_t link) { found[link] = 1; });
  EXPECT_EQ(found, in);
  EXPECT_EQ(table.size(), static_cast<std::size_t>(std::count(in.begin(), in.end(), 1)));
}

}  // namespace
}  // namespace deltalux
