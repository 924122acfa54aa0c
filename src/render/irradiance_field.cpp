#include "render/irradiance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "base/tuning.hpp"
#include "hierarchy/patch.hpp"
#include "render/linear_fit.hpp"
#include "render/tuning.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kBlock = 512;  // [task]

bool isDark(const LeafIrradiance& E) { return isBlack(E.direct) && isBlack(E.indirect); }

float lightOf(const LeafIrradiance& E) { return maxChannel(E.direct + E.indirect); }

float difference(const LeafIrradiance& a, const LeafIrradiance& b) {
  return maxChannel(glm::abs(a.direct - b.direct) + glm::abs(a.indirect - b.indirect) +
                    glm::abs(a.particle - b.particle));
}

bool disagree(const Rgb& a, const Rgb& b) {
  const float x = gray(a), y = gray(b);
  return std::abs(x - y) > deltalux::tuning::kChangeMatters * std::max(x, y);
}

}  // namespace

IrradianceField::IrradianceField(const hierarchy::Elements& elements, const Scene& scene,
                                 const tracing::RayTracer& tracer, const std::vector<LeafIrradiance>& values,
                                 float noise, const IrradianceField* before, float tolerance)
    : elements_(elements),
      scene_(scene),
      tracer_(tracer),
      noise_(noise),
      sites_(elements, scene, before ? &before->sites_ : nullptr) {
  if (before) generation_ = before->generation_ + 1;
  if (before && before->noise_ != noise) before = nullptr;
  gather(values, before, tolerance);
  relate(before);
  fill(Filled, before, [&](std::size_t i) { return filled(i); });
  fill(Mended, before, [&](std::size_t i) { return mended(i); });
  if (noise > 0) {
    fill(WithoutOutliers, before, [&](std::size_t i) { return withoutOutliers(i); });
    for (int pass = 0; pass < tuning::kQuietPasses; ++pass)
      fill(static_cast<Stage>(Quiet + pass), before,
           [&](std::size_t i) { return quiet(i, stages_[static_cast<std::size_t>(Quiet + pass - 1)]); });
  } else {
    stages_.back() = stages_[Mended], differs_.back() = differs_[Mended];
  }
  fitAll(before);
}

void IrradianceField::gather(const std::vector<LeafIrradiance>& values, const IrradianceField* before,
                             float tolerance) {
  std::vector<LeafIrradiance>& stage = stages_[Gathered];
  stage.resize(sites_.size()), coverage_.resize(sites_.size());
  differs_[Gathered].assign(sites_.size(), 1);
  const float floor = tolerance > 0 ? floorOf([&](std::size_t i) { return lightOf(values[leafOf(i).index()]); }) : 0.0f;
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    const hierarchy::ElementId leaf = sites_[i].leaf;
    const std::uint32_t was = before ? sites_.before(i) : LeafSites::kNone;
    stage[i] = values[leaf.index()];
    coverage_[i] = elements_.shape(leaf).exposed;
    if (was == LeafSites::kNone) return;
    const LeafIrradiance& held = before->stages_[Gathered][was];
    if (tolerance > 0 && difference(stage[i], held) < tolerance * std::max(lightOf(held), floor)) stage[i] = held;
    differs_[Gathered][i] = stage[i] != held || coverage_[i] != before->coverage_[was];
  });
}

bool IrradianceField::disagreeing(std::size_t home, std::size_t other) const {
  const LeafIrradiance &a = stages_[Gathered][home], &b = stages_[Gathered][other];
  return disagree(a.indirect, b.indirect) || disagree(a.direct, b.direct);
}

bool IrradianceField::oneIsHollow(std::size_t home, std::size_t other) const {
  const auto primitive = [&](std::size_t site) { return elements_.domain[sites_[site].leaf.index()].primitive; };
  return isDark(stages_[Gathered][home]) != isDark(stages_[Gathered][other]) && primitive(home) != primitive(other);
}

void IrradianceField::relate(const IrradianceField* before) {
  begin_.assign(sites_.size() + 1, 0);
  torn_.assign(sites_.size(), 0), end_.assign(sites_.size(), 0);
  exposed_.assign(sites_.size(), -1.0f);
  related_.assign(sites_.size(), 1);
  sights_.assign(sites_.nearCount(), Sight::Unknown);
  neighbours_.resize(sites_.nearCount() + sites_.size());
  for (std::size_t i = 0; i < sites_.size(); ++i)
    begin_[i + 1] = static_cast<std::uint32_t>(sites_.nearBegin(i + 1) + i + 1);
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    const auto near = sites_.near(i);
    Sight* const sights = sights_.data() + sites_.nearBegin(i);
    const std::uint32_t was = before ? sites_.before(i) : LeafSites::kNone;
    const bool known = was != LeafSites::kNone && !sites_.disturbed(i);
    if (known) {
      std::copy_n(before->sights_.data() + before->sites_.nearBegin(was), near.size(), sights);
      exposed_[i] = before->exposed_[was];
    }
    std::uint32_t* joined = neighbours_.data() + begin_[i];
    *joined++ = static_cast<std::uint32_t>(i);
    std::vector<std::uint32_t> torn;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (oneIsHollow(i, near[k])) continue;
      const bool asks = sites_[i].support.flat() && disagreeing(i, near[k]);
      if (asks && sights[k] == Sight::Unknown)
        sights[k] = inSight(sites_[i].center, sites_[i].leaf, sites_[near[k]].leaf) ? Sight::Clear : Sight::Blocked;
      if (asks && sights[k] == Sight::Blocked)
        torn.push_back(near[k]);
      else
        *joined++ = near[k];
    }
    torn_[i] = static_cast<std::uint32_t>(joined - neighbours_.data());
    end_[i] = torn_[i] + static_cast<std::uint32_t>(torn.size());
    std::ranges::copy(torn, joined);
    // Numbers may have moved, their order has not.
    const bool sameOrder =
        was != LeafSites::kNone && torn_[i] - begin_[i] == before->torn_[was] - before->begin_[was] &&
        end_[i] - begin_[i] == before->end_[was] - before->begin_[was] &&
        std::equal(neighbours_.begin() + begin_[i], neighbours_.begin() + end_[i],
                   before->neighbours_.begin() + before->begin_[was], before->neighbours_.begin() + before->end_[was],
                   [&](std::uint32_t a, std::uint32_t b) { return sites_[a].leaf == before->sites_[b].leaf; });
    related_[i] = !sameOrder || (!torn.empty() && !known);
  });
}

bool IrradianceField::inSight(const Vec3f& p, hierarchy::ElementId home, hierarchy::ElementId other) const {
  const hierarchy::ElementGeometry &a = elements_.shape(home), &b = elements_.shape(other);
  const float lift = float(hierarchy::tuning::kTouching) * std::sqrt(std::min(a.area, b.area));
  const Vec3f from = p + lift * a.normal, to = b.center + lift * b.normal;
  tracing::Ray ray;
  ray.origin = from;
  ray.tFar = glm::length(to - from);
  ray.direction = (to - from) / std::max(ray.tFar, 1e-30f);
  return !tracer_.occluded(ray);
}

float IrradianceField::exposed(hierarchy::ElementId leaf) const {
  int seen = 0;
  for (std::uint32_t k = 0; k < deltalux::tuning::kPilots; ++k) {
    const UnitPair u = scrambledSobol(k, elements_.key[leaf.index()]);
    seen += inSight(hierarchy::samplePatch(elements_, scene_, leaf, u.x, u.y).position, leaf, leaf);
  }
  return static_cast<float>(std::max(seen, 1)) / float(deltalux::tuning::kPilots);
}

bool IrradianceField::isLittleExposed(std::size_t site) const {
  return coverage_[site] < deltalux::tuning::kChangeMatters;
}

template <class Value>
void IrradianceField::fill(Stage stage, const IrradianceField* before, const Value& value) {
  std::vector<LeafIrradiance>& result = stages_[stage];
  const std::vector<char>& changed = differs_[static_cast<std::size_t>(stage) - 1];
  result.resize(sites_.size());
  differs_[stage].assign(sites_.size(), 1);
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    const std::uint32_t was = before ? sites_.before(i) : LeafSites::kNone;
    const bool stands = was != LeafSites::kNone && !related_[i] &&
                        std::none_of(neighbours_.begin() + begin_[i], neighbours_.begin() + end_[i],
                                     [&](std::uint32_t j) { return changed[j]; });
    result[i] = stands ? before->stages_[stage][was] : value(i);
    if (was != LeafSites::kNone) differs_[stage][i] = result[i] != before->stages_[stage][was];
  });
}

LeafIrradiance IrradianceField::filled(std::size_t i) const {
  const std::vector<LeafIrradiance>& values = stages_[Gathered];
  if (!isLittleExposed(i)) return values[i];
  RgbSum direct(0.0), indirect(0.0), particle(0.0);
  double area = 0;
  for (std::uint32_t k = begin_[i]; k < end_[i]; ++k) {
    const std::uint32_t j = neighbours_[k];
    if (isLittleExposed(j)) continue;
    const double lit = elements_.shape(sites_[j].leaf).litArea();
    direct += lit * RgbSum(values[j].direct), indirect += lit * RgbSum(values[j].indirect);
    particle += lit * RgbSum(values[j].particle);
    area += lit;
  }
  return area > 0 ? LeafIrradiance{Rgb(direct / area), Rgb(indirect / area), 0, Rgb(particle / area)} : values[i];
}

LeafIrradiance IrradianceField::mended(std::size_t i) {
  const std::vector<LeafIrradiance>& values = stages_[Filled];
  if (torn_[i] == end_[i]) return values[i];
  LeafIrradiance most;
  for (std::uint32_t k = begin_[i] + 1; k < torn_[i]; ++k) {
    const LeafIrradiance& other = values[neighbours_[k]];
    most.direct = glm::max(most.direct, other.direct), most.indirect = glm::max(most.indirect, other.indirect);
    most.particle = glm::max(most.particle, other.particle);
  }
  if (exposed_[i] < 0) exposed_[i] = exposed(sites_[i].leaf);
  const float share = exposed_[i];
  // What is hidden is taken to be dark, as far as the neighbours in sight bear that out.
  const auto mend = [&](const Rgb& E, const Rgb& limit) { return glm::max(E, glm::min(E / share, limit)); };
  LeafIrradiance own = values[i];
  own.direct = mend(own.direct, most.direct), own.indirect = mend(own.indirect, most.indirect);
  own.particle = mend(own.particle, most.particle);
  return own;
}

LeafIrradiance IrradianceField::withoutOutliers(std::size_t i) const {
  const std::vector<LeafIrradiance>& values = stages_[Mended];
  if (torn_[i] - begin_[i] < 1 + deltalux::tuning::kFewRays) return values[i];
  Rgb least(std::numeric_limits<float>::infinity()), most(0.0f);
  for (std::uint32_t k = begin_[i] + 1; k < torn_[i]; ++k) {
    const Rgb& E = values[neighbours_[k]].indirect;
    least = glm::min(least, E), most = glm::max(most, E);
  }
  LeafIrradiance own = values[i];
  own.indirect = glm::clamp(own.indirect, least, most);
  return own;
}

LeafIrradiance IrradianceField::quiet(std::size_t i, const std::vector<LeafIrradiance>& before) const {
  LeafIrradiance own = before[i];
  const float total = gray(own.direct + own.indirect), asked = noise_ * total;
  if (!(total > 0)) return own;
  RgbSum sum(0.0), particle(0.0);
  double weights = 0;
  for (std::uint32_t k = begin_[i]; k < torn_[i]; ++k) {
    const LeafIrradiance& value = before[neighbours_[k]];
    const float both = std::sqrt(0.5f * (own.noise * own.noise + value.noise * value.noise));
    const float apart = maxChannel(glm::abs(value.indirect - own.indirect)) / std::max(asked, both);
    const double w = std::exp(-0.5 * apart * apart) / sites_[neighbours_[k]].fineness;
    sum += w * RgbSum(value.indirect), particle += w * RgbSum(value.particle), weights += w;
  }
  own.indirect = Rgb(sum / weights), own.particle = Rgb(particle / weights);
  return own;
}

/// visit(p) for the corners of a flat leaf, for a grid of points of a curved one.
template <class Visit>
void IrradianceField::forEachCorner(hierarchy::ElementId leaf, const Visit& visit) const {
  const hierarchy::PatchDomain& d = elements_.domain[leaf.index()];
  if (elements_.at(leaf).flat) {
    for (const Vec2& q : elements_.outline(leaf)) visit(Vec3f(elements_.frames[d.frame].at(q)));
    return;
  }
  for (const float u : {0.0f, 0.5f, 1.0f})
    for (const float v : {0.0f, 0.5f, 1.0f})
      visit(hierarchy::pointOn(elements_, scene_, leaf, glm::mix(d.u0, d.u1, u), glm::mix(d.v0, d.v1, v)).position);
}

IrradianceField::Linear IrradianceField::fit(std::size_t i, Quantity quantity) const {
  const std::vector<LeafIrradiance>& values = stages_.back();
  const LeafSite& site = sites_[i];
  Linear linear;
  const Rgb own = values[i].*quantity;
  linear.value = own;
  LinearFit fit(elements_.shape(site.leaf).normal);
  Rgb largest(0.0f);
  for (std::uint32_t k = begin_[i] + 1; k < torn_[i]; ++k) {
    const Rgb difference = values[neighbours_[k]].*quantity - own;
    fit.add(sites_[neighbours_[k]].center - site.center, difference);
    largest = glm::max(largest, glm::abs(difference));
  }
  linear.low = glm::max(own - tuning::kLeeway * largest, Rgb(0.0f));
  linear.high = own + tuning::kLeeway * largest;
  fit.slopes(linear.slope);
  // Within the leaf itself the slope must not go further than to its neighbours.
  Rgb reach(0.0f);
  forEachCorner(site.leaf, [&](const Vec3f& p) {
    const Vec3f d = p - site.center;
    reach = glm::max(reach, glm::abs(d.x * linear.slope[0] + d.y * linear.slope[1] + d.z * linear.slope[2]));
  });
  for (int c = 0; c < 3; ++c) {
    if (reach[c] <= 1.1f * largest[c]) continue;
    for (Rgb& s : linear.slope) s[c] *= 1.1f * largest[c] / reach[c];
  }
  return linear;
}

void IrradianceField::fitAll(const IrradianceField* before) {
  const std::vector<LeafIrradiance>& values = stages_.back();
  std::vector<std::pair<Quantity, std::vector<Linear> IrradianceField::*>> all{
      {&LeafIrradiance::direct, &IrradianceField::direct_}, {&LeafIrradiance::indirect, &IrradianceField::indirect_}};
  if (std::any_of(values.begin(), values.end(), [](const LeafIrradiance& v) { return !isBlack(v.particle); }))
    all.push_back({&LeafIrradiance::particle, &IrradianceField::particle_});
  if (before && before->particle_.empty() != (all.size() < 3)) before = nullptr;
  for (const auto& [quantity, linears] : all) (this->*linears).resize(sites_.size());
  std::vector<char> changed(sites_.size(), 1);
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    const std::uint32_t was = before ? sites_.before(i) : LeafSites::kNone;
    const bool stands = was != LeafSites::kNone && !related_[i] &&
                        std::none_of(neighbours_.begin() + begin_[i], neighbours_.begin() + torn_[i],
                                     [&](std::uint32_t j) { return differs_.back()[j]; });
    bool same = was != LeafSites::kNone;
    for (const auto& [quantity, linears] : all) {
      (this->*linears)[i] = stands ? (before->*linears)[was] : fit(i, quantity);
      same = same && (this->*linears)[i] == (before->*linears)[was];
    }
    changed[i] = !same;
  });
  changedIn_.assign(sites_.size(), generation_);
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const std::uint32_t was = before ? sites_.before(i) : LeafSites::kNone;
    if (was != LeafSites::kNone && !related_[i] &&
        std::none_of(neighbours_.begin() + begin_[i], neighbours_.begin() + end_[i],
                     [&](std::uint32_t j) { return changed[j]; }))
      changedIn_[i] = before->changedIn_[was];
  }
}

template <class Visit>
float IrradianceField::forEachWeight(const hierarchy::LeafPoint& at, const Vec3f& p, const Visit& visit) const {
  const std::uint32_t home = sites_.of(at.leaf);
  SupportPoint point;
  point.position = p;
  if (sites_[home].support.round()) {
    point.uv = glm::vec2(at.uv);
    point.radius = relativeRadius(scene_[elements_.domain[at.leaf.index()].primitive].shape, at.uv.y);
  }
  const bool cut = torn(at.leaf);
  float weights = 0;
  for (std::uint32_t k = begin_[home]; k < end_[home]; ++k) {
    const std::uint32_t i = neighbours_[k];
    const LeafSite& site = sites_[i];
    const float w = site.fineness * site.support.weight(point);
    if (w <= 0.0f || (cut && !inSight(p, at.leaf, site.leaf))) continue;
    visit(i, w);
    weights += w;
  }
  return weights;
}

Rgb IrradianceField::at(const Linear& l, const LeafSite& site, const Vec3f& p) const {
  const Vec3f d = p - site.center;
  return glm::clamp(l.value + d.x * l.slope[0] + d.y * l.slope[1] + d.z * l.slope[2], l.low, l.high);
}

Rgb IrradianceField::blend(const std::vector<Linear>& linears, const hierarchy::LeafPoint& at, const Vec3f& p) const {
  Rgb sum(0.0f);
  const float weights =
      forEachWeight(at, p, [&](std::uint32_t i, float w) { sum += w * IrradianceField::at(linears[i], sites_[i], p); });
  return weights > 0.0f ? sum / weights : linears[sites_.of(at.leaf)].value;
}

PointIrradiance IrradianceField::all(const hierarchy::LeafPoint& point, const Vec3f& p) const {
  PointIrradiance E;
  const bool particles = !particle_.empty();
  const float weights = forEachWeight(point, p, [&](std::uint32_t i, float w) {
    E.direct += w * at(direct_[i], sites_[i], p), E.indirect += w * at(indirect_[i], sites_[i], p);
    if (particles) E.particle += w * at(particle_[i], sites_[i], p);
  });
  if (weights > 0.0f) {
    E = {E.direct / weights, E.indirect / weights, E.particle / weights};
  } else {
    const std::uint32_t home = sites_.of(point.leaf);
    E = {direct_[home].value, indirect_[home].value, particles ? particle_[home].value : Rgb(0.0f)};
  }
  E.particle = glm::min(E.particle, E.indirect);
  E.indirect -= E.particle;
  return E;
}

}  // namespace deltalux::rendering
