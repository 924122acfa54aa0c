#include "gl/renderer.hpp"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <deltalux/scene.hpp>

#include "false_colour.hpp"
#include "viewer/support/gl_context.hpp"

namespace deltalux::viewer {
namespace {

constexpr int kWidth = 64, kHeight = 48;

/// A scene and its mesh, built by hand: squares that look along +z.
struct Builder {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  SolutionMesh mesh;

  PrimitiveId add(const Material& material, double z, double half, Vec2 middle = Vec2(0)) {
    const PrimitiveId p(scene->primitives.size());
    scene->materials.push_back(material);
    std::vector<Vec3> corners;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      corners.emplace_back(middle.x + x * half, middle.y + y * half, z);
    scene->primitives.push_back({*makePolygon(corners), MaterialId(scene->materials.size() - 1), ObjectId()});
    mesh.surfaces.resize(2 * scene->primitives.size());
    mesh.caustics.resize(2 * scene->primitives.size());
    return p;
  }

  /// One side of it: irradiance at the left and right edges. `version`: of the snapshot that it is new in.
  void light(PrimitiveId p, bool front, Rgb left, Rgb right, std::uint64_t version = 1) {
    auto s = std::make_shared<SurfaceMesh>();
    s->primitive = p, s->front = front;
    s->shapeVersion = 1, s->lightVersion = version;
    s->albedo = diffuseReflectance(scene->materialOf(p), front);
    s->transmittance = diffuseTransmittance(scene->materialOf(p));
    if (scene->materialOf(p).emission) s->radiance = scene->materialOf(p).emission->radiance;
    const Box box = bounds((*scene)[p].shape);
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      MeshVertex v;
      v.position = Vec3f(x ? box.upper.x : box.lower.x, y ? box.upper.y : box.lower.y, box.lower.z);
      v.normal = Vec3f(0, 0, front ? 1 : -1);
      v.uv = {x, 1 - y};
      v.direct = x ? right : left;
      s->vertices.push_back(v);
    }
    s->triangles = front ? std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2};
    s->outlines = {0, 1, 1, 2, 2, 3, 3, 0};
    mesh.surfaces[SolutionMesh::side(p, front)] = s;
    mesh.version = std::max(mesh.version, version);
  }

  std::shared_ptr<const SolutionMesh> snapshot() {
    mesh.scene = std::make_shared<Scene>(*scene);
    return std::make_shared<SolutionMesh>(mesh);
  }
};

Material matt(Rgb rho) {
  Material m;
  m.surface = Opaque{rho, TextureId(), {}};
  return m;
}

/// Four units in front of the origin; the plane z = 0 is seen from -2 to 2, and from -1.5 to 1.5.
Frame frameOf(std::shared_ptr<const SolutionMesh> mesh) {
  Frame f;
  f.camera.position = Vec3(0, 0, 4), f.camera.direction = Vec3(0, 0, -1), f.camera.up = Vec3(0, 1, 0);
  f.camera.horizontal = 2 * glm::degrees(std::atan(0.5)), f.camera.vertical = 2 * glm::degrees(std::atan(0.375));
  f.width = kWidth, f.height = kHeight;
  f.mesh = std::move(mesh);
  return f;
}

void expectNear(const Rgb& is, const Rgb& shall, double tolerance = 2e-6) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(is[c], shall[c], tolerance * (1 + std::abs(shall[c])));
}

std::shared_ptr<const SurfaceCausticMesh> causticOf(PrimitiveId p, bool front, CausticMesh texture,
                                                    std::uint64_t version = 1) {
  auto c = std::make_shared<SurfaceCausticMesh>();
  c->primitive = p, c->front = front, c->version = version;
  c->textures.push_back(std::move(texture));
  return c;
}

/// Over the square from -1 to 1 at z = 0; rows from the upper edge.
CausticMesh squareTexture(int size, const std::function<glm::vec4(int, int)>& texel) {
  CausticMesh c;
  c.width = c.height = size;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) c.texels.push_back(texel(x, y));
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    c.vertices.push_back({Vec3f(x, y, 0), {(x + 1) / 2, (1 - y) / 2}});
  c.triangles = {0, 1, 2, 0, 2, 3};
  return c;
}

class RendererTest : public testing::Test {
 protected:
  void SetUp() override {
    context_ = GlContext::make(kWidth, kHeight);
    if (!context_) GTEST_SKIP() << "no OpenGL 3.3 without a display here";
    renderer = std::make_unique<gl::Renderer>();
  }
  void TearDown() override { renderer.reset(); }

  std::unique_ptr<GlContext> context_;

 public:
  std::unique_ptr<gl::Renderer> renderer;
};

TEST_F(RendererTest, ShowsReflectedLightAsTheLibrarysToneMapping) {
  Builder b;
  const PrimitiveId p = b.add(matt({0.5f, 0.25f, 0.75f}), 0, 3);
  b.light(p, true, {0, 0, 0}, {60, 30, 12});
  Frame f = frameOf(b.snapshot());
  for (const ToneOperator op : {ToneOperator::Reinhard, ToneOperator::Linear}) {
    f.settings.tone = {op, -0.7};
    renderer->draw(f, nullptr);
    const Image L = renderer->radiance();
    for (const int x : {0, 20, 63}) {
      const float share = (3 + (static_cast<float>(x) + 0.5f - 32) / 16) / 6;
      expectNear(L.at(x, 7), Rgb(0.5f, 0.25f, 0.75f) * Rgb(60, 30, 12) * share / static_cast<float>(kPi), 1e-5);
    }
    const DisplayImage shown = renderer->screenshot(), shall = toneMap(L, f.settings.tone);
    for (std::size_t i = 0; i < shown.pixels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(shown.pixels[i][c], shall.pixels[i][c], 1) << i;
  }
}

TEST_F(RendererTest, ShowsThePictureTheRightWayUpInTheFramebufferThatIsBound) {
  Builder b;
  Material lamp;
  lamp.emission = Emission{.radiance = Rgb(100), .spot = std::nullopt};
  const PrimitiveId p = b.add(lamp, 0, 0.5, {-1, 1});
  b.light(p, true, Rgb(0), Rgb(0));
  renderer->draw(frameOf(b.snapshot()), nullptr);
  const std::uint32_t seen = p.value + 1;
  EXPECT_EQ(renderer->surfaces()[8 * kWidth + 16], seen);  // up and to the left, rows from the top
  EXPECT_EQ(renderer->surfaces()[40 * kWidth + 16], 0u);
  EXPECT_EQ(renderer->screenshot().at(16, 8)[0], 255);
  std::array<std::uint8_t, 4> texel{};
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(16, kHeight - 1 - 8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel.data());
  EXPECT_EQ(texel[0], 255);
  glReadPixels(16, 8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel.data());
  EXPECT_EQ(texel[0], 0);
}

TEST_F(RendererTest, ShowsEachSideItsOwnLight) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  b.light(p, false, Rgb(6), Rgb(6));
  Frame f = frameOf(b.snapshot());
  renderer->draw(f, nullptr);
  expectNear(renderer->radiance().at(30, 20), Rgb(1 / static_cast<float>(kPi)));
  f.camera.position.z = -4, f.camera.direction.z = 1;
  renderer->draw(f, nullptr);
  expectNear(renderer->radiance().at(30, 20), Rgb(3 / static_cast<float>(kPi)));
}

TEST_F(RendererTest, AddsWhatPassesDiffuselyFromTheOtherSide) {
  Builder b;
  Material paper;
  paper.surface = Trans{Rgb(0.5f), Rgb(0.25f), {}, {}};
  const PrimitiveId p = b.add(paper, 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  b.light(p, false, Rgb(8), Rgb(8));
  b.mesh.caustics[SolutionMesh::side(p, false)] =
      causticOf(p, false, squareTexture(8, [](int, int) { return glm::vec4(4, 4, 4, 1); }));
  b.mesh.caustics[SolutionMesh::side(p, false)] = [&] {
    SurfaceCausticMesh c = *b.mesh.caustics[SolutionMesh::side(p, false)];
    c.textures[0].triangles = {0, 2, 1, 0, 3, 2};  // seen from the back
    return std::make_shared<SurfaceCausticMesh>(c);
  }();
  renderer->draw(frameOf(b.snapshot()), nullptr);
  const float pi = static_cast<float>(kPi);
  expectNear(renderer->radiance().at(2, 2), Rgb((0.5f * 2 + 0.25f * 8) / pi));
  expectNear(renderer->radiance().at(32, 24), Rgb((0.5f * 2 + 0.25f * 12) / pi));
}

TEST_F(RendererTest, AddsCausticTexturesWhereTheyShow) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  b.mesh.caustics[SolutionMesh::side(p, true)] =
      causticOf(p, true, squareTexture(8, [](int x, int) { return glm::vec4(Rgb(static_cast<float>(x)), x < 6); }));
  renderer->draw(frameOf(b.snapshot()), nullptr);
  const Image L = renderer->radiance();
  // A texel is four pixels; the square begins at pixel (16, 8).
  const float factor = 0.5f / static_cast<float>(kPi);
  expectNear(L.at(10, 24), factor * Rgb(2));  // beside it
  for (int x = 2; x < 24; ++x) {              // off its left edge, before its mask
    const float texel = (static_cast<float>(x) + 0.5f) / 4 - 0.5f;
    expectNear(L.at(16 + x, 24), factor * Rgb(2 + texel), 1e-5);
  }
  for (int x = 24; x < 32; ++x) expectNear(L.at(16 + x, 24), factor * Rgb(2));
}

TEST_F(RendererTest, MultipliesByTheTextureOfTheMaterial) {
  Builder b;
  b.scene->textures.push_back({"stripes", 2, 1, {Rgb(0.2f), Rgb(0.8f)}});
  Material m = matt(Rgb(0.5f));
  std::get<Opaque>(m.surface).diffuseTexture = TextureId(0);
  const PrimitiveId p = b.add(m, 0, 2);
  Mesh shape;
  shape.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  shape.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  shape.triangles = {{0, 1, 2}, {0, 2, 3}};
  shape.cumulativeArea = {8, 16};
  b.scene->primitives[p.index()].shape = shape;
  b.light(p, true, Rgb(2), Rgb(2));
  b.mesh.caustics[SolutionMesh::side(p, true)] =
      causticOf(p, true, squareTexture(4, [](int, int) { return glm::vec4(6, 6, 6, 1); }));
  renderer->draw(frameOf(b.snapshot()), nullptr);
  const Image L = renderer->radiance();
  const auto at = [&](int x) { return L.at(x, x == 30 ? 24 : 4); };  // within the caustic texture, or above it
  const auto factorAt = [](int x) { return 0.5f * (x == 30 ? 8 : 2) / static_cast<float>(kPi); };
  for (const int x : {3, 16, 30, 47, 60}) {
    const Rgb tint = b.scene->textures[0].sample({(x + 0.5) / 64, 0.5});
    expectNear(at(x), factorAt(x) * tint, 4e-3);  // weights of 8 bits
  }
}

TEST_F(RendererTest, UploadsWhatHasChangedAndNothingElse) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 3), q = b.add(matt(Rgb(0.5f)), 1, 0.25);
  b.light(p, true, Rgb(2), Rgb(2));
  b.light(q, true, Rgb(4), Rgb(4));
  b.mesh.caustics[SolutionMesh::side(p, true)] =
      causticOf(p, true, squareTexture(4, [](int, int) { return glm::vec4(1); }));
  Frame f = frameOf(b.snapshot());
  EXPECT_GT(renderer->draw(f, nullptr).uploadedBytes, 0u);
  EXPECT_EQ(renderer->draw(f, nullptr).uploadedBytes, 0u);
  f.camera.position.x = 0.3;
  f.settings.tone.ev = 2;
  EXPECT_EQ(renderer->draw(f, nullptr).uploadedBytes, 0u);
  b.light(q, true, Rgb(8), Rgb(8), 2);
  f.mesh = b.snapshot();
  EXPECT_EQ(renderer->draw(f, nullptr).uploadedBytes, 4 * sizeof(Rgb));
  expectNear(renderer->radiance().at(30, 24), Rgb(4 / static_cast<float>(kPi)));
  b.mesh.caustics[SolutionMesh::side(p, true)] =
      causticOf(p, true, squareTexture(4, [](int, int) { return glm::vec4(2, 2, 2, 1); }), 3);
  f.mesh = b.snapshot();
  EXPECT_EQ(renderer->draw(f, nullptr).uploadedBytes, 16 * 16 + 4 * 32 + 6 * 4u);
  b.mesh.surfaces[SolutionMesh::side(q, true)] = nullptr;
  f.mesh = b.snapshot();
  renderer->draw(f, nullptr);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 30], p.value + 1);
}

TEST_F(RendererTest, TakesAShapeThatGrowsBeyondTheRoomOfItsBuffers) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  Frame f = frameOf(b.snapshot());
  renderer->draw(f, nullptr);
  SurfaceMesh fine = *b.mesh.surfaces[SolutionMesh::side(p, true)];
  constexpr std::uint32_t n = 60;
  fine.vertices.clear(), fine.triangles.clear();
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      MeshVertex v;
      v.position = Vec3f(-3 + 6.0f * static_cast<float>(x) / n, -3 + 6.0f * static_cast<float>(y) / n, 0);
      v.normal = Vec3f(0, 0, 1);
      v.indirect = Rgb(6);
      fine.vertices.push_back(v);
      const std::uint32_t a = y * (n + 1) + x, c = a + n + 1;
      if (x < n && y < n) fine.triangles.insert(fine.triangles.end(), {a, a + 1, c + 1, a, c + 1, c});
    }
  fine.shapeVersion = fine.lightVersion = b.mesh.version = 2;
  b.mesh.surfaces[SolutionMesh::side(p, true)] = std::make_shared<SurfaceMesh>(fine);
  f.mesh = b.snapshot();
  const DrawReport report = renderer->draw(f, nullptr);
  EXPECT_EQ(report.triangles, 2 * n * n);
  const Image L = renderer->radiance();
  for (const Rgb& pixel : L.pixels) expectNear(pixel, Rgb(3 / static_cast<float>(kPi)));  // no cracks
}

TEST_F(RendererTest, DrawsWhatTheHandHasMovedAheadOfItsLight) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 0.5), q = b.add(matt(Rgb(0.25f)), -1, 4);
  b.light(p, true, Rgb(2), Rgb(2));
  b.light(q, true, Rgb(1), Rgb(1));
  Frame f = frameOf(b.snapshot());
  renderer->draw(f, nullptr);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 32], p.value + 1);
  glm::mat4 right(1.0f);
  right[3] = glm::vec4(1, 0, 0, 1);
  f.ahead = Ahead{{p}, right};
  renderer->draw(f, nullptr);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 30], q.value + 1);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 48], p.value + 1);
  expectNear(renderer->radiance().at(48, 24), Rgb(1 / static_cast<float>(kPi)));
}

TEST_F(RendererTest, LooksThroughGlassAndTellsThePane) {
  Builder b;
  Material glass;
  glass.surface = ThinGlass{{0.9f, 0.5f, 0.1f}, 1.52f};
  const PrimitiveId wall = b.add(matt(Rgb(0.5f)), 0, 6), pane = b.add(glass, 1, 0.5);
  b.light(wall, true, Rgb(2), Rgb(2));
  b.light(pane, true, Rgb(0), Rgb(0));
  Frame f = frameOf(b.snapshot());
  renderer->draw(f, nullptr);
  expectNear(renderer->radiance().at(32, 24), straightTransmittance(glass, 1) / static_cast<float>(kPi), 1e-4);
  expectNear(renderer->radiance().at(4, 24), Rgb(1 / static_cast<float>(kPi)));
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 32], pane.value + 1);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 4], wall.value + 1);
  EXPECT_EQ(renderer->specularPixels()[24 * kWidth + 32], 1);
  EXPECT_EQ(renderer->specularPixels()[24 * kWidth + 4], 0);
}

TEST_F(RendererTest, ShowsWhatTheRenderCacheKnowsOfMirrorsAndOfNothingElse) {
  Builder b;
  Material mirror;
  mirror.surface = Mirror{Rgb(0.9f)};
  const PrimitiveId m = b.add(mirror, 0, 1), wall = b.add(matt(Rgb(0.5f)), -1, 6);
  b.light(m, true, Rgb(0), Rgb(0));
  b.light(wall, true, Rgb(2), Rgb(2));
  Frame f = frameOf(b.snapshot());
  // What a ray through a pixel has found.
  const auto sampleAt = [&](int x, int y, PrimitiveId p, double z) {
    const ViewRay ray = viewRay(f.camera, (x + 0.5) / kWidth, (y + 0.5) / kHeight);
    PixelSample s;
    s.radiance = Rgb(7, 5, 3);
    s.position = s.apparent = Vec3f(ray.origin + (z - ray.origin.z) / ray.direction.z * ray.direction);
    s.primitive = p, s.version = 1, s.eye = Vec3f(ray.origin);
    return s;
  };
  RenderCache cache;
  renderer->draw(f, &cache);  // it has room for so many samples as its frames have pixels
  std::vector<PixelSample> samples;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool onMirror = x >= 16 && x < 48 && y >= 8 && y < 40;
      samples.push_back(sampleAt(x, y, onMirror ? m : wall, onMirror ? 0 : -1));
    }
  cache.insert(samples);
  const DrawReport report = renderer->draw(f, &cache);
  EXPECT_EQ(report.cacheWanted, 32 * 32u);
  EXPECT_GT(report.cacheHeld, 0u);
  expectNear(renderer->radiance().at(32, 24), Rgb(7, 5, 3));
  expectNear(renderer->radiance().at(4, 24), Rgb(1 / static_cast<float>(kPi)));
  f.settings.cache = false;
  renderer->draw(f, &cache);
  expectNear(renderer->radiance().at(32, 24), Rgb(0));
}

TEST_F(RendererTest, ShowsThePictureOfTheSameViewByItsRays) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  Frame f = frameOf(b.snapshot());
  auto picture = std::make_shared<Picture>();
  picture->view = f.camera, picture->version = f.mesh->version;
  picture->image.width = kWidth, picture->image.height = kHeight;
  picture->image.pixels.assign(kWidth * kHeight, Rgb(5));
  picture->rays.assign(kWidth * kHeight, 0);
  picture->rays[1] = 1, picture->rays[2] = 4;
  f.picture = picture;
  renderer->draw(f, nullptr);
  const float L = 1 / static_cast<float>(kPi);
  expectNear(renderer->radiance().at(0, 0), Rgb(L));
  expectNear(renderer->radiance().at(1, 0), Rgb(0.5f * (L + 5)));
  expectNear(renderer->radiance().at(2, 0), Rgb(5));
  f.camera.position.x += 1e-6;
  renderer->draw(f, nullptr);
  expectNear(renderer->radiance().at(2, 0), Rgb(L));
}

TEST_F(RendererTest, ShowsTheRampsColourOfAnIlluminance) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 1);
  b.light(p, true, Rgb(2), Rgb(2));
  b.mesh.caustics[SolutionMesh::side(p, true)] =
      causticOf(p, true, squareTexture(4, [](int, int) { return glm::vec4(1); }));
  Frame f = frameOf(b.snapshot());
  const auto expectColour = [&](const glm::vec3& shall, double tolerance) {
    const auto is = renderer->screenshot().at(32, 24);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(is[static_cast<std::size_t>(c)], 255 * shall[c], tolerance);
  };
  FalseColour& s = f.settings.falseColour;
  s.quantity = Quantity::Illuminance;
  for (const bool logarithmic : {false, true}) {
    s.logarithmic = logarithmic;
    renderer->draw(f, nullptr);
    expectColour(falseColourRamp(s, 3 * kLuminousEfficacy), 1);
  }
  EXPECT_EQ(renderer->screenshot().at(2, 2)[0], 96);  // no surface
  s.useBands = true;
  renderer->draw(f, nullptr);
  expectColour(falseColourRamp(s, 501), 0.51);
  s.useBands = false, s.quantity = Quantity::Luminance;
  renderer->draw(f, nullptr);
  expectColour(falseColourRamp(s, 0.5 * 3 * kLuminousEfficacy / kPi), 1);
}

TEST_F(RendererTest, RunsIsolinesAlongLevels) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 2);
  b.light(p, true, Rgb(0), Rgb(4));
  Frame f = frameOf(b.snapshot());
  FalseColour& s = f.settings.falseColour;
  s.quantity = Quantity::Illuminance;
  s.useBands = true, s.bands = {2 * kLuminousEfficacy}, s.isolines = true;
  renderer->draw(f, nullptr);
  const DisplayImage shown = renderer->screenshot();
  for (int x = 0; x < kWidth - 1; ++x) {
    const auto colour = shown.at(x, 20);
    const bool extreme =
        colour == std::array<std::uint8_t, 3>{0, 0, 0} || colour == std::array<std::uint8_t, 3>{255, 255, 255};
    EXPECT_EQ(extreme, x == 31) << x;
  }
}

TEST_F(RendererTest, ShowsTheOtherSnapshotBesideTheWipe) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  Frame f = frameOf(b.snapshot());
  b.light(p, true, Rgb(6), Rgb(6), 2);
  f.other = b.snapshot();
  f.wipe = 0.25;
  renderer->draw(f, nullptr);
  const Image L = renderer->radiance();
  expectNear(L.at(15, 24), Rgb(1 / static_cast<float>(kPi)));
  expectNear(L.at(16, 24), Rgb(3 / static_cast<float>(kPi)));
}

TEST_F(RendererTest, ShowsSkyAndSunWhereNoSurfaceIs) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 0.1);
  b.light(p, true, Rgb(2), Rgb(2));
  DomeLight dome;
  dome.halfAngle = kPi, dome.scale = Rgb(1, 2, 3), dome.distribution = UniformSky{0.5};
  b.scene->lights.push_back({"sky", dome, Rgb(2)});
  b.scene->lights.push_back({"sun", SunLight{glm::normalize(Vec3(0.25, 0, -1)), 0.02, Rgb(1000)}, Rgb(1)});
  renderer->draw(frameOf(b.snapshot()), nullptr);
  const Image L = renderer->radiance();
  expectNear(L.at(5, 5), Rgb(1, 2, 3));
  expectNear(L.at(48, 24), Rgb(1001, 1002, 1003));
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 48], 0u);
}

TEST_F(RendererTest, CutsAtTheSection) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 1, 3), q = b.add(matt(Rgb(0.5f)), 0, 3);
  b.light(p, true, Rgb(2), Rgb(2));
  b.light(q, true, Rgb(6), Rgb(6));
  Frame f = frameOf(b.snapshot());
  f.settings.section = Box{{-9, -9, -1}, {0, 9, 9}};
  renderer->draw(f, nullptr);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 20], p.value + 1);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 44], 0u);
  f.settings.section = Box{{-9, -9, -1}, {9, 9, 0.5}};
  renderer->draw(f, nullptr);
  EXPECT_EQ(renderer->surfaces()[24 * kWidth + 44], q.value + 1);
}

TEST_F(RendererTest, OutlinesTheSelectionAndDrawsLines) {
  Builder b;
  const PrimitiveId p = b.add(matt(Rgb(0.5f)), 0, 0.5);
  b.light(p, true, Rgb(0), Rgb(0));
  Frame f = frameOf(b.snapshot());
  renderer->draw(f, nullptr);
  const DisplayImage without = renderer->screenshot();
  f.selection = {p};
  f.lines.push_back({Vec3f(-2, 1.0f, 1), Vec3f(2, 1.0f, 1), glm::vec4(0, 1, 0, 1), true});
  f.lines.push_back({Vec3f(-2, 0, -1), Vec3f(2, 0, -1), glm::vec4(0, 0, 1, 1), false});
  renderer->draw(f, nullptr);
  const DisplayImage with = renderer->screenshot();
  // The square covers pixels 24 to 39 across and 16 to 31 down.
  for (const int x : {22, 23, 40, 41}) EXPECT_NE(with.at(x, 20), without.at(x, 20)) << x;
  for (const int x : {20, 24, 32, 39, 43}) EXPECT_EQ(with.at(x, 20), without.at(x, 20)) << x;
  int green = 0;
  bool blueBeside = false, blueOver = false;
  for (int y = 0; y < kHeight; ++y) {
    green += with.at(10, y)[1] == 255 && with.at(10, y)[0] == 0;
    blueBeside = blueBeside || with.at(12, y)[2] == 255;
    blueOver = blueOver || with.at(32, y)[2] == 255;
  }
  EXPECT_EQ(green, 1);
  EXPECT_TRUE(blueBeside);
  EXPECT_FALSE(blueOver);
}

TEST(FalseColourTest, PutsValuesOnTheScale) {
  FalseColour f;
  f.top = 1000, f.decades = 2, f.logarithmic = true;
  EXPECT_DOUBLE_EQ(scalePosition(f, 1000), 1);
  EXPECT_NEAR(scalePosition(f, 100), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(scalePosition(f, 1), 0);
  EXPECT_EQ(scaleLevels(f), (std::vector<double>{10, 20, 50, 100, 200, 500, 1000}));
  f.logarithmic = false;
  EXPECT_DOUBLE_EQ(scalePosition(f, 250), 0.25);
  f.useBands = true, f.bands = {500, 300};
  EXPECT_DOUBLE_EQ(scalePosition(f, 299), 0);
  EXPECT_DOUBLE_EQ(scalePosition(f, 300), 0.5);
  EXPECT_DOUBLE_EQ(scalePosition(f, 500), 1);
  EXPECT_EQ(scaleLevels(f), (std::vector<double>{300, 500}));
}

TEST(FalseColourTest, HasTheColoursOfTheLibrarysPictures) {
  Image E;
  E.width = 1, E.height = 300;
  for (int y = 0; y < E.height; ++y) E.pixels.push_back(Rgb(static_cast<float>(std::pow(10.0, -0.01 * y))));
  const double top = kLuminousEfficacy;
  const DisplayImage library = falseColor(E, {.top = top, .decades = 3});
  FalseColour f;
  f.top = top, f.decades = 3;
  for (int y = 0; y < E.height; ++y) {
    const glm::vec3 c = falseColourRamp(f, photometric(glm::dvec3(E.at(0, y)), kLuminousEfficacy));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(library.at(library.width - 1, y)[static_cast<std::size_t>(k)], 255 * c[k], 0.51);
  }
}

}  // namespace
}  // namespace deltalux::viewer
