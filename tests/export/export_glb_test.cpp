// The .glb as others read it: by its own reader of glTF, by Khronos's validator, by its bytes.
#include <gtest/gtest.h>
#include <stb/stb_image.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstring>
#include <deltalux/error.hpp>
#include <deltalux/export_glb.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <deltalux/light_groups.hpp>
#include <nlohmann/json.hpp>

#include "baked_scene.hpp"
#include "export/rgbm.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using nlohmann::json;
using test::TempFolder;

/// The JSON of a .glb, after a look at its lengths.
json documentOf(const std::filesystem::path& file) {
  const std::string bytes = test::readText(file);
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(8), bytes.size());
  EXPECT_EQ(word(12) % 4, 0u);
  return json::parse(bytes.substr(20, word(12)));
}

/// Runs the validator; skips, or expects it to be content.
void expectValid(const std::filesystem::path& file) {
  const std::string command =
      "node '" DELTALUX_SOURCE_DIR "/tests/export/validate_glb.cjs' '" + file.string() + "' 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  for (char buffer[4096]; const std::size_t n = std::fread(buffer, 1, sizeof(buffer), pipe);) said.append(buffer, n);
  const int status = ::pclose(pipe), code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 127) GTEST_SKIP() << "there is no node on this machine";
  if (code == 77) GTEST_SKIP() << "there is no gltf-validator: npm install gltf-validator, and NODE_PATH to it";
  EXPECT_EQ(code, 0) << said;
}

const Engine& everything() {
  static const Engine engine = test::everythingSolved();
  return engine;
}

GlbSettings small() {
  GlbSettings settings;
  settings.atlasSize = 256;
  return settings;
}

TEST(ExportGlb, IsValid) {
  const TempFolder folder;
  exportGlb(everything().solution(), folder / "room.glb", small());
  expectValid(folder / "room.glb");
}

TEST(ExportGlb, IsValidPacked) {
  const TempFolder folder;
  GlbSettings settings = small();
  settings.meshopt = true;
  const GlbReport packed = exportGlb(everything().solution(), folder / "packed.glb", settings);
  const GlbReport plain = exportGlb(everything().solution(), folder / "plain.glb", small());
  EXPECT_LT(packed.bytes, plain.bytes);
  EXPECT_EQ(packed.triangles, plain.triangles);
  expectValid(folder / "packed.glb");
}

TEST(ExportGlb, IsValidUnlit) {
  const TempFolder folder;
  const GlbReport report = exportUnlitGlb(everything().solution(), folder / "room.glb", std::nullopt, small());
  const json document = documentOf(folder / "room.glb");
  EXPECT_EQ(document["asset"]["extras"]["deltalux"]["unlit"]["ev"].get<double>(), report.ev);
  for (const json& m : document["materials"]) EXPECT_TRUE(m["extensions"].contains("KHR_materials_unlit"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"room.glb"});
  expectValid(folder / "room.glb");
}

TEST(ExportGlb, SaysWhatItsLightMeans) {
  const TempFolder folder;
  const GlbReport report = exportGlb(everything().solution(), folder / "room.glb", small());
  ASSERT_EQ(report.files.size(), 1 + report.pages);
  EXPECT_EQ(report.files[1].filename(), "room.lightmap.exr");
  const json document = documentOf(folder / "room.glb");
  const json& lightmap = document["asset"]["extras"]["deltalux"]["lightmap"];
  EXPECT_EQ(lightmap["units"], "W/m2");
  EXPECT_EQ(lightmap["factor"], 1);
  EXPECT_EQ(lightmap["pages"][0]["exr"], "room.lightmap.exr");
  int lit = 0;
  for (const json& m : document["materials"])
    if (m.contains("extensions") && m["extensions"].contains("MOZ_lightmap")) {
      ++lit;
      EXPECT_EQ(m["extensions"]["MOZ_lightmap"]["texCoord"], 1);
      const std::size_t page = m["extensions"]["MOZ_lightmap"]["index"].get<std::size_t>();
      EXPECT_EQ(lightmap["pages"][page]["texture"], page);
      EXPECT_EQ(m["extensions"]["MOZ_lightmap"]["intensity"], lightmap["pages"][page]["intensity"]);
    }
  EXPECT_GT(lit, 3);
}

/// The bytes of a view of the buffer.
std::string viewOf(const std::filesystem::path& file, const json& document, std::size_t view) {
  const std::string bytes = test::readText(file);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof(length));
  const json& v = document["bufferViews"][view];
  return bytes.substr(20 + length + 8 + v.value("byteOffset", std::size_t(0)), v["byteLength"].get<std::size_t>());
}

TEST(ExportGlb, NodesNameTheirLightmapsWhereAsked) {
  const TempFolder folder;
  GlbSettings settings = small();
  settings.lightmap = LightmapExtension::Mx;
  const GlbReport report = exportGlb(everything().solution(), folder / "room.glb", settings);
  const json document = documentOf(folder / "room.glb");
  for (const json& m : document["materials"])
    EXPECT_FALSE(m.contains("extensions") && m["extensions"].contains("MOZ_lightmap"));
  std::vector<float> intensities(report.pages, 0.0f);
  for (const json& node : document["nodes"]) {
    if (!node.contains("extensions")) continue;
    const json& lightmap = node["extensions"]["MX_lightmap"];
    EXPECT_EQ(lightmap["lightMapTexture"]["texCoord"], 1);
    intensities.at(lightmap["lightMapTexture"]["index"].get<std::size_t>()) = lightmap["intensity"];
    EXPECT_TRUE(node.contains("mesh"));
  }
  for (std::size_t page = 0; page < report.pages; ++page) {
    ASSERT_GT(intensities[page], 0.0f);
    const json& image = document["images"][document["textures"][page]["source"].get<std::size_t>()];
    const std::string png = viewOf(folder / "room.glb", document, image["bufferView"].get<std::size_t>());
    int width = 0, height = 0, channels = 0;
    stbi_uc* const texels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()), int(png.size()), &width,
                                                  &height, &channels, 4);
    ASSERT_NE(texels, nullptr);
    EXPECT_EQ(channels, 4);
    const Image exact = loadImage(report.files[1 + page]);
    ASSERT_EQ(exact.pixels.size(), std::size_t(width) * std::size_t(height));
    const float most = exporting::kRgbmRange * intensities[page];
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
      const stbi_uc* t = texels + 4 * i;
      const Rgb E = intensities[page] * exporting::unpackRgbm({t[0], t[1], t[2], t[3]});
      EXPECT_LT(maxChannel(glm::abs(E - exact.pixels[i])), 0.004f * maxChannel(exact.pixels[i]) + 1e-4f * most);
    }
    stbi_image_free(texels);
  }
  expectValid(folder / "room.glb");
}

TEST(ExportGlb, KeepsTheLightInTheExr) {
  const TempFolder folder;
  GlbSettings settings = small();
  settings.range = 1e30;  // on one page, or two where it parts at 1 W/m2
  const GlbReport report = exportGlb(everything().solution(), folder / "room.glb", settings);
  const Image page = loadImage(folder / "room.lightmap.exr");
  double sum = 0;
  for (const Rgb& p : page.pixels) {
    ASSERT_TRUE(std::isfinite(p.r) && p.r >= 0 && p.g >= 0 && p.b >= 0);
    sum += gray(p);
  }
  EXPECT_GT(sum, 0);
  EXPECT_LE(report.pages, 2u);
}

/// Area of one side of all surfaces whose material has that name [m2].
double areaOf(const Scene& scene, const std::string& material) {
  double sum = 0;
  for (const Primitive& p : scene.primitives)
    if (scene[p.material].name == material) sum += area(p.shape);
  return sum * scene.metresPerUnit * scene.metresPerUnit;
}

TEST(ExportGlb, IsReadBackWithItsAreasAndMaterials) {
  const TempFolder folder;
  exportGlb(everything().solution(), folder / "room.glb", small());
  ImportSettings options;
  options.luminousEfficacy = 1;  // emission stands in the file in W/(sr m2)
  const Scene back = loadScene({folder / "room.glb"}, options).scene;
  const Scene& scene = everything().solution().scene();
  EXPECT_NEAR(glm::length(back.up - Vec3(0, 1, 0)), 0, 1e-9);
  for (const Material& m : back.materials) {
    if (m.name == "white") {
      EXPECT_NEAR(std::get<Opaque>(m.surface).diffuse.r, 0.7f, 1e-5);
    }
    if (m.name == "brass") {
      EXPECT_NEAR(std::get<Opaque>(m.surface).specular.reflectance.g, 0.5f, 1e-3);
    }
    if (m.name == "brass") {
      EXPECT_NEAR(std::get<Opaque>(m.surface).diffuse.r, 0.2f, 1e-3);
    }
    if (m.name == "pane") {
      EXPECT_NEAR(std::get<ThinGlass>(m.surface).transmissivity.r, 0.9f, 1e-5);
    }
    if (m.name == "water") {
      EXPECT_NEAR(std::get<Dielectric>(m.surface).ior, 1.33f, 1e-5);
    }
    if (m.name == "tiles") {
      EXPECT_TRUE(std::get<Opaque>(m.surface).diffuseTexture.valid());
    }
    if (m.name == "paper") {
      EXPECT_NEAR(m.coverage, 0.9f, 1e-5);
    }
  }
  EXPECT_NEAR(areaOf(back, "pane"), 2 * areaOf(scene, "pane"), 1e-4);  // both sides
}

TEST(ExportGlb, OfADarkSceneHasGeometryAlone) {
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "grey", test::lambert(0.5f)), Vec3(0), Vec3(1), true);
  Engine engine(std::move(scene), test::coarse());
  engine.solve();
  const TempFolder folder;
  const GlbReport report = exportGlb(engine.solution(), folder / "dark.glb", small());
  EXPECT_EQ(report.charts, 0u);
  EXPECT_GE(report.triangles, 12u);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"dark.glb"});
  expectValid(folder / "dark.glb");
}

/// What a page of a group's light has, its pixels all together.
RgbSum sumOfPage(const std::filesystem::path& file) {
  RgbSum sum(0.0);
  for (const Rgb& p : loadImage(file).pixels) sum += RgbSum(p);
  return sum;
}

TEST(ExportGlb, LightByGroupsAddsUpToAll) {
  SolveSettings settings = test::coarse();
  settings.byLight = true;
  Engine engine(test::oneOfEverything(), settings);
  engine.solve();
  const SolutionView solution = engine.solution();
  const std::vector<LightGroup> groups = lightGroups(solution);
  ASSERT_GT(groups.size(), 2u);
  const TempFolder folder;
  GlbSettings onePage = small();
  onePage.range = 1e30;
  const GlbReport report = exportGlbByLight(solution, folder / "room.glb", onePage);
  ASSERT_EQ(report.files.size(), 1 + report.pages * (1 + groups.size()));
  expectValid(folder / "room.glb");
  RgbSum all(0.0), parts(0.0);
  for (std::size_t page = 0; page < report.pages; ++page) all += sumOfPage(report.files[1 + page]);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t page = 0; page < report.pages; ++page)
      parts += RgbSum(solution.scene()[groups[g].lights.front()].scale) *
               sumOfPage(report.files[1 + report.pages * (1 + g) + page]);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(parts[c], all[c], 0.02 * all[c]);
}

class NastyGlb : public ::testing::TestWithParam<const char*> {};

TEST_P(NastyGlb, IsValidAndItsLightFinite) {
  Engine engine(loadScene({std::filesystem::path(DELTALUX_SOURCE_DIR "/scenes/nasty") / GetParam()}).scene,
                test::coarse());
  engine.solve();
  const TempFolder folder;
  const GlbReport report = exportGlb(engine.solution(), folder / "nasty.glb", small());
  for (std::size_t i = 1; i < report.files.size(); ++i)
    for (const Rgb& p : loadImage(report.files[i]).pixels)
      ASSERT_TRUE(std::isfinite(p.r + p.g + p.b) && p.r >= 0 && p.g >= 0 && p.b >= 0);
  expectValid(folder / "nasty.glb");
}

INSTANTIATE_TEST_SUITE_P(Scenes, NastyGlb,
                         ::testing::Values("coplanar.rad", "far_away.rad", "mirror_corridor.rad", "nested_glass.rad",
                                           "outlines.rad", "scales.rad", "sealed.rad", "slivers.rad", "thin.rad",
                                           "touching.rad"));

TEST(ExportGlb, LeavesNothingWhereItCannotWrite) {
  const TempFolder folder;
  EXPECT_THROW(exportGlb(everything().solution(), folder / "none" / "room.glb", small()), OutputError);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace deltalux
