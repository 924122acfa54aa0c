// What samples of a link carry is, in the mean, what passes from its sender to its receiver: held against integrals
// over both ends that know nothing of how the samples are drawn.
#include "particles/emission.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "base/random.hpp"
#include "particles/ds_links.hpp"
#include "stats/chi_square.hpp"
#include "stats/t_test.hpp"
#include "support/rooms.hpp"

namespace deltalux {
using namespace particles;

namespace {

constexpr double kSignificance = 1e-4;
constexpr int kSamples = 40000;

struct World {
  Scene scene;
  std::unique_ptr<tracing::RayTracer> tracer;
  std::unique_ptr<scene::LightSampler> lights;
  std::unique_ptr<Senders> senders;
  std::unique_ptr<Receivers> receivers;
  std::unique_ptr<ParticleEmission> emission;

  explicit World(Scene s) : scene(std::move(s)) {
    tracer = tracing::makeEmbreeTracer(scene);
    lights = std::make_unique<scene::LightSampler>(scene);
    senders = std::make_unique<Senders>(scene, *lights);
    std::vector<float> strength(senders->cells().size(), 1.0f);
    senders->weigh(strength);
    receivers = std::make_unique<Receivers>(scene);
    emission = std::make_unique<ParticleEmission>(scene, *tracer, *senders, *receivers);
  }

  /// Flux that arrives over a link, by its own samples.
  test::Moments flux(const LinkEnds& ends, std::uint64_t key) const {
    test::Moments m;
    std::vector<FirstSegment> segments;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      Rng rng(key, i);
      EmissionNumbers u;
      for (Vec2* v : {&u.choice, &u.origin, &u.direction}) *v = {rng.uniform(), rng.uniform()};
      emission->sample(ends, u, segments.emplace_back());
    }
    std::vector<FirstHit> arrivals(segments.size());
    std::uint64_t rays = 0;
    FirstRays memory;
    emission->arrive(std::vector<LinkEnds>(segments.size(), ends), segments, arrivals, memory, rays);
    for (const FirstHit& a : arrivals) m.add(a.primitive.valid() ? a.flux.g : 0.0);
    return m;
  }

  /// The same by rays from the whole sender in all its directions: those whose first surface, or any pane before it, is
  /// below the receiver.
  test::Moments fluxByShooting(const LinkEnds& ends, std::uint64_t key) const {
    test::Moments m;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      Rng rng(key, i);
      const Senders::Choice chosen = senders->choose(ends.sender, rng.uniform());
      m.add(shoot(chosen.cell, ends, rng) / chosen.chance);
    }
    return m;
  }

  /// How many of some shots arrive.
  int hits(const LinkEnds& ends) const {
    int count = 0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      Rng rng(77, i);
      count += shoot(senders->choose(ends.sender, rng.uniform()).cell, ends, rng) > 0;
    }
    return count;
  }

 private:
  double shoot(std::uint32_t cell, const LinkEnds& ends, Rng& rng) const {
    const SenderCell& c = senders->cells()[cell];
    const Vec2 u{rng.uniform(), rng.uniform()}, v{rng.uniform(), rng.uniform()};
    const double phi = 2 * kPi * v.y;
    tracing::Ray ray;
    Vec3 w;
    double weight = 0;
    bool spot = false;
    if (c.kind == SenderKind::Sun || c.kind == SenderKind::Sky) {
      // A disc across the direction that holds the scene.
      w = -senders->direction(cell, u);
      const Box box = bounds(scene);
      const double radius = box.diagonal(), r = radius * std::sqrt(v.x);
      const Frame frame(w);
      const Vec3 from = box.center() + r * std::cos(phi) * frame.tangent + r * std::sin(phi) * frame.bitangent;
      ray.origin = Vec3f(from - 2 * radius * w);
      weight = c.measure * kPi * radius * radius * lights->radianceFrom(c.light, -w).g;
    } else if (c.kind == SenderKind::Point) {
      const double z = 2 * v.x - 1, r = std::sqrt(1 - z * z);
      w = {r * std::cos(phi), r * std::sin(phi), z};
      ray.origin = Vec3f(lights->position(c.light));
      weight = 4 * kPi * lights->intensity(c.light, w).g;
    } else {
      const SurfacePoint p = senders->point(cell, u);
      const double r = std::sqrt(v.x);
      w = Frame(p.normal).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - v.x)});
      ray.origin = tracing::offsetOrigin(Vec3f(p.position), Vec3f(p.normal), Vec3f(w));
      weight = c.measure;
      if (c.kind == SenderKind::Lamp) {
        spot = scene.materialOf(c.primitive).emission->spot.has_value();
        weight *= kPi * lights->emittedRadiance(c.light, w, 1e30, c.front).g;
      }
    }
    ray.direction = Vec3f(w);
    double sum = 0, distance = 0;
    const RadixNode& r = receivers->nodes()[ends.receiver];
    for (int pane = 0; pane < 16; ++pane) {
      const tracing::Hit hit = tracer->closestHit(ray);
      if (!hit) break;
      distance += hit.t;
      const std::uint32_t met = receivers->cellOf(hit);
      if (met >= r.begin && met < r.end) {
        double here = weight;
        if (spot) {
          const double focal = glm::length(scene.materialOf(c.primitive).emission->spot->direction);
          here *= std::pow(distance / (distance + focal), 2);
        }
        sum += here;
      }
      const auto* glass = std::get_if<ThinGlass>(&scene.materialOf(hit.primitive).surface);
      if (!glass) break;
      weight *= transmittance(*glass, std::abs(glm::dot(hit.normal, ray.direction))).g;
      ray.origin = tracing::offsetOrigin(hit.position, hit.normal, ray.direction);
    }
    return sum;
  }
};

/// Receivers of every shape around the origin: a mirror, a pane before it, a metal ball, a glass cylinder and cone, a
/// ring, a mesh; and a black board that hides some.
Scene receivers() {
  Scene scene;
  scene.objects.push_back({"scene", ObjectId()});
  const MaterialId mirror = test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)});
  const MaterialId pane = test::addMaterial(scene, "pane", ThinGlass{Rgb(0.9f), 1.52f});
  const MaterialId glass = test::addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f});
  Opaque shiny = test::lambert(0.0f);
  shiny.specular = {Rgb(0.5f), 0.1f, SpecularLobe::Distribution::Ward};
  const MaterialId metal = test::addMaterial(scene, "metal", shiny);
  const MaterialId black = test::addMaterial(scene, "black", Opaque{});
  test::addPolygon(scene, mirror, {{2, -1, 0}, {2, -1, 2}, {2, 1, 2}, {2, 1, 0}});
  test::addPolygon(scene, pane, {{1.5, -1, 0.5}, {1.5, -1, 1.5}, {1.5, 0.5, 1}});
  test::addShape(scene, metal, Sphere{{0, 1.5, 0.6}, 0.4});
  test::addShape(scene, glass, Cylinder{{-1.5, 0, 0.2}, {-1.5, 0.3, 1.4}, 0.25});
  test::addShape(scene, metal, Cone{{0, -1.5, 0.2}, {0, -1.6, 1.0}, 0.5, 0.1});
  test::addShape(scene, metal, Ring{{-0.8, 0.8, 1.2}, glm::normalize(Vec3(0.3, -0.4, -1)), 0.1, 0.4});
  test::addShape(scene, mirror,
                 *makeMesh({{1, 1, 0.1}, {1.5, 1.2, 0.1}, {1.2, 1.6, 0.6}, {0.8, 1.3, 1.0}}, {{0, 1, 2}, {0, 2, 3}}));
  test::addPolygon(scene, black, {{0.8, -0.4, 0.3}, {0.8, -0.4, 0.9}, {0.8, 0.2, 0.9}, {0.8, 0.2, 0.3}});
  return scene;
}

/// Ever smaller links below `e`, at random.
std::vector<LinkEnds> descent(const World& world, LinkEnds e, Rng& rng) {
  std::vector<LinkEnds> path;
  const auto& s = world.senders->nodes();
  const auto& r = world.receivers->nodes();
  const double receivers = rng.uniform();
  while (!s[e.sender].isLeaf() || !r[e.receiver].isLeaf()) {
    const bool receiver = s[e.sender].isLeaf() || (!r[e.receiver].isLeaf() && rng.uniform() < receivers);
    const int child = rng.uniform() < 0.5 ? 0 : 1;
    if (receiver)
      e.receiver = r[e.receiver].child[child];
    else
      e.sender = s[e.sender].child[child];
    path.push_back(e);
  }
  return path;
}

/// The root link of the only sender, and links to random nodes below.
void expectFluxes(Scene scene) {
  const World world(std::move(scene));
  const auto roots = world.senders->lightRoots().empty() ? world.senders->surfaceRoots() : world.senders->lightRoots();
  ASSERT_EQ(roots.size(), 1u);
  std::vector<LinkEnds> links{{roots[0], world.receivers->root()}};
  Rng rng(17);
  for (int i = 0; i < 16; ++i) {
    // Down to where blind shooting still finds the receiver often enough to tell.
    LinkEnds e{roots[0], world.receivers->root()};
    for (const LinkEnds next : descent(world, e, rng)) {
      if (world.hits(next) < 100) break;
      e = next;
    }
    links.push_back(e);
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    const test::Moments mine = world.flux(links[i], 1000 + i), shot = world.fluxByShooting(links[i], 2000 + i);
    const double error = std::hypot(mine.standardError(), shot.standardError());
    EXPECT_FALSE(world.emission->averted(links[i]));
    ASSERT_GT(error, 0.0);
    const double z = (mine.mean() - shot.mean()) / error;
    EXPECT_GT(test::studentTwoSidedTail(z, 2.0 * kSamples), kSignificance)
        << "link " << i << " (" << links[i].sender << ", " << links[i].receiver << "): " << mine.mean() << " against "
        << shot.mean() << " +- " << error;
    // Sampling is not only right but better than shooting blindly.
    EXPECT_LT(mine.standardError(), 1.5 * shot.standardError() + 1e-12) << "link " << i;
  }
}

TEST(ParticleEmission, SidesOfSurfaces) {
  Scene scene = receivers();
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.5f));
  test::addPolygon(scene, white, {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  test::addShape(scene, white, Sphere{{0.3, 0.3, 0.5}, 0.2});
  expectFluxes(std::move(scene));
}

void expectLampFluxes(Shape shape, Emission emission) {
  Scene scene = receivers();
  const MaterialId lamp = test::addMaterial(scene, "lamp", Opaque{}, std::move(emission));
  test::addShape(scene, lamp, std::move(shape));
  addAreaLights(scene);
  expectFluxes(std::move(scene));
}
TEST(ParticleEmission, FlatLamp) {
  expectLampFluxes(*makePolygon({{0, 0, 1}, {0.5, 0, 1}, {0.5, 0.7, 1}}), {Rgb(3.0f), false, {}});
}
TEST(ParticleEmission, LampWithTwoSides) {
  expectLampFluxes(Ring{{0, 0, 1}, {1, 0, 0}, 0.1, 0.5}, {Rgb(2.0f), true, {}});
}
TEST(ParticleEmission, Ball) { expectLampFluxes(Sphere{{0.2, 0.1, 0.8}, 0.15}, {Rgb(2.0f), false, {}}); }
TEST(ParticleEmission, Spotlight) {
  expectLampFluxes(Ring{{0, 0, 1}, glm::normalize(Vec3(1, 0.1, -0.2)), 0, 0.2},
                   {Rgb(2.0f), false, SpotCone{1.0, 0.5 * glm::normalize(Vec3(1, 0.1, -0.2))}});
}

/// Twice as bright at +x as at -x.
std::shared_ptr<const DirectionTable> lopsided() {
  DirectionTable table{19, 36, {}};
  for (int row = 0; row < 19; ++row)
    for (int column = 0; column < 36; ++column)
      table.values.push_back(static_cast<float>(3 + std::sin(row * kPi / 18) * std::cos(column * kPi / 18)));
  return std::make_shared<const DirectionTable>(std::move(table));
}
TEST(ParticleEmission, LampWithAPattern) {
  const Vec3 normal = glm::normalize(Vec3(1, 0.1, -0.2));
  for (const std::optional<Vec3>& ofIntensity : {std::optional<Vec3>(), std::optional(normal)})
    expectLampFluxes(Ring{{0, 0, 1}, normal, 0, 0.2},
                     {Rgb(2.0f), false, {}, EmissionPattern{lopsided(), glm::dmat3(1.0), 0.3, ofIntensity}});
}

void expectPointFluxes(decltype(Light::emitter) emitter) {
  Scene scene = receivers();
  test::addLight(scene, std::move(emitter));
  expectFluxes(std::move(scene));
}
TEST(ParticleEmission, Point) { expectPointFluxes(PointLight{{0.1, 0.2, 0.7}, Rgb(2.0f)}); }
TEST(ParticleEmission, PointSpot) {
  expectPointFluxes(SpotLight{{0.1, 0.2, 0.7}, glm::normalize(Vec3(1, 0.3, 0)), Rgb(2.0f), 0.9, 0.6});
}
TEST(ParticleEmission, LambertPoint) {
  expectPointFluxes(LambertPointLight{{0.1, 0.2, 0.7}, glm::normalize(Vec3(1, 0.3, 0)), Rgb(2.0f)});
}
TEST(ParticleEmission, Photometric) {
  auto photometry = std::make_shared<Photometry>();
  photometry->horizontals = {0, 90, 180, 270, 360};
  photometry->verticals = {0, 30, 60, 90, 120, 180};
  for (int h = 0; h < 5; ++h)
    for (int v = 0; v < 6; ++v) photometry->candela.push_back(100 + 40 * (h % 4) + 300 * (v == 2) + 25 * v);
  PhotometricLight light;
  light.position = {0.1, 0.2, 0.7};
  light.photometry = photometry;
  expectPointFluxes(light);
}
TEST(ParticleEmission, Sun) { expectPointFluxes(SunLight{glm::normalize(Vec3(-0.6, 0.2, 0.5)), 0.02, Rgb(1000.0f)}); }
TEST(ParticleEmission, Sky) {
  DomeLight dome;
  dome.distribution = CieSky{12, 2.0, 0.3, glm::normalize(Vec3(-0.6, 0.2, 0.5))};
  expectPointFluxes(dome);
}

/// Counts of what `draw` yields against the chances that it says.
template <class Draw>
void expectChances(std::size_t cells, std::uint32_t first, const Draw& draw) {
  std::vector<double> observed(cells, 0.0), expected(cells, 0.0);
  constexpr int samples = 100000;
  Rng rng(5, 2);
  for (int i = 0; i < samples; ++i) {
    const Senders::Choice c = draw(rng.uniform());
    observed[c.cell - first] += 1;
    expected[c.cell - first] = c.chance * samples;
  }
  const auto result = test::chiSquare(observed, expected);
  EXPECT_GT(result.pValue, kSignificance) << result.message;
}

TEST(ParticleEmission, CellsAreDrawnByTheirChance) {
  DomeLight dome;
  dome.distribution = CieSky{12, 2.0, 0.3, glm::normalize(Vec3(-0.6, 0.2, 0.5))};
  Scene scene = receivers();
  test::addBox(scene, test::addMaterial(scene, "room", test::lambert(0.5f)), {-2, -2, -2}, {2, 2, 2}, true);
  test::addLight(scene, dome);
  const World world(std::move(scene));
  const Senders& s = *world.senders;
  for (const auto& roots : {s.lightRoots(), s.surfaceRoots()}) {
    for (const std::uint32_t root : roots) {
      const RadixNode& node = s.nodes()[root];
      expectChances(node.end - node.begin, node.begin, [&](double u) { return s.choose(root, u); });
    }
  }
  const std::uint32_t root = s.surfaceRoots().front();
  const RadixNode& node = s.nodes()[root];
  expectChances(node.end - node.begin, node.begin, [&](double u) {
    return s.chooseNear(root, {Vec3(0.5, 0.5, -1.5), 0.4}, u);
  });
}

/// Directions of a sky's cells and of the sun's disc, uniform in solid angle; points of lamps, uniform by area.
TEST(ParticleEmission, PointsAndDirectionsAreUniform) {
  Scene scene = receivers();
  test::addLight(scene, SunLight{glm::normalize(Vec3(-0.6, 0.2, 0.5)), 0.3, Rgb(1.0f)});
  const MaterialId lamp = test::addMaterial(scene, "lamp", Opaque{}, Emission{Rgb(20.0f), false, {}});
  test::addShape(scene, lamp, Sphere{{0, 0, 3}, 0.5});
  addAreaLights(scene);
  const World world(std::move(scene));
  const Senders& s = *world.senders;
  constexpr int grid = 8, samples = 40000;
  for (std::uint32_t cell = 0; cell < s.surfaceCells(); ++cell) {
    const SenderCell& c = s.cells()[cell];
    if (c.kind != SenderKind::Sun && c.kind != SenderKind::Lamp) continue;
    const Vec3 axis = c.kind == SenderKind::Sun ? s.direction(cell, {0, 0}) : Vec3(0, 0, 1);
    const Frame frame(axis);
    std::vector<double> observed(grid * grid, 0.0), expected(grid * grid, double(samples) / (grid * grid));
    Rng rng(9, cell);
    for (int i = 0; i < samples; ++i) {
      const double u0 = rng.uniform();
      const Vec2 u{u0, rng.uniform()};
      // Azimuth, and the height that caps and balls are even in.
      const Vec3 d = c.kind == SenderKind::Sun ? s.direction(cell, u) : s.point(cell, u).normal;
      double share = (1 - glm::dot(d, axis)) / (c.kind == SenderKind::Sun ? 1 - std::cos(0.3) : 2.0);
      if (c.kind == SenderKind::Lamp) share = (1 - share - c.rect.v0) / (c.rect.v1 - c.rect.v0);
      double turn = std::atan2(glm::dot(d, frame.bitangent), glm::dot(d, frame.tangent)) / (2 * kPi);
      if (c.kind == SenderKind::Lamp) turn = (std::atan2(d.y, d.x) / (2 * kPi) - c.rect.u0) / (c.rect.u1 - c.rect.u0);
      const auto bin = [](double x) { return std::clamp(static_cast<int>(std::floor(grid * x)), 0, grid - 1); };
      observed[grid * bin(share) + bin(turn - std::floor(turn))] += 1;
    }
    const auto result = test::chiSquare(observed, expected);
    EXPECT_GT(result.pValue, kSignificance) << result.message << " cell " << cell;
  }
}

}  // namespace
}  // namespace deltalux
