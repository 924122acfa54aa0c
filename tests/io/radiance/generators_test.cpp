#include <gtest/gtest.h>

#include <algorithm>

#include "io/radiance/memory_files.hpp"

namespace deltalux::io::radiance::test {
namespace {

std::size_t countOf(const std::vector<RadObject>& objects, Type type) {
  return static_cast<std::size_t>(
      std::count_if(objects.begin(), objects.end(), [&](const RadObject& o) { return o.type == type; }));
}

TEST(Genbox, IsClosedAndFacesOutwards) {
  const auto box = expand("!genbox m b 2 3 4");
  ASSERT_EQ(box.size(), 6u);
  EXPECT_EQ(box[0].name, "b.1540");
  EXPECT_EQ(box[0].modifier, "m");
  EXPECT_NEAR(enclosedVolume(box), 24, 1e-12);
  EXPECT_NEAR(enclosedVolume(expand("!genbox m b 2 3 4 -i")), -24, 1e-12);
}

TEST(Genbox, BevelsCutPrismsOffTheEdgesAndPyramidsOffTheCorners) {
  const double a = 0.25;
  const auto box = expand("!genbox m b 2 3 4 -b .25");
  ASSERT_EQ(box.size(), 6u + 12u + 8u);
  // Inclusion and exclusion over the edges' prisms (a^2/2 per length): three meet in each corner's cube, where they
  // cover all but the part beyond the three bevels and the corner's cut x + y + z < 2a.
  double cut = 0;
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      // Height of the cut part of the cube over (x, y), in units of a.
      const double x = (i + 0.5) / kSteps, y = (j + 0.5) / kSteps;
      const double kept = x + y < 1 ? 0 : 1 - std::clamp(std::max({1 - x, 1 - y, 2 - x - y}), 0.0, 1.0);
      cut += (1 - kept) / (kSteps * kSteps);
    }
  }
  const double corners = 8 * a * a * a * cut;
  const double edges = 4 * (2 + 3 + 4 - 6 * a) * a * a / 2;
  EXPECT_NEAR(enclosedVolume(box), 24 - edges - corners, 1e-4);
  EXPECT_NEAR(enclosedVolume(expand("!genbox m b 2 3 4 -b .25 -i")), -enclosedVolume(box), 1e-12);
}

TEST(Genbox, RoundedBoxesHaveExactEdgesAndCorners) {
  const auto box = expand("!genbox m b 2 3 4 -r .25");
  EXPECT_EQ(countOf(box, Type::Polygon), 6u);
  EXPECT_EQ(countOf(box, Type::Cylinder), 12u);
  EXPECT_EQ(countOf(box, Type::Sphere), 8u);
  const auto inward = expand("!genbox m b 2 3 4 -r .25 -i");
  EXPECT_EQ(countOf(inward, Type::Tube), 12u);
  EXPECT_EQ(countOf(inward, Type::Bubble), 8u);
}

TEST(Genprism, ExtrudesAnOutline) {
  const std::string outline = "6 0 0 4 0 4 1 1 1 1 3 0 3";  // an L of area 6, counter-clockwise
  const auto prism = expand("!genprism m p " + outline + " -l 0 0 2");
  ASSERT_EQ(prism.size(), 8u);
  EXPECT_EQ(prism[0].name, "p.b");
  EXPECT_EQ(prism[7].name, "p.6");
  EXPECT_NEAR(std::abs(enclosedVolume(prism)), 12, 1e-12);
  EXPECT_NEAR(enclosedVolume(prism), -enclosedVolume(expand("!genprism m p " + outline + " -l 0 0 -2")), 1e-12);
  EXPECT_NEAR(std::abs(enclosedVolume(expand("!genprism m p " + outline + " -l 1 5 2"))), 12, 1e-12);
  EXPECT_EQ(expand("!genprism m p " + outline + " -l 0 0 2 -e").size(), 6u);
  EXPECT_EQ(expand("!genprism m p " + outline + " -l 0 0 2 -c").size(), 7u);
  EXPECT_EQ(expand("!genprism m p corners -l 0 0 2", {{"corners", "0 0 4 0 4 1\n1 1 1 3 0 3"}}).size(), 8u);
}

TEST(Genprism, RoundingsTouchTheFacesTheyJoin) {
  const auto prism = expand("!genprism m p 4 0 0 0 2 3 2 3 0 -l 0 0 1 -r .2");  // clockwise: faces outwards
  EXPECT_EQ(countOf(prism, Type::Polygon), 6u);
  EXPECT_EQ(countOf(prism, Type::Cylinder), 12u);
  EXPECT_EQ(countOf(prism, Type::Sphere), 8u);
  Box box;
  for (const RadObject& object : prism) {
    if (object.type == Type::Sphere) {
      const Vec3 c(object.reals[0], object.reals[1], object.reals[2]);
      box.extend(c - Vec3(object.reals[3])), box.extend(c + Vec3(object.reals[3]));
    } else if (object.type == Type::Polygon) {
      Box flat;
      for (std::size_t i = 0; i < 12; i += 3) flat.extend({object.reals[i], object.reals[i + 1], object.reals[i + 2]});
      box.extend(flat);
    }
  }
  EXPECT_NEAR(glm::distance(box.lower, Vec3(0)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(box.upper, Vec3(3, 2, 1)), 0, 1e-12);
}

TEST(Genrev, TurnsItsProfileByDirection) {
  const auto up = expand("!genrev m r t 2 1");
  EXPECT_EQ(up[0].type, Type::Cylinder);
  EXPECT_EQ(expand("!genrev m r 1-t 2 1")[0].type, Type::Tube);
  EXPECT_EQ(expand("!genrev m r t 1+t 1")[0].type, Type::Cone);
  EXPECT_EQ(expand("!genrev m r -t 1+t 1")[0].type, Type::Cup);
  const auto ring = expand("!genrev m r 3 2-t 1");
  EXPECT_EQ(ring[0].type, Type::Ring);
  EXPECT_EQ(ring[0].reals[5], 1);
  EXPECT_TRUE(expand("!genrev m r 3 2 1").empty());
}

TEST(Genrev, SmoothingIsATextureThatSurfacesName) {
  const auto objects = expand("!genrev brass r 'sin(PI*t)' 'cos(PI*t)+1' 4 -s");
  ASSERT_EQ(objects.size(), 8u);
  EXPECT_EQ(objects[0].typeName, "texfunc");
  EXPECT_EQ(objects[0].modifier, "brass");
  EXPECT_EQ(objects[1].modifier, "Phong");
  EXPECT_EQ(objects[1].name, "r.1");
}

TEST(Genrev, ApproachesTheSphere) {
  const auto [scene, report] = read("void plastic m 0 0 5 .5 .5 .5 0 0\n!genrev m r '-cos(PI*t)' 'sin(PI*t)' 200");
  double total = 0;
  for (const Primitive& primitive : scene.primitives) total += area(primitive.shape);
  EXPECT_NEAR(total, 4 * kPi, 1e-3 * 4 * kPi);
  EXPECT_EQ(report.surfaces.at("cone"), 200u);
}

TEST(Genworm, JoinsSpheresByTouchingCones) {
  const auto worm = expand("!genworm m w 3*t 0 0 1-.5*t 1");
  ASSERT_EQ(worm.size(), 3u);
  EXPECT_EQ(worm[0].name, "w.s0");
  EXPECT_EQ(worm[1].name, "w.c1");
  EXPECT_EQ(worm[2].name, "w.s1");
  // The cone's circles lie on the spheres, and its side is tangent there.
  const std::vector<double>& c = worm[1].reals;
  const double x0 = c[0], x1 = c[3], r0 = c[6], r1 = c[7];
  EXPECT_NEAR(x0 * x0 + r0 * r0, 1, 1e-12);
  EXPECT_NEAR((x1 - 3) * (x1 - 3) + r1 * r1, 0.25, 1e-12);
  EXPECT_NEAR((x1 - x0) * x0 + (r1 - r0) * r0, 0, 1e-12);
  EXPECT_EQ(expand("!genworm m w t 0 0 1 5").size(), 11u);
  EXPECT_EQ(expand("!genworm m w t 0 0 1 5")[1].type, Type::Cylinder);
}

TEST(Gensurf, NormalsFollowTheRightHand) {
  const auto flat = expand("!gensurf m s s t 0 2 2");
  ASSERT_EQ(flat.size(), 4u);  // coplanar triangles are one quadrilateral
  EXPECT_EQ(flat[3].name, "s.4");
  const std::string sphere = "'cos(2*PI*s)*sin(PI*t)' 'sin(2*PI*s)*sin(PI*t)' 'cos(PI*t)'";
  const double volume = enclosedVolume(expand("!gensurf m s " + sphere + " 64 32"));
  EXPECT_NEAR(std::abs(volume), 4 * kPi / 3, 0.01 * 4 * kPi / 3);
  EXPECT_NEAR(enclosedVolume(expand("!gensurf m s " + sphere + " 64 32 -i")), -volume, 1e-9);
}

TEST(Gensurf, LeavesInvalidVerticesOut) {
  const auto half = expand("!gensurf m s s t 0 4 4 -e 'valid(s,t)=.6-s-t'");
  EXPECT_EQ(countOf(half, Type::Polygon), 3u);  // one whole cell and the two triangles beside it
  double total = 0;
  for (const RadObject& object : half) total += object.reals.size() == 12 ? 1 : 0.5;
  EXPECT_EQ(total, 2);
}

TEST(Gensurf, SmoothedSurfacesAreMeshesWithNormals) {
  const auto [scene, report] = read(
      "void plastic m 0 0 5 .5 .5 .5 0 0\n"
      "!gensurf m s '3*cos(PI*s)' '3*sin(PI*s)' '2*t' 16 2 -s | xform -mx -s 2 -t 1 0 0");
  ASSERT_EQ(scene.primitives.size(), 1u);
  EXPECT_EQ(scene.objects[0].name, "s");
  const Mesh& mesh = std::get<Mesh>(scene.primitives[0].shape);
  ASSERT_EQ(mesh.positions.size(), 17u * 3u);
  ASSERT_EQ(mesh.triangles.size(), 16u * 2u * 2u);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 radial = glm::normalize(Vec3(mesh.positions[i].x - 1, mesh.positions[i].y, 0));
    EXPECT_GT(glm::dot(mesh.normals[i], radial), 0.9999);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& p = mesh.positions;
    EXPECT_GT(glm::dot(glm::cross(p[b] - p[a], p[c] - p[a]), mesh.normals[a]), 0);
  }
  EXPECT_EQ(report.surfaces.at("mesh"), 1u);
  EXPECT_NO_THROW(validate(scene));
}

TEST(Generators, ReadDefinitionFiles) {
  EXPECT_EQ(expand("!genrev m r 'f(t)' 1 n -f my.cal", {{"my.cal", "f(x)=2*x; n=3;"}}).size(), 3u);
}

TEST(Generators, SayWhatIsWrong) {
  const auto expectError = [](const std::string& command, const std::string& part) {
    const std::string error = errorOf("\n" + command);
    EXPECT_TRUE(error.starts_with("test.rad:2: ") && error.find(part) != std::string::npos) << command << "\n" << error;
  };
  expectError("!genbox m b 1 1", "usage: genbox");
  expectError("!genbox m b 1 1 0", "greater than zero");
  expectError("!genbox m b 1 1 1 -r .6", "leaves nothing");
  expectError("!genbox m b 1 1 1 -o", "no option '-o'");
  expectError("!genbox m b 1 1 nan", "'nan'");
  expectError("!genprism m p 2 0 0 1 1", "at least 3");
  expectError("!genprism m p 99999999 0 0 1 1", "missing a vertex");
  expectError("!genprism m p 3 0 0 1 0 0 1 -l 1 1 0", "leaves its plane");
  expectError("!genprism m p 3 0 0 1 0 0 1 -r 2", "greater than the prism's height");
  expectError("!genprism m p 3 0 0 0 0 0 1 -r .1", "no length");
  expectError("!genprism m p nofile", "cannot find the file 'nofile'");
  expectError("!genrev m r t -1 3", "below zero");
  expectError("!genrev m r t 1 1e9", "no number of segments");
  expectError("!genworm m w t t t 1", "missing nseg");
  expectError("!genworm m w 1/t 0 0 1 4", "not finite");
  expectError("!gensurf m s s t 0 1e5 1e5", "too many cells");
  expectError("!gensurf m s '1/s' t 0 2 2", "not finite");
  expectError("!gensurf m s s t 0 2 2 -f x.cal", "cannot find the file 'x.cal'");
}

}  // namespace
}  // namespace deltalux::io::radiance::test
