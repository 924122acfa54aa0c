// TM-33 files written for each rule of the format, measured by closed forms: an isotropic emitter of I cd gives 4 pi I
// lm.
#include "io/tm33.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <functional>

#include "io/ies.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

using Intensity = std::function<double(double, double)>;

struct EmitterText {
  double h0 = 0, h1 = 360, v0 = 0, v1 = 180, step = 15;
  std::string symmetry;       // of Symm, empty for none
  std::string extra, before;  // elements of LuminousIntensity, of the emitter
  std::string flux;           // LuminousFlux
  Intensity intensity = [](double, double) { return 1000 / (4 * kPi); };

  std::string str() const {
    std::string text = "<Emitter>\n<Quantity>1</Quantity>\n<Description>LED</Description>\n" + before +
                       "<LuminousData>\n<LuminousIntensity>\n";
    if (!symmetry.empty()) text += "<Symm>" + symmetry + "</Symm>\n";
    text += extra;
    for (double h = h0; h <= h1; h += step)
      for (double v = v0; v <= v1; v += step / 3)
        text += fmt::format("<IntData h=\"{}\" v=\"{}\">{}</IntData>\n", h, v, intensity(h, v));
    text += "</LuminousIntensity>\n" + (flux.empty() ? "" : "<LuminousFlux>" + flux + "</LuminousFlux>\n");
    return text +
           "</LuminousData>\n<EmissionAreas><BottomFace><NumberBottom>1</NumberBottom><BottomArea><Length>1.2</Length>"
           "<Width>0.6</Width><LengthOffset>0</LengthOffset><WidthOffset>0</WidthOffset></BottomArea></BottomFace>"
           "</EmissionAreas>\n</Emitter>\n";
  }
};

std::string document(const std::string& emitters, const std::string& type = "CIE_C",
                     const std::string& root = "IESTM33-22") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<" + root +
         ">\n<Version>1.1</Version>\n<Header><Description>d</Description></Header>\n" +
         "<Equipment><Gonioradiometer><Type>" + type + "</Type></Gonioradiometer></Equipment>\n" + emitters + "</" +
         root + ">\n";
}

PhotometryFile read(const std::string& text) { return readPhotometry(text, "lamp.xml", "."); }
PhotometryFile read(const EmitterText& emitter) { return read(document(emitter.str())); }
double fluxOf(const EmitterText& emitter) { return luminousFlux(read(emitter).photometry); }

void expectError(const std::string& text, int line, const std::string& words) {
  try {
    read(text);
    ADD_FAILURE() << "was read: " << words;
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "lamp.xml");
    EXPECT_NE(error.message().find(words), std::string::npos) << error.message();
    EXPECT_FALSE(error.hint().empty());
    if (line >= 0) {
      EXPECT_EQ(error.line(), line) << error.message();
    }
  }
}

TEST(Tm33Reader, IntensitiesAreCandela) {
  EmitterText text;
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 1000, 0.1);
  EXPECT_NEAR(candela(file.photometry, 70, 40), 1000 / (4 * kPi), 1e-9);
  EXPECT_TRUE(file.warnings.empty());
  text.extra = "<Multiplier>0.5</Multiplier>\n";
  EXPECT_NEAR(fluxOf(text), 500, 0.1);
}

TEST(Tm33Reader, IsReadByAllItsNames) {
  for (const char* root : {"IESTM33", "IESTM33-18", "IESTM33-22", "ATLA_S001_A", "UNI11733"})
    EXPECT_NEAR(luminousFlux(read(document(EmitterText().str(), "CIE_C", root)).photometry), 1000, 0.1) << root;
  EXPECT_NEAR(luminousFlux(readPhotometry(document(EmitterText().str()), "lamp.ies", ".").photometry), 1000, 0.1);
  std::string other = document(EmitterText().str());
  other.replace(other.find("1.0"), 3, "1.1");  // version of XML: printed so in samples of the standard
  EXPECT_NEAR(luminousFlux(read(other).photometry), 1000, 0.1);
  const test::TempFolder folder;
  folder.write("lamp.xml", document(EmitterText().str()));
  EXPECT_NEAR(luminousFlux(loadPhotometry(folder / "lamp.xml")), 1000, 0.1);
}

TEST(Tm33Reader, SymmetriesAreTheWholeCircleOfPlanes) {
  const auto degrees = [](double c) { return c * kPi / 180; };
  const Intensity alongC0 = [&](double c, double g) { return 100 + 50 * std::cos(degrees(c)) + 0.1 * g; };
  const Intensity alongC90 = [&](double c, double g) { return 100 + 50 * std::sin(degrees(c)) + 0.1 * g; };
  const Intensity both = [&](double c, double g) { return 100 + 50 * std::cos(2 * degrees(c)) + 0.1 * g; };
  const Intensity fades = [](double, double g) { return 100 + 0.5 * g; };
  struct Case {
    const char* symmetry;
    double h0, h1;
    Intensity intensity;
  };
  const std::vector<Case> cases{{"Symm_None", 0, 360, alongC0},     {"Symm_None", 0, 345, alongC0},
                                {"Symm_None", -180, 165, alongC90}, {"Symm_Bi_0", 0, 180, alongC0},
                                {"Symm_Bi0", 0, 180, alongC0},      {"Symm _ Bi _90", 90, 270, alongC90},
                                {"Symm_Bi_90", -90, 90, alongC90},  {"Symm_Quad", 0, 90, both},
                                {"Symm_Full", 0, 0, fades},         {"", 0, 90, both}};
  for (const Case& c : cases) {
    EmitterText text;
    text.symmetry = c.symmetry, text.h0 = c.h0, text.h1 = c.h1, text.intensity = c.intensity;
    const PhotometryFile file = read(text);
    EXPECT_TRUE(file.warnings.empty()) << c.symmetry;
    for (double h = 0; h < 360; h += 15)
      for (double v = 5; v < 180; v += 35)
        EXPECT_NEAR(candela(file.photometry, v, h), c.intensity(h, v), 1e-9) << c.symmetry << " h" << h << " v" << v;
  }
}

TEST(Tm33Reader, SymmetryAndAnglesHaveToAgree) {
  EmitterText text;
  text.h1 = 90, text.symmetry = "Symm_Bi_0";
  expectError(document(text.str()), 11, "Symm is Symm_Bi_0");
  text.symmetry = "Symm_Full";
  expectError(document(text.str()), 11, "Symm is Symm_Full");
  text.symmetry = "Symm_None";
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 1000, 0.1);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("no symmetry"), std::string::npos);
}

TEST(Tm33Reader, EmittersShineTogether) {
  EmitterText down, up;
  down.v1 = 90, down.h1 = 0;
  up.v0 = 90, up.step = 30, up.symmetry = "Symm_Quad", up.h1 = 90;
  up.intensity = [](double, double) { return 3000 / (4 * kPi); };
  const PhotometryFile file = read(document(down.str() + up.str()));
  EXPECT_NEAR(luminousFlux(file.photometry), 500 + 1500, 0.5);
  EXPECT_NEAR(candela(file.photometry, 80, 10), 1000 / (4 * kPi), 1e-9);
  EXPECT_NEAR(candela(file.photometry, 100, 10), 3000 / (4 * kPi), 1e-9);
  EXPECT_TRUE(file.warnings.empty());
  const PhotometryFile dark = read(document(down.str() + "<Emitter><Quantity>1</Quantity></Emitter>"));
  EXPECT_NEAR(luminousFlux(dark.photometry), 500, 0.1);
  ASSERT_EQ(dark.warnings.size(), 1u);
  EXPECT_NE(dark.warnings[0].find("1 of its emitters"), std::string::npos);
}

TEST(Tm33Reader, RelativeIntensitiesAreOfTheRatedLamps) {
  EmitterText text;
  text.before = "<RatedLumens>1250</RatedLumens>\n<BallastFactor>0.9</BallastFactor>\n";
  EXPECT_NEAR(fluxOf(text), 1000, 0.1);
  text.extra = "<AbsolutePhotometry>false</AbsolutePhotometry>\n";
  EXPECT_NEAR(fluxOf(text), 900, 0.1);
  EXPECT_TRUE(read(text).warnings.empty());
  text.before = "<RatedLumens>400</RatedLumens>\n";
  const PhotometryFile file = read(text);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("candela per 1000 lm"), std::string::npos);
}

TEST(Tm33Reader, IntensitiesPerThousandLumensAreKnownByTheFlux) {
  EmitterText text;  // 80 % of 5000 lm, as files made from EULUMDAT have it
  text.before = "<RatedLumens>5000</RatedLumens>\n";
  text.flux = "4000";
  text.intensity = [](double, double) { return 800 / (4 * kPi); };
  text.extra = "<AbsolutePhotometry>False</AbsolutePhotometry>\n";
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 4000, 0.5);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("taken so"), std::string::npos);
  text.extra = "<AbsolutePhotometry>true</AbsolutePhotometry>\n";
  EXPECT_NEAR(fluxOf(text), 800, 0.1);
  EXPECT_EQ(read(text).warnings.size(), 1u);
}

TEST(Tm33Reader, TypesAAndBAreKnownByAnglesBelowZero) {
  EmitterText text;  // an isotropic front half
  text.h0 = -90, text.h1 = 90, text.v0 = -90, text.v1 = 90;
  for (const char* type : {"CIE_A", "IES_B"})
    EXPECT_NEAR(luminousFlux(read(document(text.str(), type)).photometry), 500, 1) << type;
  expectError(document(text.str(), "CIE_C"), 10, "angles below 0");
  text.h0 = 0, text.v0 = 0;
  EXPECT_NEAR(luminousFlux(read(document(text.str(), "CIE_A")).photometry), 500, 1);
}

TEST(Tm33Reader, LengthLiesAlongC90) {
  const Photometry found = read(EmitterText()).photometry;
  EXPECT_DOUBLE_EQ(found.opening.x, 1.2);  // along C90
  EXPECT_DOUBLE_EQ(found.opening.y, 0.6);  // along C0
  EXPECT_DOUBLE_EQ(found.opening.z, 0);
}

TEST(Tm33Reader, IntensitiesStandInAnyOrder) {
  std::string text = document(
      "<Emitter><LuminousData><LuminousIntensity><IntData v=\"180\" h=\"0\">3</IntData><IntData v=\"0\" h=\"0\"> 1 "
      "</IntData>"
      "<IntData v=\"90\" h=\"0\">2e0</IntData></LuminousIntensity></LuminousData></Emitter>");
  const Photometry found = read(text).photometry;
  EXPECT_DOUBLE_EQ(candela(found, 0, 10), 1);
  EXPECT_DOUBLE_EQ(candela(found, 45, 200), 1.5);
  EXPECT_DOUBLE_EQ(candela(found, 180, 10), 3);
}

TEST(Tm33Reader, NamesTheLineOfAMistake) {
  const std::string good = document(EmitterText().str());
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = good;
    return text.replace(text.find(what), what.size(), instead);
  };
  expectError("", -1, "is not XML");
  expectError("Maker\n1\n", 1, "is not XML");
  expectError("<scene/>", 1, "no luminaire of TM-33");
  expectError(good.substr(0, 900), -1, "is not XML");
  expectError(with("h=\"0\" v=\"5\"", "v=\"5\""), 12, "has no angle h");
  expectError(with("h=\"0\" v=\"5\"", "h=\"0\" v=\"five\""), 12, "not a number");
  expectError(with("h=\"0\" v=\"5\"", "h=\"400\" v=\"5\""), 12, "400 degrees");
  expectError(with("h=\"0\" v=\"5\"", "h=\"0\" v=\"6\""), 10, "has no intensity");
  expectError(with("h=\"15\" v=\"5\">", "h=\"15\" v=\"5\">1</IntData><IntData h=\"15\" v=\"5\">"), 49, "twice");
  expectError(with(">79.5", ">nan79.5"), 11, "not a number");
  expectError(document("<Emitter><PhotonData/></Emitter>"), 2, "no emitter has luminous intensities");
  expectError(document(""), 2, "no emitter has luminous intensities");
  EmitterText large;
  large.extra = "<Multiplier>1e300</Multiplier>\n";
  expectError(document(large.str()), 10, "too large");
  large.extra = "<Multiplier>0</Multiplier>\n";
  expectError(document(large.str()), 11, "not positive");
}

TEST(Tm33Reader, EntitiesAndEndlessNestingAreRefused) {
  expectError("<!DOCTYPE a [\n<!ENTITY b \"c\">\n]><IESTM33>&b;</IESTM33>", 2, "declares entities");
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  expectError(deep, 1, "deeper than");
}

}  // namespace
}  // namespace deltalux
