// The cabin model: as one flat file, and as its authors wrote it, with generators, nested transforms and arrays.
#include <gtest/gtest.h>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>

#include <map>
#include <set>

#include "support/shared.hpp"

namespace deltalux {
namespace {

std::vector<std::filesystem::path> authoredFiles(const std::filesystem::path& shared,
                                                 std::initializer_list<const char*> names) {
  std::vector<std::filesystem::path> files;
  for (const char* name : names) files.push_back(shared / "scenes/cabin-original" / name);
  return files;
}

TEST(Cabin, AllSurfacesAreFound) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const auto [scene, report] = loadScene({shared / "scenes/cabin/cabin.rad"});
  const std::map<std::string, std::size_t> expected{
      {"polygon", 1507}, {"cylinder", 644}, {"sphere", 512}, {"cone", 149}, {"ring", 23}, {"tube", 1}, {"source", 3}};
  EXPECT_EQ(report.surfaces, expected);
  EXPECT_TRUE(report.ignored.empty());
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_NO_THROW(validate(scene));
  ASSERT_EQ(findObjects(scene, "container").size(), 1u);
  EXPECT_EQ(primitivesOf(scene, findObjects(scene, "container")[0]).size(), 3u);
  EXPECT_EQ(findLights(scene, "sun").size(), 1u);
}

/// Distance between two shapes of one kind by their bounds, areas and facing; infinite between different kinds.
double difference(const Shape& a, const Shape& b) {
  if (a.index() != b.index()) return kInfinity;
  const Box boundsA = bounds(a), boundsB = bounds(b);
  const double facing = glm::dot(pointAt(a, {0.3, 0.4}).normal, pointAt(b, {0.3, 0.4}).normal);
  const bool flat = std::holds_alternative<Polygon>(a) || std::holds_alternative<Ring>(a);
  if (flat && facing < 0.999) return kInfinity;
  return glm::distance(boundsA.lower, boundsB.lower) + glm::distance(boundsA.upper, boundsB.upper) +
         std::abs(area(a) - area(b));
}

TEST(Cabin, AsAuthoredIsTheFlatFile) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const auto files =
      authoredFiles(shared, {"testmats", "cabin", "bathroom", "furniture", "winpanes.rad", "mirrors.rad", "lights"});
  const auto [authored, report] = loadScene(files);
  const Scene flat = loadScene({shared / "scenes/cabin/cabin.rad"}).scene;
  EXPECT_NO_THROW(validate(authored));

  std::multimap<std::string, const Primitive*> byName;
  for (const Primitive& primitive : flat.primitives) byName.emplace(flat[primitive.object].name, &primitive);
  for (const Primitive& primitive : authored.primitives) {
    const std::string& name = authored[primitive.object].name;
    auto [begin, end] = byName.equal_range(name);
    auto best = end;
    double least = kInfinity;
    for (auto candidate = begin; candidate != end; ++candidate) {
      const double d = difference(primitive.shape, candidate->second->shape);
      if (d < least) least = d, best = candidate;
    }
    ASSERT_LT(least, 1e-6) << name;
    EXPECT_EQ(authored[primitive.material].name, flat[best->second->material].name) << name;
    byName.erase(best);
  }
  std::set<std::string> added;  // what the flat file has beyond the model
  for (const auto& [name, primitive] : byName) added.insert(name.substr(0, name.find('.')));
  EXPECT_EQ(added, (std::set<std::string>{"container", "dresserspot", "ring"}));
}

TEST(Cabin, DaylightFilesReadNatively) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const auto [scene, report] = loadScene(authoredFiles(shared, {"testmats", "summermorn", "daywindows"}));
  EXPECT_EQ(report.surfaces.at("source"), 3u);
  EXPECT_EQ(report.surfaces.at("polygon"), 6u);
  EXPECT_NO_THROW(validate(scene));
}

TEST(Cabin, WhatCannotBeReadIsNamed) {
  DELTALUX_SHARED_OR_SKIP(shared);
  try {
    loadScene(authoredFiles(shared, {"landscape"}));
    FAIL() << "noise2.cal is not there";
  } catch (const InputError& error) {
    EXPECT_EQ(error.line(), 8);
    EXPECT_NE(error.message().find("noise2.cal"), std::string::npos);
  }
}

TEST(Cabin, ViewsAreRead) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const View view = loadView(shared / "scenes/cabin/dresser.vf");
  EXPECT_EQ(view.name, "dresser");
  EXPECT_EQ(view.position, Vec3(6.2, 6.2, 5.4));
  EXPECT_EQ(view.horizontal, 50);
  EXPECT_EQ(view.vertical, 40);
}

}  // namespace
}  // namespace deltalux
