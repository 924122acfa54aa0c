// EULUMDAT files written for each rule of the format, judged by closed forms: an isotropic source of I cd per 1000 lm
// gives 4 pi I / 1000 of the flux of its lamps.
#include "io/ldt.hpp"

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

struct LampSet {
  int count = 1;
  std::string type = "T16";
  double flux = 1000;
};

struct LdtText {
  int symmetry = 0, planes = 24;
  double lastGamma = 180;
  std::string area = "600\n120\n0\n0\n0\n0";
  std::string ratio = "100", conversion = "1", tilt = "0";
  std::vector<LampSet> sets = {{}};
  bool byField = false;
  std::function<double(double, double)> intensity = [](double, double) { return 1000 / (4 * kPi); };

  std::string lamps() const {
    std::string text;
    const auto fields = [](const LampSet& s) {
      return std::vector<std::string>{
          fmt::format("{}", s.count), s.type, fmt::format("{}", s.flux), "3000", "1B", "36"};
    };
    if (byField) {
      for (std::size_t f = 0; f < 6; ++f)
        for (const LampSet& s : sets) text += fields(s)[f] + "\n";
    } else {
      for (const LampSet& s : sets) text += fmt::format("{}\n", fmt::join(fields(s), "\n"));
    }
    return text;
  }
  /// C planes that the format stores, by their symmetry.
  std::vector<double> stored() const {
    const double step = 360.0 / planes;
    const double first = symmetry == 3 ? 270 : 0, span = symmetry == 0   ? 360 - step
                                                         : symmetry == 1 ? 0
                                                         : symmetry == 4 ? 90
                                                                         : 180;
    std::vector<double> all;
    for (double c = 0; c <= span + 1e-9; c += step) all.push_back(std::fmod(first + c, 360.0));
    return all;
  }
  std::string str() const {
    const int angles = static_cast<int>(lastGamma / 5) + 1;
    std::string text =
        fmt::format("Maker\n1\n{}\n{}\n{}\n{}\n5\nreport\nLamp\nno 1\nlamp.ldt\ntoday\n620\n140\n60\n{}\n", symmetry,
                    planes, 360.0 / planes, angles, area);
    text += fmt::format("100\n{}\n{}\n{}\n{}\n{}", ratio, conversion, tilt, sets.size(), lamps());
    for (int i = 0; i < 10; ++i) text += "0.5\n";
    for (int i = 0; i < planes; ++i) text += fmt::format("{}\n", 360.0 / planes * i);
    for (int i = 0; i < angles; ++i) text += fmt::format("{}\n", 5 * i);
    for (const double c : stored())
      for (int i = 0; i < angles; ++i) text += fmt::format("{}\n", intensity(c, 5 * i));
    return text;
  }
};

PhotometryFile read(const std::string& text) { return readPhotometry(text, "lamp.ldt", "."); }
PhotometryFile read(const LdtText& text) { return read(text.str()); }

double candelaAt(const Photometry& p, double horizontal, double vertical) {
  PhotometricLight light;
  light.photometry = std::make_shared<Photometry>(p);
  const double h = horizontal * kPi / 180, v = vertical * kPi / 180;
  return kLuminousEfficacy *
         radiantIntensity(light, {std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), -std::cos(v)}).g;
}

int errorLine(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "lamp.ldt");
    EXPECT_FALSE(error.hint().empty());
    return error.line();
  }
  return -1;
}

std::string withLine(const LdtText& text, int line, const std::string& field) {
  std::string all = text.str();
  std::size_t begin = 0;
  for (int i = 1; i < line; ++i) begin = all.find('\n', begin) + 1;
  return all.replace(begin, all.find('\n', begin) - begin, field);
}

TEST(LdtReader, IntensitiesArePerThousandLumensOfTheLamps) {
  LdtText text;
  text.sets = {{2, "T16", 6400}};
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 6400, 1);
  EXPECT_NEAR(candelaAt(file.photometry, 40, 70), 6400 / (4 * kPi), 0.01);
  EXPECT_TRUE(file.warnings.empty());
  text.conversion = "0.5", text.ratio = "50";
  EXPECT_NEAR(luminousFlux(read(text).photometry), 3200, 1);
}

TEST(LdtReader, OfSeveralSetsOfLampsTheFirstCounts) {
  LdtText text;
  text.sets = {{1, "T16 28 W", 2600}, {1, "T16 54 W", 4450}, {1, "T16 80 W", 6550}};
  for (const bool byField : {false, true}) {
    text.byField = byField;
    const PhotometryFile file = read(text);
    EXPECT_NEAR(luminousFlux(file.photometry), 2600, 1) << byField;
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_NE(file.warnings[0].find("3 sets of lamps"), std::string::npos);
  }
}

TEST(LdtReader, ANegativeNumberOfLampsIsAbsolutePhotometry) {
  LdtText text;
  text.sets = {{-1, "LED", 3170}};
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 3170, 1);
  EXPECT_TRUE(file.warnings.empty());
}

TEST(LdtReader, SymmetriesAreTheWholeCircleOfPlanes) {
  using Intensity = std::function<double(double, double)>;
  const auto degrees = [](double c) { return c * kPi / 180; };
  const Intensity fades = [](double, double g) { return 100 + 0.5 * g; };
  const Intensity alongC0 = [&](double c, double g) { return 100 + 50 * std::cos(degrees(c)) + 0.1 * g; };
  const Intensity alongC90 = [&](double c, double g) { return 100 + 50 * std::sin(degrees(c)) + 0.1 * g; };
  const Intensity both = [&](double c, double g) { return 100 + 50 * std::cos(2 * degrees(c)) + 0.1 * g; };
  const std::vector<std::pair<int, Intensity>> cases{{0, alongC0}, {1, fades}, {2, alongC0}, {3, alongC90}, {4, both}};
  for (const auto& [symmetry, intensity] : cases) {
    LdtText text;
    text.symmetry = symmetry, text.intensity = intensity, text.ratio = "0";
    const Photometry found = read(text).photometry;
    for (double c = 0; c < 360; c += 15)
      for (double g = 5; g < 180; g += 35)
        EXPECT_NEAR(candelaAt(found, c, g), intensity(c, g), 1e-3 * intensity(c, g))
            << symmetry << " C" << c << " " << g;
  }
}

TEST(LdtReader, BelowTheHorizonAlone) {
  LdtText text;
  text.lastGamma = 90, text.ratio = "50";
  const Photometry found = read(text).photometry;
  EXPECT_NEAR(luminousFlux(found), 500, 2);
  EXPECT_EQ(candelaAt(found, 0, 100), 0);
}

TEST(LdtReader, ALongLuminaireLiesAlongC90) {
  LdtText text;
  const Photometry found = read(text).photometry;
  EXPECT_DOUBLE_EQ(found.opening.x, 0.6);   // along C90
  EXPECT_DOUBLE_EQ(found.opening.y, 0.12);  // along C0
  text.area = "300\n0\n50\n0\n50\n0";
  const Photometry round = read(text).photometry;
  EXPECT_DOUBLE_EQ(round.opening.x, -0.3);  // as in LM-63
  EXPECT_DOUBLE_EQ(round.opening.y, -0.3);
  EXPECT_DOUBLE_EQ(round.opening.z, 0.05);
}

TEST(LdtReader, SaysWhereIntensitiesAndLampsDisagree) {
  LdtText text;
  text.sets = {{1, "LED", 4000}};
  text.intensity = [](double, double) { return 4000 / (4 * kPi); };  // cd, not cd per 1000 lm
  const PhotometryFile file = read(text);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("candela per 1000 lm"), std::string::npos) << file.warnings[0];
}

TEST(LdtReader, TakesLinesAndDecimalsOfOtherPrograms) {
  LdtText text;
  std::string all = text.str();
  for (char& c : all)
    if (c == '.') c = ',';
  std::string lines;
  for (const char c : all) lines += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_NEAR(luminousFlux(readPhotometry(lines, "lamp.LDT", ".").photometry), 1000, 1);
}

TEST(LdtReader, NamesTheLineOfAMistake) {
  LdtText text;
  EXPECT_EQ(errorLine(withLine(text, 3, "5")), 3);        // no such symmetry
  EXPECT_EQ(errorLine(withLine(text, 4, "0")), 4);        // no plane
  EXPECT_EQ(errorLine(withLine(text, 6, "thirty")), 6);   // no number
  EXPECT_EQ(errorLine(withLine(text, 26, "0")), 26);      // no lamps
  EXPECT_EQ(errorLine(withLine(text, 29, "0")), 32);      // without light
  EXPECT_EQ(errorLine(withLine(text, 44, "-15")), 44);    // planes do not ascend
  EXPECT_GT(errorLine(text.str() + "12\n"), 900);         // more than announced
  EXPECT_GT(errorLine(text.str().substr(0, 3000)), 100);  // less
  text.symmetry = 4, text.planes = 6;                     // no quarter
  EXPECT_GT(errorLine(text.str()), 40);
  EXPECT_EQ(errorLine(""), 1);
}

TEST(LdtReader, FilesAreKnownByTheirNames) {
  EXPECT_TRUE(namesLdt("a/b.ldt"));
  EXPECT_TRUE(namesLdt("B.LDT"));
  EXPECT_FALSE(namesLdt("b.ies"));
  const test::TempFolder folder;
  folder.write("lamp.ldt", LdtText().str());
  EXPECT_NEAR(luminousFlux(loadPhotometry(folder / "lamp.ldt")), 1000, 1);
}

}  // namespace
}  // namespace deltalux
