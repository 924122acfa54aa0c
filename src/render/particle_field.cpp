#include "render/particle_field.hpp"

#include <algorithm>
#include <array>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "caustics/tuning.hpp"
#include "hierarchy/tuning.hpp"
#include "particles/impact_light.hpp"
#include "particles/side_index.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {

constexpr int kSectors = hierarchy::tuning::kGrid;  // around a point
constexpr int kDisc = kSectors * deltalux::tuning::kPilots;

/// Points of the unit disc, even in area. [Vogel79]
const std::array<Vec2, kDisc>& disc() {
  static const std::array<Vec2, kDisc> points = [] {
    std::array<Vec2, kDisc> p;
    for (int i = 0; i < kDisc; ++i) {
      const double r = std::sqrt((i + 0.5) / kDisc), phi = i * kPi * (3 - std::sqrt(5.0));
      p[i] = {r * std::cos(phi), r * std::sin(phi)};
    }
    return p;
  }();
  return points;
}

int widestAxis(const auto* first, const auto* last) {
  Vec3f low(std::numeric_limits<float>::infinity()), high(-low);
  for (const auto* l = first; l != last; ++l) low = glm::min(low, l->position), high = glm::max(high, l->position);
  const Vec3f size = high - low;
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// Whether the surface is there, at the tangent plane's point `q`.
bool onSurface(const Shape& shape, const Vec3& q) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    const Vec3 d = q - polygon->origin;
    return covers(shape, {glm::dot(d, polygon->dualU), glm::dot(d, polygon->dualV)});
  }
  if (const auto* ring = std::get_if<Ring>(&shape)) {
    const double r = glm::distance(q, ring->center);
    return r >= ring->innerRadius && r <= ring->outerRadius;
  }
  const auto along = [&](const Vec3& p0, const Vec3& p1) {
    const double t = glm::dot(q - p0, p1 - p0) / glm::dot(p1 - p0, p1 - p0);
    return t >= 0 && t <= 1;
  };
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return along(cylinder->p0, cylinder->p1);
  if (const auto* cone = std::get_if<Cone>(&shape)) return along(cone->p0, cone->p1);
  return true;
}

}  // namespace

ParticleField::ParticleField(const Solution& s) : scene_(s.scene), tracer_(*s.tracer) {
  const std::vector<particles::Impact> all = particles::impacts(s.particles, s.elements, s.scene);
  begin_.assign(2 * scene_.primitives.size() + 1, 0);
  const auto group = [](const particles::Impact& i) { return particles::sideIndex(i.primitive, i.front); };
  for (const particles::Impact& i : all) ++begin_[group(i) + 1];
  for (std::size_t g = 1; g < begin_.size(); ++g) begin_[g] += begin_[g - 1];
  deposits_.resize(all.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  std::vector<std::uint32_t> place(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) place[i] = next[group(all[i])]++;
  parallelFor(all.size(), 4096, [&](std::size_t i) {
    const particles::Impact& impact = all[i];
    deposits_[place[i]] = {Vec3f(particles::positionOf(impact, scene_)), 0, impact.flux};
  });
  parallelFor(begin_.size() - 1, 4, [&](std::size_t g) { sortTree(begin_[g], begin_[g + 1]); });
}

/// The middle of each range is its root, the halves on either side its subtrees.
void ParticleField::sortTree(std::uint32_t begin, std::uint32_t end) {
  if (end - begin < 2) return;
  const std::uint32_t middle = begin + (end - begin) / 2;
  Deposit* const at = deposits_.data();
  const int axis = widestAxis(at + begin, at + end);
  std::nth_element(at + begin, at + middle, at + end,
                   [axis](const Deposit& a, const Deposit& b) { return a.position[axis] < b.position[axis]; });
  deposits_[middle].axis = static_cast<std::uint32_t>(axis);
  sortTree(begin, middle);
  sortTree(middle + 1, end);
}

void ParticleField::search(std::uint32_t begin, std::uint32_t end, Query& q) const {
  if (begin == end) return;
  const std::uint32_t middle = begin + (end - begin) / 2;
  const Deposit& l = deposits_[middle];
  const Vec3f p(q.position), d = l.position - p;
  const auto nearer = [](const Neighbour& a, const Neighbour& b) { return a.squared < b.squared; };
  const float squared = glm::dot(d, d);
  if (q.found.size() < kMostParticles || squared < q.found.front().squared) {
    q.found.push_back({squared, middle});
    std::push_heap(q.found.begin(), q.found.end(), nearer);
    if (q.found.size() > kMostParticles) {
      std::pop_heap(q.found.begin(), q.found.end(), nearer);
      q.found.pop_back();
    }
  }
  const float across = d[static_cast<int>(l.axis)];
  const auto lower = [&] { search(begin, middle, q); };
  const auto upper = [&] { search(middle + 1, end, q); };
  const auto reachable = [&] { return q.found.size() < kMostParticles || across * across < q.found.front().squared; };
  if (across > 0) {
    lower();
    if (reachable()) upper();
  } else {
    upper();
    if (reachable()) lower();
  }
}

Rgb ParticleField::at(PrimitiveId primitive, bool front, const Vec3& position, const Vec3& normal) const {
  const std::size_t group = particles::sideIndex(primitive, front);
  if (begin_[group] == begin_[group + 1]) return Rgb(0.0f);
  Query q;
  q.primitive = primitive, q.position = position, q.normal = normal;
  q.found.reserve(kMostParticles + 1);
  search(begin_[group], begin_[group + 1], q);
  std::sort_heap(q.found.begin(), q.found.end(),
                 [](const Neighbour& a, const Neighbour& b) { return a.squared < b.squared; });
  const bool all = q.found.size() < kMostParticles;
  // A surface with few impacts is one kernel that reaches well over it.
  const double reach = std::sqrt(double(q.found.back().squared));
  q.radius = all ? std::max(1.5 * reach, 0.5 * bounds(scene_[primitive].shape).diagonal()) : reach;
  if (!(q.radius > 0)) return Rgb(0.0f);
  return estimate(q, lookAround(q));
}

bool ParticleField::inSight(const Query& q, const Vec3& to) const {
  const double lift = hierarchy::tuning::kTouching * q.radius;
  const Vec3f from(q.position + lift * q.normal), d = Vec3f(to + lift * q.normal) - from;
  tracing::Ray ray;
  ray.origin = from;
  ray.tFar = glm::length(d);
  if (!(ray.tFar > 0)) return true;
  ray.direction = d / ray.tFar;
  return !tracer_.occluded(ray);
}

ParticleField::Surroundings ParticleField::lookAround(const Query& q) const {
  Surroundings s;
  s.open.assign(kDisc, 0);
  const Frame frame(q.normal);
  const Shape& shape = scene_[q.primitive].shape;
  const bool flat = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Ring>(shape);
  for (int i = 0; i < kDisc; ++i) {
    const Vec2 at = q.radius * disc()[i];
    const Vec3 to = q.position + at.x * frame.tangent + at.y * frame.bitangent;
    if (!onSurface(shape, to)) continue;
    const bool seen = !flat || inSight(q, to);
    s.open[i] = seen;
    s.blocked = s.blocked || !seen;
  }
  return s;
}

/// Flux, its squares and the surface's area in parts of rings around a point: by sector, out to each radius.
struct ParticleField::Rings {
  struct Sum {
    RgbSum flux{0.0};
    double gray = 0, squares = 0, area = 0;
  };
  std::vector<double> radii;
  std::array<std::vector<Sum>, kSectors> out;  // out[k][j]: sector k within radii[j]

  Sum whole(std::size_t j) const {
    Sum all;
    for (const auto& sector : out) add(all, sector[j], 1);
    return all;
  }
  static void add(Sum& to, const Sum& s, double sign) {
    to.flux += sign * s.flux, to.gray += sign * s.gray, to.squares += sign * s.squares, to.area += sign * s.area;
  }
};

ParticleField::Rings ParticleField::ringsOf(const Query& q, const Surroundings& around) const {
  Rings rings;
  // A quarter of the distance of sixteen holds one.
  const std::size_t few = std::min<std::size_t>(deltalux::tuning::kPilots, q.found.size());
  double radius = std::max(0.25 * std::sqrt(double(q.found[few - 1].squared)), 1e-6 * q.radius);
  const double step = std::exp2(deltalux::tuning::kOctaveStep);
  for (; radius < q.radius; radius *= step) rings.radii.push_back(radius);
  rings.radii.push_back(q.radius);
  const std::size_t steps = rings.radii.size();
  const Frame frame(q.normal);
  const auto sectorOf = [](double x, double y) {
    const int k = static_cast<int>(std::floor((std::atan2(y, x) / kPi + 1) * 0.5 * kSectors));
    return std::clamp(k, 0, kSectors - 1);
  };
  for (auto& sector : rings.out) sector.resize(steps);
  const auto stepOf = [&](double r) {
    return static_cast<std::size_t>(std::lower_bound(rings.radii.begin(), rings.radii.end() - 1, r) -
                                    rings.radii.begin());
  };
  for (const Neighbour& n : q.found) {
    const Deposit& l = deposits_[n.deposit];
    const Vec3 d = Vec3(l.position) - q.position;
    Rings::Sum& s = rings.out[sectorOf(glm::dot(d, frame.tangent), glm::dot(d, frame.bitangent))]
                             [stepOf(std::sqrt(double(n.squared)))];
    const double w = deltalux::gray(l.flux);
    s.flux += RgbSum(l.flux), s.gray += w, s.squares += w * w;
  }
  // Of every ring's part as much is surface as of the points in it and next to it.
  std::array<std::vector<std::array<int, 2>>, kSectors> open;
  const bool everywhere = std::all_of(around.open.begin(), around.open.end(), [](char o) { return o; });
  for (int k = 0; k < kSectors; ++k) open[k].assign(steps, {0, 0});
  for (int i = 0; i < kDisc && !everywhere; ++i) {
    const Vec2 at = disc()[i];
    auto& cell = open[sectorOf(at.x, at.y)][stepOf(q.radius * glm::length(at))];
    ++cell[0], cell[1] += around.open[i];
  }
  for (int k = 0; k < kSectors; ++k) {
    double share = 1;  // the point itself is on the surface
    for (std::size_t j = 0; j < steps; ++j) {
      if (!everywhere && open[k][j][0] > 0) share = double(open[k][j][1]) / open[k][j][0];
      const double inner = j > 0 ? rings.radii[j - 1] : 0.0, outer = rings.radii[j];
      rings.out[k][j].area = share * kPi * (outer * outer - inner * inner) / kSectors;
      if (j > 0) Rings::add(rings.out[k][j], rings.out[k][j - 1], 1);
    }
  }
  return rings;
}

Rgb ParticleField::estimate(Query& q, const Surroundings& around) const {
  if (around.blocked)
    std::erase_if(q.found, [&](const Neighbour& n) { return !inSight(q, Vec3(deposits_[n.deposit].position)); });
  if (q.found.empty()) return Rgb(0.0f);
  const Rings rings = ringsOf(q, around);
  const std::size_t steps = rings.radii.size();
  const Rings::Sum all = rings.whole(steps - 1);
  if (!(all.gray > 0) || !(all.area > 0)) return Rgb(0.0f);
  // Where deposits are few the noise is that of as many as are around on average.
  const double typical = all.squares / all.area;
  const auto noiseOf = [&](const Rings::Sum& s) {
    return caustics::tuning::kSharp * std::sqrt(std::max(s.squares, typical * s.area)) / s.area;
  };
  double low = 0, high = kInfinity;
  for (std::size_t j = 0; j < steps; ++j) {
    const Rings::Sum s = rings.whole(j);
    if (!(s.area > 0)) continue;
    const double E = s.gray / s.area, noise = noiseOf(s);
    if (E - noise > high || E + noise < low) break;
    low = std::max(low, E - noise), high = std::min(high, E + noise);
  }
  Rings::Sum kept;
  for (int pass = 0; pass < deltalux::tuning::kEverCloser; ++pass) {
    kept = {};
    for (const auto& sector : rings.out) {
      std::size_t reach = 0;
      for (std::size_t j = 0; j < steps; ++j) {
        Rings::Sum part = sector[j];
        if (j >= 2) Rings::add(part, sector[j - 2], -1);
        if (part.area > 0) {
          const double E = part.gray / part.area, noise = noiseOf(part);
          if (E - noise > high || E + noise < low) break;
        }
        reach = j + 1;
      }
      if (reach > 0) Rings::add(kept, sector[reach - 1], 1);
    }
    if (!(kept.area > 0)) return Rgb(all.flux / all.area);
    const double E = kept.gray / kept.area;
    const double one = all.squares / static_cast<double>(q.found.size());  // of a single impact
    const double noise = caustics::tuning::kSharp * std::sqrt(std::max(kept.squares, one)) / kept.area;
    low = E - noise, high = E + noise;
  }
  return Rgb(kept.flux / kept.area);
}

}  // namespace deltalux::rendering
