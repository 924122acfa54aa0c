// deltalux design: what lamps are to be dimmed to, and where one of them is to be, for illuminances that are wanted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deltalux/design.hpp>
#include <deltalux/edit_io.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/error.hpp>
#include <deltalux/light_groups.hpp>
#include <deltalux/output.hpp>
#include <deltalux/points.hpp>
#include <deltalux/render.hpp>
#include <numbers>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {

constexpr double kMet = 0.05;          // of a target: nearer than that it is met
constexpr int kScan = 4, kNear = 8;    // positions that are tried all along a line, and about the best of them
constexpr int kMostSamples = 1 << 15;  // lines or shadow rays of a point

struct DesignOptions {
  SolutionSource source;
  RunOptions run;
  std::string targets, output, along;
};

/// A lamp and how far it may be moved from where it is.
struct Along {
  std::string light;
  Vec3 most{0.0};
};

Along alongOf(const std::string& text) {
  Along along;
  const std::size_t at = text.find('=');
  char rest = 0;
  if (at == 0 || at == std::string::npos ||
      std::sscanf(text.c_str() + at + 1, "%lf,%lf,%lf%c", &along.most.x, &along.most.y, &along.most.z, &rest) != 3)
    throw CLI::ValidationError("--along " + text + ": not LIGHT=DX,DY,DZ");
  along.light = text.substr(0, at);
  return along;
}

/// The column `target` [lux].
std::vector<double> targetsOf(const PointTable& table, const std::string& file) {
  const std::optional<std::size_t> column = table.column("target");
  if (!column)
    throw InputError(file, 0, "has no column 'target'", "add the illuminance [lux] that each point is to have");
  std::vector<double> targets;
  for (const std::vector<std::string>& row : table.rows) {
    const std::string& field = row[*column];
    std::size_t used = 0;
    double target = -1;
    try {
      target = std::stod(field, &used);
    } catch (const std::exception&) {
    }
    if (used != field.size() || !std::isfinite(target) || target < 0)
      throw InputError(file, 0, "'" + field + "' is no illuminance", "the column 'target' is in lux, not negative");
    targets.push_back(target);
  }
  return targets;
}

/// Nobody dims the sun.
bool isDaylight(const Scene& scene, const LightGroup& group) {
  return std::ranges::any_of(group.lights, [&](LightId light) {
    return std::holds_alternative<SunLight>(scene[light].emitter) ||
           std::holds_alternative<DomeLight>(scene[light].emitter);
  });
}

/// Lamps that are dimmed together.
struct Dimmer {
  std::string name;
  std::vector<ColourLight> undimmed;  // its lamps at their own scales
};

/// One arrangement of the lamps, and the best that dimming makes of it.
struct Tried {
  std::vector<Dimmer> dimmers;
  Dimmed dimmed;      // of those; what is reached has the daylight in it
  double misses = 0;  // sum of squared differences [lux^2]
};

/// What dims the lamps so. Parts come after what they are parts of, which a name also means.
std::vector<ColourLight> editsThatDim(const Tried& tried) {
  std::vector<ColourLight> edits;
  for (std::size_t d = 0; d < tried.dimmers.size(); ++d)
    for (ColourLight edit : tried.dimmers[d].undimmed) {
      edit.rgb *= static_cast<float>(tried.dimmed.weights[d]);
      edits.push_back(std::move(edit));
    }
  std::ranges::stable_sort(edits, {}, [](const ColourLight& e) { return e.light.size(); });
  return edits;
}

class Designer {
 public:
  Designer(Engine& engine, const PointTable& table, std::vector<double> targets, std::uint64_t seed, Progress& progress)
      : engine_(engine), table_(table), targets_(std::move(targets)), progress_(progress) {
    settings_.error = meterError(engine.solution()), settings_.maxSamples = kMostSamples;
    settings_.seed = seed;
  }

  Tried dim() const {
    const SolutionView solution = engine_.solution();
    const Scene& scene = solution.scene();
    const std::vector<LightGroup> groups = lightGroups(solution);
    const std::vector<ProbePoint> points = pointsIn(scene, table_);
    Tried tried;
    std::vector<std::vector<double>> brings;  // by dimmer
    std::vector<double> daylight(points.size(), 0.0), wanted = targets_;
    const std::vector<std::vector<ProbeResult>> measured = probeByLight(solution, points, settings_, &progress_);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      std::vector<double> lux = luxOf(measured[g], scene.luminousEfficacy);
      if (isDaylight(scene, groups[g])) {
        const double weight = gray(scene[groups[g].lights.front()].scale);
        for (std::size_t p = 0; p < points.size(); ++p) daylight[p] += weight * lux[p], wanted[p] -= weight * lux[p];
        continue;
      }
      brings.push_back(std::move(lux));
      const SolutionView alone = lightOf(solution, g);
      Dimmer& dimmer = tried.dimmers.emplace_back(Dimmer{groups[g].name, {}});
      for (const LightId light : groups[g].lights)
        dimmer.undimmed.push_back({scene[light].name, alone.scene()[light].scale});
    }
    tried.dimmed = bestDimming(brings, wanted);
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double off = (tried.dimmed.reached[p] += daylight[p]) - targets_[p];
      tried.misses += off * off;
    }
    return tried;
  }

  /// Moves the lamp to the share of its line at which least is missed: all along it, then about the best.
  std::pair<double, Tried> dimAlong(const Along& along) {
    double at = 0;
    Tried now = dim();
    std::vector<std::pair<double, double>> known{{0.0, now.misses}};
    const auto tryAt = [&](double share) {
      engine_.apply(MoveLight{along.light, (share - at) * along.most});
      at = share;
      engine_.update(&progress_);
      now = dim();
      known.emplace_back(share, now.misses);
      return now.misses;
    };
    for (int i = 1; i <= kScan; ++i) tryAt(static_cast<double>(i) / kScan);
    const auto least = [&] { return *std::ranges::min_element(known, {}, &std::pair<double, double>::second); };
    double low = std::max(0.0, least().first - 1.0 / kScan), high = std::min(1.0, least().first + 1.0 / kScan);
    constexpr double kGolden = 1 / std::numbers::phi;  // [Kiefer53]
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low), atA = tryAt(a), atB = tryAt(b);
    for (int i = 2; i < kNear; ++i) {
      if (atA < atB)
        high = b, b = a, atB = atA, a = high - kGolden * (high - low), atA = tryAt(a);
      else
        low = a, a = b, atA = atB, b = low + kGolden * (high - low), atB = tryAt(b);
    }
    const double best = least().first;
    if (best != at) tryAt(best);
    return {best, std::move(now)};
  }

 private:
  Engine& engine_;
  const PointTable& table_;
  std::vector<double> targets_;
  ProbeSettings settings_;
  Progress& progress_;
};

std::string nameOf(const PointTable& table, std::size_t row) {
  const std::optional<std::size_t> column = table.column("name");
  return column ? table.rows[row][*column] : fmt::format("point {}", row + 1);
}

void describe(const Run& run, const Tried& tried, const PointTable& table, const std::vector<double>& targets) {
  for (std::size_t d = 0; d < tried.dimmers.size(); ++d)
    run.say(fmt::format("{}: {:.3f}", tried.dimmers[d].name, tried.dimmed.weights[d]));
  std::size_t missed = 0;
  for (std::size_t p = 0; p < targets.size(); ++p) {
    const double reached = tried.dimmed.reached[p];
    if (std::abs(reached - targets[p]) <= kMet * targets[p]) continue;
    ++missed;
    run.say(fmt::format("cannot be met: {} wants {:.4g} lux and gets {:.4g}", nameOf(table, p), targets[p], reached));
  }
  if (missed == 0) run.say(fmt::format("all {} targets are met within {:.0f} %", targets.size(), 100 * kMet));
}

void runDesign(DesignOptions& options) {
  Run run("design", options.run);
  checkWritable(options.output);
  const PointTable table = readPoints(options.targets);
  const std::vector<double> targets = targetsOf(table, options.targets);
  const std::optional<Along> along = options.along.empty() ? std::nullopt : std::optional(alongOf(options.along));
  options.source.wantByLight();
  std::vector<EditStep> steps;
  Tried best;
  {
    ProgressPrinter progress(options.run.progressStyle());
    Engine engine(options.source.load(run, options.run, progress, [&](const Scene& scene) {
      if (!along) return;
      Scene lit = scene;
      addAreaLights(lit);
      validateEdit(lit, MoveLight{along->light, along->most});
    }));
    Designer designer(engine, table, targets, options.run.seed, progress);
    if (along) {
      auto [share, tried] = designer.dimAlong(*along);
      steps.emplace_back(Edit(MoveLight{along->light, share * along->most}));
      best = std::move(tried);
      run.say(fmt::format("{} is moved by {:.4g} {:.4g} {:.4g}", along->light, share * along->most.x,
                          share * along->most.y, share * along->most.z));
    } else {
      best = designer.dim();
    }
    for (const ColourLight& edit : editsThatDim(best)) steps.emplace_back(Edit(edit));
  }
  saveEdits(options.output, steps);
  describe(run, best, table, targets);
  run.finish();
}

}  // namespace

void addDesignCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("design", "What lamps are to be dimmed to for illuminances that are wanted");
  const auto options = std::make_shared<DesignOptions>();
  options->source.add(*command);
  command->add_option("--targets", options->targets, "Points and what they are to have: x,y,z,nx,ny,nz,target [lux]")
      ->type_name("T.csv")
      ->required();
  command->add_option("--along", options->along, "Where that lamp is best, from where it is as far as that")
      ->type_name("LIGHT=DX,DY,DZ");
  command->add_option("-o", options->output, "Where the edits go that dim, and move, the lamps")
      ->type_name("E.json")
      ->required();
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runDesign(*options); });
}

}  // namespace deltalux::cli
