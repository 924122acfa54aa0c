#pragma once
// Small scenes that ask everything of a ray tracer, and random rays through them.
#include <deltalux/scene.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "tracing/ray.hpp"

namespace deltalux::test {

struct NamedScene {
  std::string name;
  Scene scene;
  bool ties = false;  // surfaces coincide: which primitive is hit is open, only where is not
  // Share of rays that pass an edge within rounding of single precision, where the tracers may differ.
  double edgeRate = 1e-5;
};

inline void PrintTo(const NamedScene& named, std::ostream* out) { *out << named.name; }

inline Vec3 randomIn(const Box& box, Rng& rng) {
  return box.lower + box.extent() * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
}

inline Vec3 randomDirection(Rng& rng) {
  const double z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Material 0 is opaque, material 1 a pane.
inline Scene emptyScene() {
  Scene scene;
  scene.materials = {{"opaque", Opaque{}, std::nullopt},
                     {"pane", ThinGlass{Rgb(0.96f, 0.9f, 0.8f), 1.52f}, std::nullopt}};
  return scene;
}

inline PrimitiveId add(Scene& scene, Shape shape, int material = 0) {
  scene.primitives.push_back({std::move(shape), MaterialId(material), ObjectId()});
  return PrimitiveId(scene.primitives.size() - 1);
}

inline void addPolygon(Scene& scene, std::vector<Vec3> vertices, int material = 0) {
  if (auto polygon = makePolygon(std::move(vertices))) add(scene, std::move(*polygon), material);
}

/// Six faces that look outwards.
inline void addBox(Scene& scene, const Box& box, const glm::dmat3& turn = glm::dmat3(1), int material = 0) {
  static constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& face : kFaces) {
    std::vector<Vec3> vertices;
    for (const int corner : face)
      vertices.push_back(turn * Vec3(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                                     corner & 4 ? box.upper.z : box.lower.z));
    addPolygon(scene, std::move(vertices), material);
  }
}

inline glm::dmat3 someTurn() {
  const Frame frame(glm::normalize(Vec3(0.3, -0.5, 0.8)));
  return {frame.tangent, frame.bitangent, frame.normal};
}

inline Mesh bumpyMesh(const Vec3& at, int n, double size) {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      positions.push_back(at + size / n * Vec3(i, j, 0.3 * n * std::sin(0.9 * i) * std::cos(1.3 * j)));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto a = static_cast<std::uint32_t>(i * (n + 1) + j), b = a + static_cast<std::uint32_t>(n) + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  return *makeMesh(std::move(positions), std::move(triangles));
}

/// A random shape of every kind in turn, about `size` across.
inline Shape randomShape(int kind, const Vec3& at, double size, Rng& rng) {
  const Vec3 axis = randomDirection(rng);
  const Frame frame(axis);
  const auto place = [&](double x, double y) { return at + size * frame.toWorld({x, y, 0}); };
  const bool inward = rng.uniform() < 0.5;
  switch (kind % 9) {
    case 0:
      return *makePolygon({place(0, 0), place(1, 0), place(1 + 0.5 * rng.uniform(), 1), place(0.3, 1)});
    case 1:
      return *makePolygon({place(0, 0), place(1, 0), place(1, 0.4), place(0.4, 0.4), place(0.4, 1), place(0, 1)});
    case 2:
      return *makePolygon({place(0, 0), place(1, 0), place(1, 1), place(0, 1), place(0, 0), place(0.2, 0.2),
                           place(0.2, 0.8), place(0.8, 0.8), place(0.8, 0.2), place(0.2, 0.2)});
    case 3:
      return Sphere{at, size * (0.1 + 0.4 * rng.uniform()), inward};
    case 4:
      return Cylinder{at, at + size * axis, size * (0.02 + 0.3 * rng.uniform()), inward};
    case 5:
      return Cone{at, at + size * axis, 0.5 * size * rng.uniform(), 0.5 * size * rng.uniform(), inward};
    case 6:
      return Cone{at, at + size * axis, 0.5 * size * rng.uniform(), 0, inward};
    case 7:
      return Ring{at, axis, rng.uniform() < 0.5 ? 0.0 : 0.2 * size, size * (0.3 + 0.3 * rng.uniform())};
    default:
      return bumpyMesh(at, 3, size);
  }
}

inline Scene randomScene(int shapes, const Vec3& at, double spread, double size, std::uint64_t seed) {
  Scene scene = emptyScene();
  Rng rng(seed);
  const Box box{at - Vec3(spread), at + Vec3(spread)};
  for (int i = 0; i < shapes; ++i) add(scene, randomShape(i, randomIn(box, rng), size, rng));
  return scene;
}

inline std::vector<NamedScene> nastyScenes() {
  std::vector<NamedScene> scenes;
  Rng rng(99);
  scenes.push_back({"zoo", randomScene(90, {0, 0, 0}, 3, 1, 1)});
  scenes.push_back({"far_from_the_origin", randomScene(45, {500, -300, 40}, 3, 1, 2)});
  scenes.push_back({"small_things_in_a_large_room", randomScene(90, {30, 30, 3}, 4, 0.02, 3)});
  addBox(scenes.back().scene, {{0, 0, 0}, {60, 60, 20}});
  scenes.back().edgeRate = 1e-4;  // a thousandth of a polygon's size is lost

  Scene slivers = emptyScene();
  for (int i = 0; i < 60; ++i) {
    const Vec3 a = randomIn({{0, 0, 0}, {5, 5, 5}}, rng), along = 4.0 * randomDirection(rng);
    const Vec3 across = std::pow(10.0, -1 - 5 * rng.uniform()) * Frame(glm::normalize(along)).tangent;
    addPolygon(slivers, {a, a + along, a + along + across});
    const Vec3 b = a + Vec3(0.1);
    addPolygon(slivers, {b, b + along, b + 0.9 * along + across, b + 0.1 * along + across});
  }
  scenes.push_back({"slivers", slivers, false, 1e-4});

  Scene tiny = emptyScene();
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = randomIn({{9.9, 9.9, 9.9}, {10.1, 10.1, 10.1}}, rng);
    addPolygon(tiny, {a, a + 1e-3 * randomDirection(rng), a + 1e-3 * randomDirection(rng)});
  }
  scenes.push_back({"tiny_triangles", tiny});

  Scene stacked = emptyScene();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) addBox(stacked, {Vec3(i, j, 0), Vec3(i + 1, j + 1, 1 + 0.5 * i)});
  scenes.push_back({"touching_boxes", stacked, true});

  Scene coplanar = emptyScene();
  for (int i = 0; i < 20; ++i) {
    const Vec3 a = randomIn({{0, 0, 2}, {3, 3, 2}}, rng);
    addPolygon(coplanar, {a, a + Vec3(2, 0, 0), a + Vec3(2, 1, 0), a + Vec3(0, 1, 0)});
  }
  add(coplanar, Ring{{2, 2, 2}, {0, 0, -1}, 0, 1.5});
  scenes.push_back({"coplanar", coplanar, true});

  Scene sheets = emptyScene();
  for (int i = 0; i < 8; ++i) {
    const Vec3 a(28, 29, 30 + 1e-3 * i);
    addPolygon(sheets, {a, a + Vec3(4, 0, 0), a + Vec3(4, 3, 0), a + Vec3(0, 3, 0)});
    const Vec3 b(1 + 1e-3 * i, 0.2, 0.1);
    addPolygon(sheets, {b, b + Vec3(0, 1, 0), b + Vec3(0, 1, 1), b + Vec3(0, 0, 1)});
  }
  scenes.push_back({"sheets_a_thousandth_apart", sheets});

  Scene sealed = emptyScene();
  addBox(sealed, {{-1, -2, -3}, {3, 2, 1}}, someTurn());
  addBox(sealed, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, someTurn());
  scenes.push_back({"sealed_box", sealed});

  Scene corridor = emptyScene();
  addPolygon(corridor, {{0, 0, 0}, {100, 0, 0}, {100, 0, 3}, {0, 0, 3}});
  addPolygon(corridor, {{0, 0.5, 0}, {0, 0.5, 3}, {100, 0.5, 3}, {100, 0.5, 0}});
  add(corridor, Ring{{100, 0.25, 1.5}, {-1, 0, 0}, 0.1, 0.2});
  scenes.push_back({"corridor", corridor});

  Scene wires = emptyScene();
  for (int i = 0; i < 40; ++i) {
    const Vec3 a = randomIn({{20, 20, 0}, {40, 40, 10}}, rng), b = a + 8.0 * randomDirection(rng);
    add(wires, Cylinder{a, b, 0.002 * (1 + i), i % 2 == 1});
    add(wires, Cone{b, a, 0.01 * i + 0.01, 0, i % 2 == 0});
    add(wires, Cone{b + Vec3(1), a + Vec3(1), 0.02, 0.02 + 1e-6 * i, false});
  }
  scenes.push_back({"wires", wires});

  Scene plain = emptyScene();
  addPolygon(plain, {{-5000, -5000, 0}, {5000, -5000, 0}, {5000, 5000, 0}, {-5000, 5000, 0}});
  for (int i = 0; i < 18; ++i) add(plain, randomShape(i, {0.3 * i, 0, 0.5}, 0.5, rng));
  scenes.push_back({"things_on_a_wide_plain", plain, false, 1e-3});  // things of 0.5, seen from 5000 away
  return scenes;
}

/// Rays that begin anywhere around the scene: half of them in any direction, half towards a point of some primitive.
inline tracing::Ray randomRay(const Scene& scene, const Box& box, Rng& rng) {
  tracing::Ray ray;
  const Vec3 margin = 0.1 * box.extent() + Vec3(1e-3);
  const Vec3 origin = randomIn({box.lower - margin, box.upper + margin}, rng);
  Vec3 direction = randomDirection(rng);
  if (rng.uniform() < 0.5) {
    const auto target = static_cast<std::size_t>(rng.uniform() * static_cast<double>(scene.primitives.size()));
    direction = samplePoint(scene.primitives[target].shape, {rng.uniform(), rng.uniform()}).position - origin;
  }
  ray.origin = Vec3f(origin);
  ray.direction = Vec3f(glm::normalize(direction));
  return ray;
}

}  // namespace deltalux::test
