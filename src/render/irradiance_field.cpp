#include "render/irradiance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/sobol.hpp"
#include "hierarchy/patch.hpp"
#include "render/linear_fit.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kBlock = 512;
constexpr float kSamePlane = 0.9998f;          // cosine between polygons that make one wall
constexpr float kSmoothMesh = 0.766f;          // cosine between triangles that a mesh means to be round: 40 degrees
constexpr float kOffPlane = 1e-3f;             // of the smaller leaf's size: still one plane
constexpr float kDisagree = 0.3f;              // relative difference that asks whether something stands between
constexpr float kLift = 0.1f;                  // of the smaller leaf's size: height at which that is looked for
constexpr int kExposureRays = 16;              // that tell how much of a torn leaf is in sight of its centre
constexpr std::uint32_t kFewestWitnesses = 4;  // joined leaves that tell what is out of the way
constexpr float kLittleExposed = 0.2f;         // share of a leaf that tells too little of what is around it
constexpr int kQuietPasses = 4;                // of averaging: it reaches about as many leaves
constexpr float kLeeway = 2.0f;                // predictions stay within so many times what the neighbours differ

bool disagree(const Rgb& a, const Rgb& b) {
  const float x = gray(a), y = gray(b);
  return std::abs(x - y) > kDisagree * std::max(x, y);
}

bool isLittleExposed(const hierarchy::Elements& elements, hierarchy::ElementId leaf) {
  return elements.shape(leaf).exposed < kLittleExposed;
}

}  // namespace

IrradianceField::IrradianceField(const hierarchy::Elements& elements, const Scene& scene,
                                 const tracing::RayTracer& tracer, const std::vector<LeafIrradiance>& values,
                                 float noise)
    : elements_(elements), scene_(scene), tracer_(tracer), siteOf_(elements.size(), Id<void>::kNone) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    siteOf_[i] = static_cast<std::uint32_t>(sites_.size());
    sites_.push_back({hierarchy::ElementId(i), {}, 0, {}});
  }
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    Site& site = sites_[i];
    const hierarchy::ElementGeometry& g = elements.shape(site.leaf);
    site.center = g.center;
    site.fineness = 1.0f / std::max(g.area, 1e-30f);
    site.support = PatchSupport(elements, scene, site.leaf);
  });
  findNeighbours(values);
  const std::vector<LeafIrradiance> whole = quiet(mended(filled(values)), noise);
  fit(direct_, &LeafIrradiance::direct, whole);
  fit(indirect_, &LeafIrradiance::indirect, whole);
  if (std::any_of(whole.begin(), whole.end(), [](const LeafIrradiance& v) { return !isBlack(v.particle); }))
    fit(particle_, &LeafIrradiance::particle, whole);
}

void IrradianceField::findNeighbours(const std::vector<LeafIrradiance>& values) {
  std::vector<BoxF> boxes(sites_.size());
  parallelFor(sites_.size(), kBlock,
              [&](std::size_t i) { boxes[i] = sites_[i].support.bounds(elements_, sites_[i].leaf); });
  const BoxTree tree(std::move(boxes));

  std::vector<std::vector<std::uint32_t>> lists((sites_.size() + kBlock - 1) / kBlock);
  begin_.assign(sites_.size() + 1, 0);
  torn_.assign(sites_.size(), 0);
  parallelBlocks(sites_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    auto& list = lists[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::uint32_t> joined, torn;
      const hierarchy::ElementGeometry& g = elements_.shape(sites_[i].leaf);
      tree.overlapping({g.lower, g.upper}, [&](std::uint32_t j) {
        if (j == i) return;
        const Relation relation = relate(sites_[i], sites_[j], values);
        if (relation != Relation::None) (relation == Relation::Joined ? joined : torn).push_back(j);
      });
      std::sort(joined.begin(), joined.end());
      std::sort(torn.begin(), torn.end());
      list.push_back(static_cast<std::uint32_t>(i));
      list.insert(list.end(), joined.begin(), joined.end());
      list.insert(list.end(), torn.begin(), torn.end());
      torn_[i] = static_cast<std::uint32_t>(1 + joined.size());
      begin_[i + 1] = static_cast<std::uint32_t>(1 + joined.size() + torn.size());
    }
  });
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    begin_[i + 1] += begin_[i];
    torn_[i] += begin_[i];
  }
  neighbours_.reserve(begin_.back());
  for (const auto& list : lists) neighbours_.insert(neighbours_.end(), list.begin(), list.end());
}

bool IrradianceField::sameSurface(hierarchy::ElementId a, hierarchy::ElementId b) const {
  const hierarchy::PatchDomain &da = elements_.domain[a.index()], &db = elements_.domain[b.index()];
  const bool samePrimitive = da.primitive == db.primitive;
  if (!elements_.at(a).flat || !elements_.at(b).flat)
    return samePrimitive && elements_.at(a).front == elements_.at(b).front;
  const hierarchy::ElementGeometry &ga = elements_.shape(a), &gb = elements_.shape(b);
  const float cosine = glm::dot(ga.normal, gb.normal);
  if (samePrimitive) return cosine > kSmoothMesh;
  const float size = std::sqrt(std::min(ga.area, gb.area));
  return cosine > kSamePlane && std::abs(glm::dot(gb.center - ga.center, ga.normal)) < kOffPlane * size;
}

IrradianceField::Relation IrradianceField::relate(const Site& home, const Site& other,
                                                  const std::vector<LeafIrradiance>& values) const {
  if (!sameSurface(home.leaf, other.leaf) || !other.support.reaches(elements_, scene_, home.leaf))
    return Relation::None;
  const LeafIrradiance &a = values[home.leaf.index()], &b = values[other.leaf.index()];
  if (!home.support.flat() || (!disagree(a.indirect, b.indirect) && !disagree(a.direct, b.direct)))
    return Relation::Joined;
  return inSight(home.center, home.leaf, other.leaf) ? Relation::Joined : Relation::Torn;
}

bool IrradianceField::inSight(const Vec3f& p, hierarchy::ElementId home, hierarchy::ElementId other) const {
  const hierarchy::ElementGeometry &a = elements_.shape(home), &b = elements_.shape(other);
  const float lift = kLift * std::sqrt(std::min(a.area, b.area));
  const Vec3f from = p + lift * a.normal, to = b.center + lift * b.normal;
  tracing::Ray ray;
  ray.origin = from;
  ray.tFar = glm::length(to - from);
  ray.direction = (to - from) / std::max(ray.tFar, 1e-30f);
  return !tracer_.occluded(ray);
}

float IrradianceField::exposed(hierarchy::ElementId leaf) const {
  int seen = 0;
  for (std::uint32_t k = 0; k < kExposureRays; ++k) {
    const UnitPair u = scrambledSobol(k, elements_.key[leaf.index()]);
    seen += inSight(hierarchy::samplePatch(elements_, scene_, leaf, u.x, u.y).position, leaf, leaf);
  }
  return static_cast<float>(std::max(seen, 1)) / float(kExposureRays);
}

std::vector<LeafIrradiance> IrradianceField::filled(const std::vector<LeafIrradiance>& values) const {
  std::vector<LeafIrradiance> result = values;
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    if (!isLittleExposed(elements_, sites_[i].leaf)) return;
    RgbSum direct(0.0), indirect(0.0), particle(0.0);
    double area = 0;
    for (std::uint32_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      const hierarchy::ElementId leaf = sites_[neighbours_[k]].leaf;
      if (isLittleExposed(elements_, leaf)) continue;
      const double lit = elements_.shape(leaf).litArea();
      direct += lit * RgbSum(values[leaf.index()].direct), indirect += lit * RgbSum(values[leaf.index()].indirect);
      particle += lit * RgbSum(values[leaf.index()].particle);
      area += lit;
    }
    if (area > 0) result[sites_[i].leaf.index()] = {Rgb(direct / area), Rgb(indirect / area), 0, Rgb(particle / area)};
  });
  return result;
}

std::vector<LeafIrradiance> IrradianceField::mended(const std::vector<LeafIrradiance>& values) const {
  std::vector<LeafIrradiance> result = values;
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    if (torn_[i] == begin_[i + 1]) return;
    const hierarchy::ElementId leaf = sites_[i].leaf;
    LeafIrradiance most;
    for (std::uint32_t k = begin_[i] + 1; k < torn_[i]; ++k) {
      const LeafIrradiance& other = values[sites_[neighbours_[k]].leaf.index()];
      most.direct = glm::max(most.direct, other.direct), most.indirect = glm::max(most.indirect, other.indirect);
      most.particle = glm::max(most.particle, other.particle);
    }
    const float share = exposed(leaf);
    // What is hidden is taken to be dark, as far as the neighbours in sight bear that out.
    const auto mend = [&](const Rgb& E, const Rgb& limit) { return glm::max(E, glm::min(E / share, limit)); };
    LeafIrradiance& own = result[leaf.index()];
    own.direct = mend(own.direct, most.direct), own.indirect = mend(own.indirect, most.indirect);
    own.particle = mend(own.particle, most.particle);
  });
  return result;
}

std::vector<LeafIrradiance> IrradianceField::withoutOutliers(const std::vector<LeafIrradiance>& values) const {
  std::vector<LeafIrradiance> result = values;
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    if (torn_[i] - begin_[i] < 1 + kFewestWitnesses) return;
    Rgb least(std::numeric_limits<float>::infinity()), most(0.0f);
    for (std::uint32_t k = begin_[i] + 1; k < torn_[i]; ++k) {
      const Rgb& E = values[sites_[neighbours_[k]].leaf.index()].indirect;
      least = glm::min(least, E), most = glm::max(most, E);
    }
    Rgb& own = result[sites_[i].leaf.index()].indirect;
    own = glm::clamp(own, least, most);
  });
  return result;
}

std::vector<LeafIrradiance> IrradianceField::quiet(const std::vector<LeafIrradiance>& values, float noise) const {
  if (!(noise > 0)) return values;
  std::vector<LeafIrradiance> result = withoutOutliers(values);
  for (int pass = 0; pass < kQuietPasses; ++pass) {
    const std::vector<LeafIrradiance> before = result;
    parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
      const hierarchy::ElementId leaf = sites_[i].leaf;
      const LeafIrradiance& own = before[leaf.index()];
      const float total = gray(own.direct + own.indirect), asked = noise * total;
      if (!(total > 0)) return;
      RgbSum sum(0.0), particle(0.0);
      double weights = 0;
      for (std::uint32_t k = begin_[i]; k < torn_[i]; ++k) {
        const Site& other = sites_[neighbours_[k]];
        const LeafIrradiance& value = before[other.leaf.index()];
        const float both = std::sqrt(0.5f * (own.noise * own.noise + value.noise * value.noise));
        const float apart = maxChannel(glm::abs(value.indirect - own.indirect)) / std::max(asked, both);
        const double w = std::exp(-0.5 * apart * apart) / other.fineness;
        sum += w * RgbSum(value.indirect), particle += w * RgbSum(value.particle), weights += w;
      }
      result[leaf.index()].indirect = Rgb(sum / weights);
      result[leaf.index()].particle = Rgb(particle / weights);
    });
  }
  return result;
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

void IrradianceField::fit(std::vector<Linear>& result, Rgb LeafIrradiance::*quantity,
                          const std::vector<LeafIrradiance>& values) const {
  result.resize(sites_.size());
  parallelFor(sites_.size(), kBlock, [&](std::size_t i) {
    const Site& site = sites_[i];
    Linear& linear = result[i];
    const Rgb own = values[site.leaf.index()].*quantity;
    linear.value = own;
    const Vec3f normal = elements_.shape(site.leaf).normal;
    LinearFit fit(normal);
    Rgb largest(0.0f);
    for (std::uint32_t k = begin_[i] + 1; k < torn_[i]; ++k) {
      const Site& other = sites_[neighbours_[k]];
      const Rgb difference = values[other.leaf.index()].*quantity - own;
      fit.add(other.center - site.center, difference);
      largest = glm::max(largest, glm::abs(difference));
    }
    linear.low = glm::max(own - kLeeway * largest, Rgb(0.0f));
    linear.high = own + kLeeway * largest;
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
  });
}

template <class Visit>
float IrradianceField::forEachWeight(const hierarchy::LeafPoint& at, const Vec3f& p, const Visit& visit) const {
  const std::uint32_t home = siteOf_[at.leaf.index()];
  SupportPoint point;
  point.position = p;
  if (!sites_[home].support.flat()) {
    point.uv = glm::vec2(at.uv);
    point.radius = relativeRadius(scene_[elements_.domain[at.leaf.index()].primitive].shape, at.uv.y);
  }
  const bool cut = torn(at.leaf);
  float weights = 0;
  for (std::uint32_t k = begin_[home]; k < begin_[home + 1]; ++k) {
    const std::uint32_t i = neighbours_[k];
    const Site& site = sites_[i];
    const float w = site.fineness * site.support.weight(point);
    if (w <= 0.0f || (cut && !inSight(p, at.leaf, site.leaf))) continue;
    visit(i, w);
    weights += w;
  }
  return weights;
}

Rgb IrradianceField::at(const Linear& l, const Site& site, const Vec3f& p) const {
  const Vec3f d = p - site.center;
  return glm::clamp(l.value + d.x * l.slope[0] + d.y * l.slope[1] + d.z * l.slope[2], l.low, l.high);
}

Rgb IrradianceField::blend(const std::vector<Linear>& linears, const hierarchy::LeafPoint& at, const Vec3f& p) const {
  Rgb sum(0.0f);
  const float weights =
      forEachWeight(at, p, [&](std::uint32_t i, float w) { sum += w * IrradianceField::at(linears[i], sites_[i], p); });
  return weights > 0.0f ? sum / weights : linears[siteOf_[at.leaf.index()]].value;
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
    const std::uint32_t home = siteOf_[point.leaf.index()];
    E = {direct_[home].value, indirect_[home].value, particles ? particle_[home].value : Rgb(0.0f)};
  }
  E.particle = glm::min(E.particle, E.indirect);
  E.indirect -= E.particle;
  return E;
}

}  // namespace deltalux::rendering
