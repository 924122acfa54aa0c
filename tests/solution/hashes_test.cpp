// Hashes of what solutions are: of their mesh, of where lines go from it, and of where particles do.
#include <gtest/gtest.h>

#include "base/parallel.hpp"
#include "support/furnished_room.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// Which hashes of two differ: "mesh lines particles".
std::string differences(const SolutionHashes& a, const SolutionHashes& b) {
  std::string all;
  if (a.mesh != b.mesh) all += "mesh ";
  if (a.lines != b.lines) all += "lines ";
  if (a.particles != b.particles) all += "particles ";
  return all;
}

const Solution& furnished() {
  static const Engine engine = solved(furnishedRoom(), 0.2);
  return engine.solution().get();
}

/// The same with a change.
template <class Change>
SolutionHashes changed(const Change& change) {
  Solution s = furnished();
  change(s);
  return hashesOf(s);
}

/// Two leaves that are parts of one patch, and have lines.
std::pair<std::uint32_t, std::uint32_t> siblings(const Solution& s) {
  const hierarchy::LeafTable leaves(s.elements);
  for (std::uint32_t i = 0; i + 1 < leaves.size(); ++i)
    if (s.lines.countOf(leaves[i]) > 0 && s.lines.countOf(leaves[i + 1]) > 0 &&
        s.elements.at(leaves[i]).parent == s.elements.at(leaves[i + 1]).parent && s.elements.at(leaves[i]).depth > 0)
      return {leaves[i].value, leaves[i + 1].value};
  return {};
}

TEST(Hashes, AreTheSameForAnyNumberOfThreads) {
  const ThreadLimit one(1);
  const Engine alone = solved(furnishedRoom(), 0.2);
  EXPECT_EQ(differences(hashesOf(alone.solution().get()), hashesOf(furnished())), "");
  const SolutionHashes hashes = hashesOf(furnished());
  EXPECT_TRUE(hashes.mesh != 0 && hashes.lines != 0 && hashes.particles != 0);
}

TEST(Hashes, TellWhatIsOther) {
  const SolutionHashes hashes = hashesOf(furnished());
  const hierarchy::LeafTable leaves(furnished().elements);
  EXPECT_EQ(differences(changed([](Solution&) {}), hashes), "");
  EXPECT_EQ(differences(changed([&](Solution& s) { s.elements.geometry[leaves[3].index()].exposed *= 0.5f; }), hashes),
            "mesh ");
  // Lines know leaves by their keys.
  EXPECT_EQ(differences(changed([&](Solution& s) { ++s.elements.key[siblings(s).first]; }), hashes), "mesh lines ");
  const auto straight = [](const Solution& s) {
    std::uint64_t k = 0;
    while (s.lines.end[k] >= lines::kFirstMark) ++k;
    return k;
  };
  EXPECT_EQ(differences(changed([&](Solution& s) { s.lines.end[straight(s)] = lines::kEscaped; }), hashes), "lines ");
  EXPECT_EQ(differences(changed([&](Solution& s) { s.lines.end[straight(s)] ^= 1; }), hashes), "lines ");
  ASSERT_FALSE(furnished().lines.exceptions.all.empty());
  EXPECT_EQ(differences(changed([](Solution& s) { s.lines.exceptions.all.back().weight.g *= 1.001f; }), hashes),
            "lines ");
  EXPECT_EQ(differences(changed([](Solution& s) { s.lines.exceptions.all.back().end ^= 1; }), hashes), "lines ");
  ASSERT_GT(furnished().particles.impacts(), 0u);
  EXPECT_EQ(differences(changed([](Solution& s) { s.particles.throughput[0].r *= 1.001f; }), hashes), "particles ");
  EXPECT_EQ(differences(changed([](Solution& s) { s.particles.uv[0].x += 0.001f; }), hashes), "particles ");
}

TEST(Hashes, DoNotTellLight) {
  // Light settles to within a tolerance, so it is not what two solutions are the same by.
  EXPECT_EQ(differences(changed([](Solution& s) {
                          for (hierarchy::ElementLight& l : s.elements.radiometry) l.B *= 2, l.indirect *= 3;
                          for (float& d : s.deviation) d *= 2;
                        }),
                        hashesOf(furnished())),
            "");
}

TEST(Hashes, DoNotDependOnTheOrderOfLeaves) {
  const auto [a, b] = siblings(furnished());
  ASSERT_NE(a, b);
  const SolutionHashes swapped = changed([a = a, b = b](Solution& s) {
    std::swap(s.elements.key[a], s.elements.key[b]);
    std::swap(s.elements.geometry[a], s.elements.geometry[b]);
    const auto other = [&](std::uint32_t leaf) { return leaf == a ? b : leaf == b ? a : leaf; };
    lines::Lines& now = s.lines;
    std::swap(now.of[a], now.of[b]);
    std::swap(now.exceptions.of[a], now.exceptions.of[b]);
    for (std::uint32_t& end : now.end)
      if (end < lines::kFirstMark) end = other(end);
    for (lines::ExceptionalLine& e : now.exceptions.all) e.end = other(e.end);
    EXPECT_NO_THROW(lines::validate(now));
  });
  EXPECT_EQ(differences(swapped, hashesOf(furnished())), "");
}

}  // namespace
}  // namespace deltalux
