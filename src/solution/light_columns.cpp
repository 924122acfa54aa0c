#include "solution/light_columns.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/leaf_table.hpp"
#include "hierarchy/pull.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kLeaves = 4096;  // of a task [task]
constexpr float kRounding = 1e-5f;     // of scales, relative [rounding]

bool isSky(const Light& light) { return std::holds_alternative<DomeLight>(light.emitter); }

/// `*` in the pattern stands for any characters.
bool matches(std::string_view name, std::string_view pattern) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*')
    return matches(name, pattern.substr(1)) || (!name.empty() && matches(name.substr(1), pattern));
  return !name.empty() && name.front() == pattern.front() && matches(name.substr(1), pattern.substr(1));
}

/// The pattern, or what it names with parts.
bool isNamedBy(std::string_view name, std::string_view pattern) {
  if (matches(name, pattern)) return true;
  for (std::size_t dot = name.find('.'); dot != std::string_view::npos; dot = name.find('.', dot + 1))
    if (matches(name.substr(0, dot), pattern)) return true;
  return false;
}

/// The group that a light belongs to: by itself, it is called as the light.
const std::string& groupOf(const Light& light, const std::vector<LightPattern>& patterns) {
  const auto of =
      std::ranges::find_if(patterns, [&](const LightPattern& p) { return isNamedBy(light.name, p.pattern); });
  return of == patterns.end() ? light.name : of->group;
}

/// Of a solution that need not hold the columns.
void addUp(Solution& s, const LightColumns& all, std::span<const Rgb> weights) {
  const hierarchy::LeafTable leaves(s.elements);
  const std::vector<LightColumn>& columns = all.of;
  DELTALUX_CHECK(weights.size() == columns.size(), "a weight a group");
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (!isBlack(weights[k])) shown.push_back(k);
  s.deviation.resize(leaves.size());
  parallelFor(leaves.size(), kLeaves, [&](std::size_t i) {
    hierarchy::ElementLight& l = s.elements.radiometry[leaves[i].index()];
    l.direct = l.indirect = l.particle = Rgb(0.0f);
    double variance = 0;
    for (const std::size_t k : shown) {
      const LightColumn& c = columns[k];
      l.direct += weights[k] * c.direct[i], l.indirect += weights[k] * c.indirect[i];
      l.particle += weights[k] * c.particle[i];
      const double deviation = double(gray(weights[k])) * c.deviation[i];
      variance += deviation * deviation;
    }
    s.deviation[i] = static_cast<float>(std::sqrt(variance));
  });
  hierarchy::pull(s.elements);
}

/// A copy without the light of groups, and what only an engine uses.
std::shared_ptr<Solution> withoutColumns(const Solution& s) {
  auto out = std::make_shared<Solution>();
  out->scene = s.scene, out->settings = s.settings, out->tracer = s.tracer;
  out->elements = s.elements, out->links = s.links, out->particles = s.particles;
  out->lines = s.lines, out->deviation = s.deviation;
  out->sampledScale = s.sampledScale, out->caustics = s.caustics, out->report = s.report;
  return out;
}

std::vector<LightId> allLights(const Scene& scene) {
  std::vector<LightId> all;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) all.emplace_back(i);
  return all;
}

}  // namespace

std::vector<LightGroup> groupsOf(const Scene& scene, const std::vector<LightPattern>& patterns) {
  // Skies are one group, whichever of them a pattern names.
  const auto sky = std::ranges::find_if(scene.lights, isSky);
  std::vector<LightGroup> groups;
  for (const LightId id : allLights(scene)) {
    const std::string& name = groupOf(isSky(scene[id]) ? *sky : scene[id], patterns);
    auto at = std::ranges::find(groups, name, &LightGroup::name);
    if (at == groups.end()) at = groups.insert(groups.end(), {name, {}});
    at->lights.push_back(id);
  }
  return groups;
}

std::optional<std::vector<Rgb>> weightsOf(const LightColumns& columns, const Scene& scene) {
  std::vector<Rgb> weights;
  for (std::size_t k = 0; k < columns.groups.size(); ++k) {
    const std::vector<LightId>& lights = columns.groups[k].lights;
    const std::vector<Rgb>& scales = columns.of[k].scales;
    Rgb weight(0.0f);
    for (std::size_t i = 0; i < lights.size(); ++i)
      for (int c = 0; c < 3; ++c)
        if (scales[i][c] > 0) weight[c] = std::max(weight[c], scene[lights[i]].scale[c] / scales[i][c]);
    for (std::size_t i = 0; i < lights.size(); ++i)
      for (int c = 0; c < 3; ++c)
        if (std::abs(weight[c] * scales[i][c] - scene[lights[i]].scale[c]) > kRounding * scene[lights[i]].scale[c])
          return {};
    weights.push_back(weight);
  }
  return weights;
}

std::vector<LightId> lightsMatching(const Scene& scene, std::string_view pattern) {
  std::vector<LightId> found = allLights(scene);
  std::erase_if(found, [&](LightId id) { return !isNamedBy(scene[id].name, pattern); });
  return found;
}

std::size_t LightColumns::memoryBytes() const {
  std::size_t bytes = 0;
  for (const LightColumn& c : of)
    bytes += (c.direct.capacity() + c.indirect.capacity() + c.particle.capacity()) * sizeof(Rgb) +
             c.deviation.capacity() * sizeof(float) + c.caustics.memoryBytes();
  return bytes;
}

void addUp(Solution& s, std::span<const Rgb> weights) { addUp(s, s.columns, weights); }

void validate(const LightColumns& columns, const Scene& scene, std::size_t leaves) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::logic_error(std::string("light columns: ") + what);
  };
  require(columns.groups.size() == columns.of.size(), "a column a group");
  std::set<LightId> known;
  for (const LightGroup& group : columns.groups)
    for (const LightId light : group.lights) {
      require(light.index() < scene.lights.size(), "lights are those of the scene");
      require(known.insert(light).second, "no light is in two groups");
    }
  for (std::size_t k = 0; k < columns.of.size(); ++k) {
    const LightColumn& c = columns.of[k];
    require(c.scales.size() == columns.groups[k].lights.size(), "a scale a light");
    for (const std::vector<Rgb>* values : {&c.direct, &c.indirect, &c.particle}) {
      require(values->size() == leaves, "a value a leaf");
      for (const Rgb& v : *values)
        for (int channel = 0; channel < 3; ++channel)
          require(std::isfinite(v[channel]) && v[channel] >= 0, "irradiance is finite and not negative");
    }
    require(c.deviation.size() == leaves, "a deviation a leaf");
    caustics::validate(c.caustics);
  }
}

std::vector<LightGroup> lightGroups(const SolutionView& view) {
  const Solution& s = view.get();
  if (!s.columns.empty()) return s.columns.groups;
  return {LightGroup{"all", allLights(s.scene)}};
}

GroupLight::GroupLight(const SolutionView& view)
    : whole_(view),
      alone_(view.get().columns.empty() ? nullptr : withoutColumns(view.get())),
      view_(alone_ ? SolutionView(alone_) : view) {}

void GroupLight::show(std::size_t group) {
  if (!alone_) return;
  const LightColumns& columns = whole_.get().columns;
  std::vector<Rgb> weights(columns.of.size(), Rgb(0.0f));
  weights.at(group) = Rgb(1.0f);
  for (Light& light : alone_->scene.lights) light.scale = Rgb(0.0f);
  const std::vector<LightId>& own = columns.groups[group].lights;
  for (std::size_t i = 0; i < own.size(); ++i) alone_->scene.lights[own[i].index()].scale = columns.of[group].scales[i];
  addUp(*alone_, columns, weights);
  alone_->caustics = columns.of[group].caustics;
  for (const hierarchy::ElementId e : hierarchy::elementsOf(alone_->elements, allLights(alone_->scene)))
    hierarchy::setEmission(alone_->elements, alone_->scene, e);
}

SolutionView lightOf(const SolutionView& view, std::size_t group) {
  GroupLight light(view);
  light.show(group);
  return light.view();
}

}  // namespace deltalux
