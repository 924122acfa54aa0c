// cie171_bench ERROR... (after --only CASE: that case alone)
//
// The analytical cases of CIE 171 [CIE 171, 5.2 to 5.14], solved at each error that is asked for and read at the
// standard's points, as CSV rows. Daylight cases run under all 16 skies, behind glass, where particles take their time,
// under two; those with ground and masks also with these cut into tiles of a metre ("tiled"). Errors are over all
// points and skies, work is the mean of a solve. `max_error`, `mean_error`: of light meters at the points, `mesh_*`: of
// the leaves that the points lie on; both relative to the reference, or, where that is below a hundredth of the case's
// largest, to that hundredth (points in full shadow of 5.13 and 5.14).
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/render.hpp>
#include <numeric>
#include <stdexcept>

#include "run_main.hpp"
#include "stopwatch.hpp"
#include "support/cie171/cases.hpp"

namespace deltalux::bench {
namespace {

using test::cie171::Case;

constexpr double kMeterShare = 0.25;  // of the error asked for, the standard error of a reading: as `deltalux probe`
constexpr int kMostSamples = 1 << 17;

struct Errors {
  double largest = 0, sum = 0;

  void add(const std::vector<double>& errors) {
    for (const double e : errors) largest = std::max(largest, e), sum += e;
  }
};

/// Of one case at one error, over all its skies.
struct Row {
  double asked = 0;
  std::size_t solves = 0, values = 0;
  Errors meters, mesh;
  std::uint64_t lines = 0, rays = 0;
  double seconds = 0, probeSeconds = 0;

  void add(const Case& c) {
    SolveSettings settings;
    settings.error = asked;
    Engine engine(c.scene, settings);
    const SolveReport report = engine.solve();
    ProbeSettings reading;
    reading.error = kMeterShare * asked, reading.maxSamples = kMostSamples;
    const Stopwatch watch;
    meters.add(relativeErrors(c, probe(engine.solution(), c.points, reading)));
    probeSeconds += watch.wall();
    reading.mesh = true;
    mesh.add(relativeErrors(c, probe(engine.solution(), c.points, reading)));
    ++solves, values += c.expected.size();
    lines += report.counts.lines, rays += report.counts.raysVisibility + report.counts.raysParticles;
    seconds += report.times.total;
  }

  void print(const Case& c) const {
    const auto mean = [&](const Errors& e) { return e.sum / double(values); };
    fmt::print("{},{},{},{},{},{:.2g},{:.2g},{:.2g},{:.2g},{},{},{:.3g},{:.3g}\n", c.name, c.variant, solves,
               c.expected.size(), asked, meters.largest, mean(meters), mesh.largest, mean(mesh), lines / solves,
               rays / solves, seconds / double(solves), probeSeconds / double(solves));
    std::fflush(stdout);
  }
};

std::vector<int> skiesOf(const test::cie171::Daylight& d) {
  using test::cie171::Facet;
  const bool glazed =
      std::any_of(d.facets.begin(), d.facets.end(), [](const Facet& f) { return f.kind == Facet::Kind::Pane; });
  if (glazed) return {1, 12};
  std::vector<int> all(test::cie171::kSkies);
  std::iota(all.begin(), all.end(), 1);
  return all;
}

/// `skies`: the case under each.
void measure(const std::vector<Case>& skies, std::vector<double> errors) {
  fmt::print(stderr, "cie171: {} {}\n", skies[0].name, skies[0].variant);
  for (const double error : errors) {
    Row row;
    row.asked = error;
    for (const Case& c : skies) row.add(c);
    row.print(skies[0]);
  }
}

int run(std::vector<std::string> a) {
  std::string only;
  if (a.size() >= 2 && a[0] == "--only") only = a[1], a.erase(a.begin(), a.begin() + 2);
  if (a.empty()) throw std::runtime_error("usage: ERROR..., after --only CASE for one");
  std::vector<double> errors;
  for (const std::string& error : a) errors.push_back(std::atof(error.c_str()));
  fmt::print(
      "case,variant,skies,points,asked,max_error,mean_error,mesh_max_error,mesh_mean_error,lines,rays,seconds,"
      "probe_seconds\n");
  for (const Case& c : test::cie171::electricCases())
    if (only.empty() || only == c.name) measure({c}, errors);
  for (const test::cie171::Daylight& d : test::cie171::daylightVariants()) {
    if (!only.empty() && only != d.name) continue;
    std::vector<Case> skies;
    for (const int sky : skiesOf(d)) skies.push_back(daylightCase(d, sky));
    measure(skies, errors);
    if (d.roof) continue;
    for (Case& c : skies) c.variant += " tiled", cutIntoTiles(c, d);
    measure(skies, errors);
  }
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) { return deltalux::bench::runMain("cie171_bench", argc, argv, deltalux::bench::run); }
