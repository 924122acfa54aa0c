// Materials, textures, lights of glTF.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>

#include "io/gltf.hpp"
#include "io/gltf_builder.hpp"

namespace deltalux {
using namespace io;

namespace {

using nlohmann::json;
using test::GltfBuilder;

ImportedScene read(const GltfBuilder& builder, const ImportSettings& settings = {}) {
  ImportedScene imported = readGltf(builder.glb(), "scene.glb", "/nonexistent", settings);
  validate(imported.scene);
  return imported;
}

Material materialOf(const json& material, const ImportSettings& settings = {}) {
  GltfBuilder g;
  g.node({{"mesh", g.quad(g.material(material))}});
  return read(g, settings).scene.materials.at(0);
}

json pbr(const json& value) { return {{"pbrMetallicRoughness", value}}; }

void expectNear(const Rgb& a, const Rgb& b, float tolerance = 1e-6f) {
  EXPECT_LT(maxChannel(glm::abs(a - b)), tolerance) << a.r << " " << a.g << " " << a.b;
}

TEST(GltfMaterial, PlasticSplitsIntoDiffuseAndLobe) {
  const Material m =
      materialOf(pbr({{"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}));
  const auto& s = std::get<Opaque>(m.surface);
  expectNear(s.diffuse, 0.96f * Rgb(0.8f, 0.4f, 0.2f));
  expectNear(s.specular.reflectance, Rgb(0.04f));
  EXPECT_EQ(s.specular.distribution, SpecularLobe::Distribution::Ggx);
  EXPECT_FLOAT_EQ(s.specular.roughness, 0.25f);
  EXPECT_FALSE(m.emission);
}

TEST(GltfMaterial, MetalIsAllLobeAndSmoothMetalAMirror) {
  const auto s =
      std::get<Opaque>(materialOf(pbr({{"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"roughnessFactor", 0.01}})).surface);
  expectNear(s.diffuse, Rgb(0));
  expectNear(s.specular.reflectance, Rgb(0.9f, 0.6f, 0.3f));
  EXPECT_EQ(s.specular.roughness, 0);
}

TEST(GltfMaterial, IorAndSpecularSetTheLobe) {
  json m = pbr({{"metallicFactor", 0}});
  m["extensions"]["KHR_materials_ior"]["ior"] = 2.0;
  m["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 20}}};
  const auto s = std::get<Opaque>(materialOf(m).surface);
  expectNear(s.specular.reflectance, Rgb(1 / 18.0f, 1 / 36.0f, 0.5f));
  expectNear(s.diffuse, Rgb(0.5f));
}

TEST(GltfMaterial, EveryMixtureConservesEnergy) {
  for (const double metallic : {0.0, 0.3, 1.0}) {
    for (const double ior : {0.0, 1.0, 1.5, 10.0}) {
      json m = pbr({{"metallicFactor", metallic}});
      m["extensions"]["KHR_materials_ior"]["ior"] = ior;
      const auto s = std::get<Opaque>(materialOf(m).surface);
      EXPECT_LE(maxChannel(s.diffuse + s.specular.reflectance), 1 + 1e-6f) << metallic << " " << ior;
    }
  }
}

TEST(GltfMaterial, TransmissionIsGlass) {
  json m = pbr({{"baseColorFactor", {1, 0.9, 0.8, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}});
  m["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.9;
  m["extensions"]["KHR_materials_ior"]["ior"] = 1.52;
  const auto pane = std::get<ThinGlass>(materialOf(m).surface);
  expectNear(pane.transmissivity, 0.9f * Rgb(1, 0.9f, 0.8f));
  EXPECT_FLOAT_EQ(pane.ior, 1.52f);
  m["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 0.1}, {"attenuationDistance", 2.0}, {"attenuationColor", {0.25, 1, 0}}};
  const auto body = std::get<Dielectric>(materialOf(m).surface);
  expectNear(body.transmission, Rgb(0.5f, 1, 0));
  EXPECT_FLOAT_EQ(body.ior, 1.52f);
  m["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0;
  EXPECT_TRUE(std::holds_alternative<ThinGlass>(materialOf(m).surface));
  json blend = pbr({{"baseColorFactor", {1, 1, 1, 0.2}}});
  blend["alphaMode"] = "BLEND";
  expectNear(std::get<ThinGlass>(materialOf(blend).surface).transmissivity, Rgb(0.8f));
}

TEST(GltfMaterial, EmissionIsLuminanceByTheEfficacy) {
  json m = {{"emissiveFactor", {1, 0.5, 0}}, {"doubleSided", true}};
  m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1790;
  Material lamp = materialOf(m);
  ASSERT_TRUE(lamp.emission);
  expectNear(lamp.emission->radiance, Rgb(10, 5, 0), 1e-5f);
  EXPECT_TRUE(lamp.emission->bothSides);
  ImportSettings settings;
  settings.luminousEfficacy = 683;
  expectNear(materialOf(m, settings).emission->radiance, Rgb(10, 5, 0) * (179 / 683.0f), 1e-5f);
}

// An uncompressed TGA of 2 x 1 texels: red 255, then green 128.
std::string redGreenImage() {
  std::string tga(18, '\0');
  tga[2] = 2, tga[12] = 2, tga[14] = 1, tga[16] = 24, tga[17] = 0x20;
  return tga + std::string("\x00\x00\xff\x00\x80\x00", 6);
}

GltfBuilder textured(const json& textureInfo) {
  GltfBuilder g;
  const std::string image = redGreenImage();
  g.doc["images"] = {
      {{"bufferView", g.view(std::vector<char>(image.begin(), image.end()))}, {"mimeType", "image/png"}}};
  g.doc["textures"] = {{{"source", 0}}};
  const int material = g.material(
      pbr({{"baseColorTexture", textureInfo}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}));
  const int positions = g.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  const int texcoords = g.vec2({0, 1, 1, 1, 1, 0, 0, 0});
  g.node({{"mesh",
           g.mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}}, g.indices({0, 1, 2, 0, 2, 3}), material)}});
  return g;
}

TEST(GltfMaterial, BaseColourTextureIsLinear) {
  const ImportedScene imported = read(textured({{"index", 0}}));
  ASSERT_EQ(imported.scene.textures.size(), 1u);
  const Texture& texture = imported.scene.textures[0];
  ASSERT_EQ(texture.width, 2);
  expectNear(texture.texels[0], Rgb(1, 0, 0));
  expectNear(texture.texels[1], Rgb(0, 0.2158605f, 0));  // sRGB 128
  const auto& s = std::get<Opaque>(imported.scene.materials[0].surface);
  expectNear(s.diffuse, Rgb(0.48f));
  EXPECT_TRUE(s.diffuseTexture.valid());
  const auto& mesh = std::get<Mesh>(imported.scene.primitives[0].shape);
  EXPECT_EQ(mesh.texcoords[2], Vec2(1, 0));
}

TEST(GltfMaterial, TextureTransform) {
  // The specification's example: the lower left quadrant, turned.
  const GltfBuilder g =
      textured({{"index", 0},
                {"extensions",
                 {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}}}}}});
  const ImportedScene imported = read(g);
  const auto& mesh = std::get<Mesh>(imported.scene.primitives[0].shape);
  for (const auto& [i, expected] :
       {std::pair{0, Vec2(0.5, 1)}, {1, Vec2(0.5, 0.5)}, {2, Vec2(0, 0.5)}, {3, Vec2(0, 1)}}) {
    EXPECT_LT(glm::distance(mesh.texcoords[static_cast<std::size_t>(i)], expected), 1e-12) << i;
  }
}

TEST(GltfMaterial, TexturesThatWouldNotRepeatAreCounted) {
  GltfBuilder g = textured({{"index", 0}});
  g.doc["samplers"] = {{{"wrapS", 33071}, {"wrapT", 10497}}};
  g.doc["textures"][0]["sampler"] = 0;
  EXPECT_TRUE(read(g).report.ignored.empty());
  g.doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {
      2, 2};
  EXPECT_EQ(read(g).report.ignored.size(), 1u);
}

TEST(GltfMaterial, UnreadableImagesAreRefused) {
  GltfBuilder g = textured({{"index", 0}});
  g.bytes[2] = 99;  // no such kind of TGA
  EXPECT_THROW(read(g), InputError);
  GltfBuilder huge = textured({{"index", 0}});
  huge.bytes[13] = huge.bytes[15] = 0x7f;  // 32514 x 32513 texels in 24 bytes
  EXPECT_THROW(read(huge), InputError);
  GltfBuilder none = textured({{"index", 0}});
  none.doc["textures"] = {json::object()};
  EXPECT_THROW(read(none), InputError);
}

TEST(GltfMaterial, IgnoredThingsAreCounted) {
  GltfBuilder g = textured({{"index", 0}});
  g.doc["materials"][0]["normalTexture"]["index"] = 0;
  g.doc["materials"][0]["extensions"]["KHR_materials_clearcoat"] = json::object();
  g.doc["animations"] = {json::object(), json::object()};
  const ImportedScene imported = read(g);
  EXPECT_EQ(imported.report.ignored.at("normal textures"), 1u);
  EXPECT_EQ(imported.report.ignored.at("KHR_materials_clearcoat"), 1u);
  EXPECT_EQ(imported.report.ignored.at("animations"), 2u);
  EXPECT_EQ(imported.report.warnings.size(), 1u);
}

GltfBuilder lit(const json& light, const json& node) {
  GltfBuilder g;
  g.doc["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  json complete = node;
  complete["extensions"]["KHR_lights_punctual"]["light"] = 0;
  g.node(complete);
  return g;
}

TEST(GltfLight, PointInCandela) {
  const ImportedScene imported = read(lit({{"type", "point"}, {"intensity", 358}, {"color", {1, 0.5, 0}}},
                                          {{"name", "bulb"}, {"translation", {1, 2, 3}}, {"scale", {7, 7, 7}}}));
  ASSERT_EQ(imported.scene.lights.size(), 1u);
  EXPECT_EQ(imported.scene.lights[0].name, "bulb");
  const auto& point = std::get<PointLight>(imported.scene.lights[0].emitter);
  EXPECT_EQ(point.position, Vec3(1, 2, 3));
  expectNear(point.intensity, Rgb(2, 1, 0));
}

TEST(GltfLight, SpotConeAndAim) {
  const ImportedScene imported =
      read(lit({{"type", "spot"}, {"intensity", 179}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}},
               {{"rotation", {-0.70710678118654752, 0, 0, 0.70710678118654752}}}));
  const auto& spot = std::get<SpotLight>(imported.scene.lights[0].emitter);
  EXPECT_LT(glm::distance(spot.direction, Vec3(0, -1, 0)), 1e-12);
  EXPECT_NEAR(spot.cosInner, std::cos(0.2), 1e-12);
  EXPECT_NEAR(spot.cosOuter, std::cos(0.5), 1e-12);
  expectNear(radiantIntensity(spot, {0, -1, 0}), Rgb(1));
}

TEST(GltfLight, SunGivesItsIlluminance) {
  const ImportedScene imported = read(lit({{"type", "directional"}, {"intensity", 100000}}, json::object()));
  const auto& sun = std::get<SunLight>(imported.scene.lights[0].emitter);
  EXPECT_EQ(sun.direction, Vec3(0, 0, 1));
  const double sine = std::sin(sun.angularRadius);
  EXPECT_NEAR(photometric(RgbSum(sun.radiance) * kPi * sine * sine, 179), 100000, 1);
}

TEST(GltfLight, IesProfileFromABufferView) {
  const std::string ies =
      "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 4 1 2 0 0 0\n1 1 1\n0 45 90\n0 90 180 360\n"
      "100 100 100 200 200 200 300 300 300 100 100 100\n";
  GltfBuilder g;
  g.doc["extensions"]["EXT_lights_ies"]["lights"] = {
      {{"bufferView", g.view(std::vector<char>(ies.begin(), ies.end()))}, {"mimeType", "application/x-ies-lm-63"}}};
  // Aimed along -y, its 0 plane along x: local -z -> -y, local y -> -z.
  g.node({{"name", "spot"},
          {"rotation", {-0.70710678118654752, 0, 0, 0.70710678118654752}},
          {"extensions", {{"EXT_lights_ies", {{"light", 0}, {"multiplier", 2}, {"color", {1, 0.5, 0.25}}}}}}});
  ImportSettings settings;
  settings.luminousEfficacy = 683;  // by which the scene's light is told again
  const ImportedScene imported = read(g, settings);
  EXPECT_EQ(imported.scene.luminousEfficacy, 683);
  const auto& light = std::get<PhotometricLight>(imported.scene.lights.at(0).emitter);
  expectNear(radiantIntensity(light, glm::normalize(Vec3(1, -1, 0))), Rgb(200, 100, 50) / 683.0f, 1e-4f);
  expectNear(radiantIntensity(light, glm::normalize(Vec3(0, -1, -1))), Rgb(400, 200, 100) / 683.0f, 1e-4f);
  EXPECT_EQ(radiantIntensity(light, Vec3(0, 1, 0)), Rgb(0));
}

}  // namespace
}  // namespace deltalux
