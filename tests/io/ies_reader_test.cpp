// IES files written for each rule of the standard, judged by closed forms: an isotropic source gives 4 pi I lumens, a
// Lambertian one pi I.
#include "io/ies.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <functional>

#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

constexpr double kDegree = kPi / 180;

std::vector<double> range(double first, double last, double step) {
  std::vector<double> values;
  for (int i = 0; first + i * step <= last + 1e-9; ++i) values.push_back(first + i * step);
  return values;
}

struct IesText {
  std::string head = "IESNA:LM-63-2002";
  std::string tilt = "TILT=NONE";
  double lumens = -1, multiplier = 1;
  int type = 1, units = 2;
  std::string dimensions = "0 0 0";
  std::string electrical = "1 1 10";
  std::vector<double> verticals = range(0, 180, 5);
  std::vector<double> horizontals = {0};
  std::function<double(double, double)> candela = [](double, double) { return 100.0; };

  std::string str() const {
    std::string text = fmt::format("{}\n[TEST] none\n{}\n1 {} {} {} {} {} {} {}\n{}\n", head, tilt, lumens, multiplier,
                                   verticals.size(), horizontals.size(), type, units, dimensions, electrical);
    text += fmt::format("{}\n{}\n", fmt::join(verticals, " "), fmt::join(horizontals, " "));
    for (const double h : horizontals) {
      for (const double v : verticals) text += fmt::format("{} ", candela(v, h));
      text += "\n";
    }
    return text;
  }
};

PhotometryFile read(const std::string& text) { return readPhotometry(text, "lamp.ies", "."); }
PhotometryFile read(const IesText& text) { return read(text.str()); }

Rgb shine(const Photometry& photometry, const Vec3& direction) {
  PhotometricLight light;
  light.photometry = std::make_shared<Photometry>(photometry);
  return radiantIntensity(light, glm::normalize(direction));
}

int errorLine(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "lamp.ies");
    EXPECT_FALSE(error.hint().empty());
    return error.line();
  }
  ADD_FAILURE() << "was read:\n" << text.substr(0, 300);
  return -1;
}

TEST(IesReader, IsotropicFluxIsFourPiI) {
  EXPECT_NEAR(luminousFlux(read(IesText{}).photometry), 400 * kPi, 1e-9);
  const Rgb intensity = shine(read(IesText{}).photometry, {0.3, -0.2, 0.7});
  EXPECT_NEAR(intensity.r, 100 / 179.0, 1e-6);
  EXPECT_EQ(intensity.r, intensity.b);
}

TEST(IesReader, LambertianFluxIsPiI) {
  IesText text;
  text.verticals = range(0, 90, 2.5);
  text.candela = [](double v, double) { return 1000 * std::cos(v * kDegree); };
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 1000 * kPi, 0.5);  // the polygon lies inside the curve: 0.016 %
  EXPECT_TRUE(file.warnings.empty());
  EXPECT_EQ(shine(file.photometry, {0, 0, 1}).g, 0);
  EXPECT_NEAR(shine(file.photometry, {0, 0, -1}).g, 1000 / 179.0, 1e-4);
}

TEST(IesReader, CandelaIsLinearInEveryFactor) {
  IesText text;
  const double plain = luminousFlux(read(text).photometry);
  text.multiplier = 2.5;
  EXPECT_NEAR(luminousFlux(read(text).photometry), 2.5 * plain, 1e-9);
  text.electrical = "0.8 1 10";
  EXPECT_NEAR(luminousFlux(read(text).photometry), 2.0 * plain, 1e-9);
}

TEST(IesReader, BallastLampFactorCountsOnlyBefore1995) {
  const double plain = luminousFlux(read(IesText{}).photometry);
  IesText text;
  text.electrical = "1 0.9 10";
  for (const auto& [head, factor] : {std::pair{"IESNA91", 0.9},
                                     {"IESNA:LM-63-1991", 0.9},
                                     {"IESNA:LM-63-1995", 1.0},
                                     {"Some luminaire", 0.9},
                                     {"IESNA:LM-63-2002", 1.0},
                                     {"IES:LM-63-2019", 1.0}}) {
    text.head = head;
    EXPECT_NEAR(luminousFlux(read(text).photometry), factor * plain, 1e-9) << head;
  }
}

TEST(IesReader, AHemisphereEndsInAStep) {
  IesText text;
  text.verticals = range(0, 90, 10);
  EXPECT_NEAR(luminousFlux(read(text).photometry), 200 * kPi, 1e-4);
  text.verticals = range(90, 180, 10);
  const Photometry up = read(text).photometry;
  EXPECT_NEAR(luminousFlux(up), 200 * kPi, 1e-4);
  EXPECT_EQ(shine(up, {0.1, 0, -1}).r, 0);
  EXPECT_NEAR(shine(up, {0.1, 0, 1}).r, 100 / 179.0, 1e-6);
  text.verticals = range(0, 60, 10);
  EXPECT_EQ(read(text).warnings.size(), 1u);
  EXPECT_NEAR(luminousFlux(read(text).photometry), 100 * kPi, 1e-4);
}

// Candela that depends on the horizontal angle, symmetric as the range of angles says; the completed distribution must
// equal the function everywhere.
void expectCompleted(std::vector<double> horizontals, const std::function<double(double)>& candela) {
  IesText text;
  text.horizontals = std::move(horizontals);
  text.candela = [&](double, double h) { return candela(h); };
  const Photometry photometry = read(text).photometry;
  EXPECT_EQ(photometry.horizontals.front(), 0);
  EXPECT_EQ(photometry.horizontals.back(), 360);
  for (double h = 0; h <= 360; h += 22.5) {
    EXPECT_NEAR(deltalux::candela(photometry, 45, h), candela(h), 1e-9) << h;
    const Vec3 direction(std::cos(h * kDegree), std::sin(h * kDegree), -1);
    EXPECT_NEAR(shine(photometry, direction).g, candela(h) / 179, 1e-4) << h;
  }
}

TEST(IesReader, CompletesLateralSymmetry) {
  const auto cosine = [](double n) { return [n](double h) { return 200 + 100 * std::cos(n * h * kDegree); }; };
  expectCompleted(range(0, 90, 22.5), cosine(2));
  expectCompleted(range(0, 180, 22.5), cosine(1));
  expectCompleted(range(90, 270, 22.5), [](double h) { return 200 + 100 * std::sin(h * kDegree); });
  const auto skewed = [](double h) { return 200 + 100 * std::cos((h - 30) * kDegree); };
  expectCompleted(range(0, 360, 22.5), skewed);
  expectCompleted(range(0, 337.5, 22.5), skewed);
  expectCompleted(range(-180, 180, 22.5), skewed);
}

double lambertian(double v, double h) { return 1000 * std::cos(v * kDegree) * std::cos(h * kDegree); }

TEST(IesReader, TypesAAndBKeepTheFluxOfALambertianSource) {
  for (const int type : {2, 3}) {
    for (const double first : {-90.0, 0.0}) {
      IesText text;
      text.type = type;
      text.verticals = text.horizontals = range(first, 90, 2.5);
      text.candela = lambertian;
      const Photometry photometry = read(text).photometry;
      EXPECT_NEAR(luminousFlux(photometry), 1000 * kPi, 3) << type << " " << first;
      EXPECT_NEAR(shine(photometry, {1, -2, -3}).g, 1000 * 3 / std::sqrt(14.0) / 179, 0.01);
      EXPECT_NEAR(shine(photometry, {1, -2, 0.01}).g, 0, 1e-9);
    }
  }
}

TEST(IesReader, TypesAAndBPointTheirAnglesAsTheStandardSays) {
  IesText text;
  text.verticals = text.horizontals = range(-90, 90, 5);
  text.candela = [](double v, double h) { return 90 + v + 0.1 * (90 + h); };
  text.type = 2;  // V turns about y from the aim to +x, H rises from that plane to -y
  const Photometry b = read(text).photometry;
  const auto typeB = [&](double v, double h) {
    v *= kDegree, h *= kDegree;
    return shine(b, {std::cos(h) * std::sin(v), -std::sin(h), -std::cos(h) * std::cos(v)}).g * 179;
  };
  text.type = 3;  // H turns about x from the aim to -y, V rises from that plane to +x
  const Photometry a = read(text).photometry;
  const auto typeA = [&](double v, double h) {
    v *= kDegree, h *= kDegree;
    return shine(a, {std::sin(v), -std::cos(v) * std::sin(h), -std::cos(v) * std::cos(h)}).g * 179;
  };
  for (double v = -75; v <= 75; v += 30) {
    for (double h = -75; h <= 75; h += 30) {
      EXPECT_NEAR(typeB(v, h), 90 + v + 0.1 * (90 + h), 1.5) << v << " " << h;  // resampled, worst near the poles
      EXPECT_NEAR(typeA(v, h), 90 + v + 0.1 * (90 + h), 1.5) << v << " " << h;
    }
  }
}

TEST(IesReader, OnePlaneOfTypeBIsAxial) {
  IesText text;
  text.type = 2;
  text.verticals = range(-90, 90, 2.5);
  text.candela = [](double v, double) { return 1000 * std::cos(v * kDegree); };
  EXPECT_NEAR(luminousFlux(read(text).photometry), 1000 * kPi, 3);
}

TEST(IesReader, TiltIsAppliedAndSaid) {
  IesText text;
  text.tilt = "TILT=INCLUDE\n2\n3\n-10 10 90\n0.9,0.7 0.5";
  const PhotometryFile file = read(text);
  EXPECT_NEAR(luminousFlux(file.photometry), 0.8 * 400 * kPi, 1e-9);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("0.8"), std::string::npos);
  text.tilt = "tilt = include\r\n1\r\n2\r\n0 90\r\n1.0 0.95\r";
  EXPECT_NEAR(luminousFlux(read(text).photometry), 400 * kPi, 1e-9);
  EXPECT_TRUE(read(text).warnings.empty());
  text.tilt = "TILT=missing.tlt";
  EXPECT_EQ(read(text).warnings.size(), 1u);
  text.tilt = "TILT=../../etc/passwd";
  EXPECT_EQ(errorLine(text.str()), 3);
}

TEST(IesReader, NumbersBreakLinesAnywhere) {
  std::string text = IesText{}.str();
  const std::size_t numbers = text.find("NONE") + 5;
  std::string wild = text.substr(0, numbers);
  for (std::size_t i = numbers; i < text.size(); ++i)
    wild += text[i] == ' ' ? (i % 3 == 0 ? ",\r\n" : " , ") : std::string(1, text[i]);
  EXPECT_EQ(read(wild).photometry.candela, read(text).photometry.candela);
  std::string dos;
  for (const char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read(dos + "\x1a").photometry.candela, read(text).photometry.candela);
}

TEST(IesReader, OpeningInMetresNegativeWhereItIsRound) {
  IesText text;
  text.units = 1;
  text.dimensions = "-1 -1 0";
  const Vec3 opening = read(text).photometry.opening;
  EXPECT_NEAR(opening.x, -0.3048, 1e-12);
  EXPECT_NEAR(opening.y, -0.3048, 1e-12);
  EXPECT_EQ(opening.z, 0);
}

TEST(IesReader, WarnsWhenCandelasExceedTheLamps) {
  IesText text;
  text.lumens = 1250;  // the isotropic source gives 1257
  EXPECT_TRUE(read(text).warnings.empty());
  text.multiplier = 100;
  ASSERT_EQ(read(text).warnings.size(), 1u);
  EXPECT_NE(read(text).warnings[0].find("multiplier"), std::string::npos);
}

TEST(IesReader, MendsNoiseBelowZeroAndABallastFactorOfZero) {
  IesText text;
  text.candela = [](double v, double) { return v == 180 ? -0.01 : 100; };
  text.electrical = "0 1 10";
  const PhotometryFile file = read(text);
  EXPECT_EQ(file.warnings.size(), 2u);
  EXPECT_EQ(candela(file.photometry, 180, 0), 0);
}

TEST(IesReader, NegativeCandelasAreNoLight) {
  IesText text;
  text.candela = [](double v, double) { return v > 90 ? -50.0 : 100.0; };
  const PhotometryFile file = read(text);
  EXPECT_EQ(candela(file.photometry, 120, 0), 0);
  EXPECT_EQ(candela(file.photometry, 90, 0), 100);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("18 of 37 candela values are negative"), std::string::npos) << file.warnings[0];
  text.candela = [](double, double) { return -1.0; };
  EXPECT_EQ(luminousFlux(read(text).photometry), 0);
  EXPECT_EQ(read(text).warnings.size(), 2u) << "negative, and dark";
}

TEST(IesReader, LuminairesSayWhatWasMended) {
  const test::TempFolder folder;
  IesText text;
  text.candela = [](double v, double) { return v > 90 ? -50.0 : 100.0; };
  Scene scene;
  std::vector<std::string> warnings;
  addLuminaire(scene, {folder.write("lamp.ies", text.str()), {0, 0, 2}}, &warnings);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST(IesReader, ATiltFileBesideTheLuminaire) {
  const test::TempFolder folder;
  folder.write("lamp.tlt", "1\n3\n-10 10 90\n0.9 0.7 0.5\n");
  IesText text;
  text.tilt = "TILT=lamp.tlt";
  const PhotometryFile file = readPhotometry(text.str(), "lamp.ies", folder.path());
  EXPECT_NEAR(luminousFlux(file.photometry), 0.8 * 400 * kPi, 1e-9);
  ASSERT_EQ(file.warnings.size(), 1u);
  folder.write("lamp.tlt", "1\n3\n-10 10 90\n0.9 many 0.5\n");
  try {
    readPhotometry(text.str(), "lamp.ies", folder.path());
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::filesystem::path(error.file()).filename(), "lamp.tlt");
    EXPECT_EQ(error.line(), 4);
  }
}

TEST(IesReader, FrameTurnsTheDistribution) {
  IesText text;
  text.verticals = range(0, 90, 5);
  PhotometricLight light;
  light.photometry = std::make_shared<Photometry>(read(text).photometry);
  light.scale = Rgb(2, 1, 0.5);
  light.frame = glm::dmat3(Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0));  // aims along -y
  EXPECT_NEAR(radiantIntensity(light, {0, -1, 0}).r, 200 / 179.0, 1e-5);
  EXPECT_NEAR(radiantIntensity(light, {0, -1, 0}).b, 50 / 179.0, 1e-5);
  EXPECT_EQ(radiantIntensity(light, {0, 1, 0}).r, 0);
}

TEST(IesReader, RefusesGarbageWithTheLine) {
  EXPECT_EQ(errorLine(""), 0);
  EXPECT_EQ(errorLine(std::string(1000, '\0')), 0);
  const std::string good = IesText{}.str();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_EQ(errorLine(good.substr(0, good.size() / 2)), 6);       // ends early
  EXPECT_EQ(errorLine(changed("1 -1 1 37", "1 -1 0 37")), 4);     // multiplier 0
  EXPECT_EQ(errorLine(changed("1 -1 1 37", "1 -1 -3 37")), 4);    // multiplier negative
  EXPECT_EQ(errorLine(changed("1 -1 1 37", "1 -1 1 99999")), 5);  // more angles than the file holds
  EXPECT_EQ(errorLine(changed("1 -1 1 37", "1 -1 1 1e99")), 4);
  EXPECT_EQ(errorLine(changed("1 -1 1 37", "1 -1 1 2.5")), 4);
  EXPECT_EQ(errorLine(changed("1 1 2", "1 4 2")), 4);    // photometric type 4
  EXPECT_EQ(errorLine(changed("0 5 10", "0 10 5")), 6);  // angles descend
  EXPECT_EQ(errorLine(changed("0 5 10", "nan 5 10")), 6);
  EXPECT_EQ(errorLine(changed("0 5 10", "0 abc 10")), 6);
  EXPECT_EQ(errorLine(good + "7 8 9\n"), 9);  // counts too small
  IesText text;
  text.horizontals = {0, 30};
  EXPECT_EQ(errorLine(text.str()), 7);
  text.horizontals = {0};
  text.verticals = range(-90, 90, 5);
  EXPECT_EQ(errorLine(text.str()), 7);
  text.verticals = range(0, 180, 5);
  text.type = 2;
  text.horizontals = range(0, 360, 10);
  EXPECT_EQ(errorLine(text.str()), 7);
}

}  // namespace
}  // namespace deltalux
