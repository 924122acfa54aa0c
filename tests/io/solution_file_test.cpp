// Solutions in files: the same to the bit when read again, or refused with one message.
#include "io/solution_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <csignal>
#include <cstring>
#include <deltalux/edit.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <deltalux/render.hpp>

#include "../../fuzz/dlx_input.hpp"
#include "hierarchy/leaf_table.hpp"
#include "solution/solution.hpp"
#include "support/run_cli.hpp"
#include "support/shared.hpp"
#include "support/solution_scenes.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

using test::TempFolder;

std::string bytesOf(const SolutionView& solution) {
  std::string bytes;
  writeSolution(solution, [&](std::string_view block) { bytes += block; });
  return bytes;
}

SolutionView solved(Scene scene, double error, SolveMethod method = SolveMethod::Lines) {
  SolveSettings settings;
  settings.error = error, settings.seed = 7, settings.method = method;
  Engine engine(std::move(scene), settings);
  engine.solve();
  return engine.solution();
}

/// Points on surfaces, and one in the air near each.
std::vector<ProbePoint> pointsIn(const Scene& scene) {
  std::vector<ProbePoint> points;
  for (const Primitive& p : scene.primitives)
    for (const double u : {0.21, 0.47, 0.83}) {
      const SurfacePoint at = samplePoint(p.shape, {u, 0.37});
      points.push_back({at.position, at.normal});
      points.push_back({at.position + 0.03 * at.normal, at.normal});
    }
  return points;
}

void expectSameProbes(const SolutionView& a, const SolutionView& b) {
  for (const bool mesh : {false, true}) {
    ProbeSettings settings;
    settings.mesh = mesh, settings.maxSamples = 512;
    const auto points = pointsIn(a.scene());
    const auto before = probe(a, points, settings), after = probe(b, points, settings);
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(before[i].irradiance, after[i].irradiance) << i;
      EXPECT_EQ(before[i].standardError, after[i].standardError) << i;
      sum += before[i].irradiance.g;
    }
    EXPECT_GT(sum, 0);
  }
}

template <class Table>
bool sameBytes(const Table& a, const Table& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

/// Lines, with the directions that are not stored, links, and particles.
void expectSameLight(const Solution& a, const Solution& b) {
  EXPECT_GT(a.lines.size() + a.links.size(), 0u);
  EXPECT_TRUE(sameBytes(a.links.all, b.links.all));
  EXPECT_EQ(a.lines.hash(a.elements.key), b.lines.hash(b.elements.key));
  ASSERT_EQ(a.lines.of.size(), b.lines.of.size());
  for (std::size_t i = 0; i < a.lines.of.size(); ++i) {
    const hierarchy::ElementId leaf(i);
    EXPECT_TRUE(sameBytes(a.lines.endsOf(leaf), b.lines.endsOf(leaf)));
    EXPECT_TRUE(sameBytes(a.lines.codesOf(leaf), b.lines.codesOf(leaf)));
    EXPECT_TRUE(sameBytes(a.lines.exceptions.at(leaf), b.lines.exceptions.at(leaf)));
    EXPECT_EQ(a.lines.at(leaf).covered, b.lines.at(leaf).covered);
  }
  EXPECT_TRUE(sameBytes(a.elements.radiometry, b.elements.radiometry));
  EXPECT_TRUE(sameBytes(a.deviation, b.deviation));
  EXPECT_EQ(a.particles.hash(), b.particles.hash());
}

void expectSameBack(const SolutionView& solution) {
  const TempFolder folder;
  saveSolution(folder / "s.dlx", solution);
  const SolutionView loaded = loadSolution(folder / "s.dlx");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.dlx"});
  EXPECT_TRUE(bytesOf(solution) == bytesOf(loaded)) << "what is stored is what was";
  EXPECT_NO_THROW(validate(loaded.get().elements));
  EXPECT_NO_THROW(validate(loaded.get().links, loaded.get().elements));
  expectSameLight(solution.get(), loaded.get());
  expectSameProbes(solution, loaded);
}

TEST(SolutionFile, CornellComesBackToTheBit) {
  for (const SolveMethod method : {SolveMethod::Lines, SolveMethod::Paper}) {
    expectSameBack(solved(loadScene({test::bundledScene("cornell/cornell.rad")}).scene, 0.2, method));
    expectSameBack(solved(loadScene({test::bundledScene("cornell-caustic/cornell-caustic.rad")}).scene, 0.4, method));
    expectSameBack(solved(test::oneOfEverything(), 0.4, method));
  }
}

TEST(SolutionFile, LoadedSolutionsRenderTheSame) {
  const SolutionView solution = solved(loadScene({test::bundledScene("cornell/cornell.rad")}).scene, 0.4);
  const SolutionView loaded = readSolution(bytesOf(solution), "s.dlx");
  View view;
  view.position = {0.278, 0.273, -0.8}, view.direction = {0, 0, 1}, view.up = {0, 1, 0};
  RenderSettings settings;
  settings.width = settings.height = 16, settings.samplesPerPixel = 2, settings.shadowRays = 2;
  const Image before = render(solution, view, settings), after = render(loaded, view, settings);
  EXPECT_TRUE(sameBytes(before.pixels, after.pixels));
  EXPECT_GT(gray(before.at(8, 8)), 0);
}

TEST(SolutionFile, StoredLinesArePacked) {
  const SolutionView solution = solved(loadScene({test::bundledScene("cornell/cornell.rad")}).scene, 0.2);
  // 17 bits of a leaf's number, 9 of how far it goes, and the leaves themselves: of 8 bytes in memory.
  EXPECT_LT(bytesOf(solution).size(), 4.5 * static_cast<double>(solution.get().lines.size()) + 150000);
}

TEST(SolutionFile, OneOfEverythingComesBackToTheBit) {
  const SolutionView solution = solved(test::oneOfEverything(), 0.4);
  const SolutionView loaded = readSolution(bytesOf(solution), "s.dlx");
  const Scene& scene = loaded.scene();
  EXPECT_EQ(scene.metresPerUnit, 0.3048);
  EXPECT_EQ(loaded.settings().seed, 7u);
  EXPECT_EQ(loaded.settings().error, 0.4);
  EXPECT_EQ(loaded.report().counts.lines, solution.report().counts.lines);
  EXPECT_EQ(loaded.report().energy.emittedW, solution.report().energy.emittedW);
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_EQ(scene.views[0].name, "door");
  EXPECT_EQ(scene.views[0].kind, View::Kind::Parallel);
  std::vector<const Photometry*> measured;
  for (const Light& light : scene.lights)
    if (const auto* l = std::get_if<PhotometricLight>(&light.emitter)) measured.push_back(l->photometry.get());
  ASSERT_EQ(measured.size(), 2u);
  EXPECT_EQ(measured[0], measured[1]) << "stored once, shared again";
  EXPECT_EQ(measured[0]->candela.size(), 9u);
  EXPECT_EQ(measured[0]->opening, Vec3(0.1, 0.2, 0));
}

TEST(SolutionFile, OriginEfficacyAndWhatIsOnlySeenComeBack) {
  Scene scene = test::oneOfEverything();
  scene.origin = {5200000, -4100000, 12}, scene.luminousEfficacy = 683;
  scene.backdrops.push_back(std::get<DomeLight>(scene.lights.back().emitter));
  const MaterialId screen =
      test::addMaterial(scene, "screen", test::lambert(0), Emission{Rgb(3.0f), false, {}, {}, true});
  test::addPolygon(scene, screen, {{1, 1, 0.5}, {1.2, 1, 0.5}, {1.2, 1.2, 0.5}});
  const SolutionView solution = solved(scene, 0.6);
  const SolutionView loaded = readSolution(bytesOf(solution), "s.dlx");
  EXPECT_TRUE(bytesOf(solution) == bytesOf(loaded));
  EXPECT_EQ(loaded.scene().origin, scene.origin);
  EXPECT_EQ(loaded.scene().luminousEfficacy, 683);
  EXPECT_EQ(loaded.scene().backdrops, scene.backdrops);
  EXPECT_EQ(loaded.scene()[screen].emission, scene[screen].emission);
}

TEST(SolutionFile, WhatEditsDidComesBackToo) {
  Scene scene = test::oneOfEverything();
  Mat4 up(1.0);
  up[3].z = 0.25;
  const AppliedEdit moved = applyEdit(scene, TransformObject{"scene.part", up});
  applyEdit(scene, SwitchLight{scene.lights.back().name, false});
  const SolutionView solution = solved(scene, 0.6);
  const SolutionView loaded = readSolution(bytesOf(solution), "s.dlx");
  EXPECT_TRUE(bytesOf(solution) == bytesOf(loaded));
  Scene back = loaded.scene();
  applyEdit(back, moved.inverse);
  applyEdit(back, SwitchLight{scene.lights.back().name, true});
  EXPECT_EQ(bounds(back.primitives[2].shape).upper, bounds(test::oneOfEverything().primitives[2].shape).upper);
  EXPECT_EQ(back.lights.back().scale, Rgb(1.0f, 0.5f, 0.25f));
}

TEST(SolutionFile, AnEmptySceneHasASolutionToo) {
  const SolutionView loaded = readSolution(bytesOf(solved(Scene{}, 0.5)), "empty.dlx");
  EXPECT_TRUE(loaded.report().converged);
  EXPECT_EQ(loaded.get().elements.size(), 0u);
}

/// The message with which `bytes` are refused; empty when they are read.
std::string refusal(std::string_view bytes) {
  try {
    readSolution(bytes, "s.dlx");
    return "";
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "s.dlx");
    EXPECT_FALSE(error.hint().empty());
    return error.message();
  }
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(SolutionFile, AnyByteFlippedIsNoticed) {
  std::string bytes = fuzz::dlxOf("");
  ASSERT_EQ(refusal(bytes), "");
  // All of the head and of the frames around sections; of payloads, one byte in 61.
  for (std::size_t i = 0; i < bytes.size(); i += i < 600 || i + 600 > bytes.size() ? 1 : 61) {
    for (const char flip : {'\x01', '\x80'}) {
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      EXPECT_NE(refusal(bytes), "") << "byte " << i;
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
    }
  }
}

TEST(SolutionFile, TruncationIsNoticedEverywhere) {
  const std::string bytes = fuzz::dlxOf("");
  for (std::size_t n = 0; n < bytes.size(); n += n < 200 ? 1 : 97) {
    const std::string why = refusal(std::string_view(bytes).substr(0, n));
    EXPECT_TRUE(contains(why, n == 0 ? "not a deltalux solution" : "truncated")) << n << ": " << why;
  }
  EXPECT_TRUE(contains(refusal(bytes + "x"), "bytes follow"));
}

TEST(SolutionFile, OtherFilesAndOtherVersionsAreToldApart) {
  EXPECT_TRUE(contains(refusal("#?RADIANCE\n"), "not a deltalux solution"));
  EXPECT_TRUE(contains(refusal("{\"asset\": {}}"), "not a deltalux solution"));
  std::string bytes = fuzz::dlxOf("");
  const auto reseal = [&](std::uint32_t version) {
    std::memcpy(bytes.data() + 8, &version, 4);
    const auto sum = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const unsigned char*>(bytes.data()), 24));
    std::memcpy(bytes.data() + 24, &sum, 4);
  };
  reseal(kFormatVersion + 1);
  EXPECT_TRUE(contains(refusal(bytes), "is of solution format " + std::to_string(kFormatVersion + 1)));
  reseal(0);
  EXPECT_TRUE(contains(refusal(bytes), "is of solution format 0"));
  reseal(kFormatVersion);
  EXPECT_EQ(refusal(bytes), "");
}

/// A change of one section at an offset, as fuzz/dlx_input.hpp reads it.
std::string change(int section, std::size_t at, const std::string& bytes) {
  const char head[5] = {static_cast<char>(section), static_cast<char>(at & 255), static_cast<char>(at >> 8 & 255),
                        static_cast<char>(at >> 16), static_cast<char>(bytes.size())};
  return std::string(head, 5) + bytes;
}

TEST(SolutionFile, HostileLengthsAllocateLittle) {
  const std::string huge(8, '\x7f');
  ASSERT_EQ(refusal(fuzz::dlxOf("")), "");  // solving, packing and reading what is sound take what they take
  const std::uint64_t before = peakResidentBytes();
  for (int section = 1; section < 4; ++section)
    for (std::size_t at = 0; at < 400; ++at) {
      const std::string why = refusal(fuzz::dlxOf(change(section, at, huge)));
      EXPECT_TRUE(why == "" || contains(why, "damaged") || contains(why, "version") || contains(why, "hold together"))
          << why;
    }
  EXPECT_LT(peakResidentBytes(), before + (64u << 20));
}

TEST(SolutionFile, DamagedLinesAreRefused) {
  const auto refused = [](const std::string& input) {
    const std::string why = refusal(fuzz::dlxOf(input));
    EXPECT_TRUE(why == "" || contains(why, "damaged") || contains(why, "version") || contains(why, "hold together"))
        << why;
    return why;
  };
  ASSERT_EQ(refused(""), "");
  const std::size_t lines = 5, particles = 4, deviations = 6;  // sections
  const std::string& payload = fuzz::smallSolution()[lines].payload;
  std::uint64_t firsts = 0;
  std::memcpy(&firsts, payload.data(), 8);
  const std::size_t ends = 12 + 4 * firsts + 12;  // behind a count and a record size
  EXPECT_TRUE(contains(refused(change(lines, ends, "\xe0\xff\xff\x7f")), "lines: end on leaves"));
  EXPECT_TRUE(contains(refused(change(lines, 12, "\x01")), "do not agree"));
  EXPECT_TRUE(contains(refused(change(lines, 12 + 4 * (firsts - 1), "\x01\x01")), "do not agree"));
  for (const std::size_t section : {lines, particles, deviations})
    for (std::size_t at = 0; at < 4000; at += 37) refused(change(static_cast<int>(section), at, "\xf3\x7e\xff"));
  // What a section is packed to; one of two bytes may be what is there.
  for (std::size_t at = 0; at < 40; ++at) {
    const int packed = 128 + static_cast<int>(lines);
    EXPECT_NE(refused(change(packed, at, "\x55")) + refused(change(packed, at, "\xaa")), "") << at;
  }
}

TEST(SolutionFile, IndicesOutOfRangeAreRefused) {
  const auto& sections = fuzz::smallSolution();
  const std::string far = "\xf0\xff\xff\x7f";
  // The first link's receiver, behind a count and a record size; the first element's child.
  EXPECT_TRUE(
      contains(refusal(fuzz::dlxOf(change(3, 12 + offsetof(hierarchy::Link, receiver), far), SolveMethod::Paper)),
               "does not hold together"));
  EXPECT_TRUE(contains(refusal(fuzz::dlxOf(change(2, 12 + offsetof(hierarchy::ElementTopology, firstChild), far))),
                       "does not hold together"));
  EXPECT_TRUE(contains(refusal(fuzz::dlxOf(change(2, 8, "\x7f"))), "another version of deltalux"));
  std::vector<fuzz::StoredSection> fewer = sections;
  fewer.pop_back();
  EXPECT_TRUE(contains(refusal(fuzz::sealed(fuzz::packed(fewer))), "sections"));
  fewer = sections, std::swap(fewer[2], fewer[3]);
  EXPECT_TRUE(contains(refusal(fuzz::sealed(fuzz::packed(fewer))), "sections"));
}

TEST(SolutionFile, EveryCaseOfTheFuzzerIsReadOrRefused) {
  std::size_t cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "fuzz/corpus/dlx")) {
    const std::string input = test::readText(entry.path());
    refusal(input);
    refusal(fuzz::dlxOf(input));
    refusal(fuzz::dlxOf(input, SolveMethod::Paper));
    ++cases;
  }
  EXPECT_GT(cases, 3u);
}

TEST(SolutionFile, WhatCannotBeWrittenLeavesTheOldFile) {
  const TempFolder folder;
  const SolutionView solution = readSolution(fuzz::dlxOf(""), "small.dlx");
  EXPECT_THROW(saveSolution(folder / "none/s.dlx", solution), OutputError);
  EXPECT_THROW(saveSolution("/dev/full", solution), OutputError);
  folder.write("s.dlx", "old");
  // A file size limit stands for a full disk.
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlim_t allowed = limit.rlim_cur;
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  limit.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THROW(saveSolution(folder / "s.dlx", solution), OutputError);
  limit.rlim_cur = allowed;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, ignored);
  EXPECT_EQ(test::readText(folder / "s.dlx"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.dlx"});
  saveSolution(folder / "s.dlx", solution);
  EXPECT_EQ(refusal(test::readText(folder / "s.dlx")), "");
}

TEST(SolutionFile, MissingFilesAndFoldersAreInputErrors) {
  const TempFolder folder;
  EXPECT_THROW(loadSolution(folder / "none.dlx"), InputError);
  EXPECT_THROW(loadSolution(folder.path()), InputError);
  EXPECT_THROW(loadScene({folder.write("s.dlx", "")}), InputError);
}

}  // namespace
}  // namespace deltalux
