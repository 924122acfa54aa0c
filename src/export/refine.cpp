#include "export/refine.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <unordered_map>

#include "base/parallel.hpp"
#include "direct/tuning.hpp"

namespace deltalux::exporting {

namespace {

constexpr std::uint32_t kUncut = 0xffffffffu;  // [sentinel]
constexpr double kShadowEdge = 3e-3;           // size of what is left of a shadow's edge [m] [shown]
constexpr double kBorderInset = 1e-3;          // inside of borders, where corners on them are measured [m] [rounding]
constexpr double kVisible = 10;                // times that: edges from which on all that is not allowed shows [shown]
constexpr int kMostCuts = 32;                  // of cuts of cuts [limit]
constexpr std::size_t kMostAdded = 16384,
                      kMostPerVertex = 8;  // corners that a side gets, and more by those it has [limit]
constexpr std::size_t kMeasured = 64;      // places of a task [task]
constexpr float kChannels = 3;             // whose sum light is compared by [layout]
constexpr int kLooks = 8;                  // parts of an edge that is cut [task]
constexpr double kLeastWay = 0.05;         // of the way inside that a border's corner is moved at most [rounding]
constexpr double kOnePlane = 0.9999;       // cosine between normals of a flat triangle [rounding]

float sumOf(const Rgb& c) { return c.r + c.g + c.b; }
float differenceOf(const Rgb& a, const Rgb& b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}
template <class T, class Weight>
T between(const T& a, const T& b, Weight t) {
  return a + t * (b - a);
}

class SideRefiner {
 public:
  SideRefiner(LitSide& side, const Shape& shape, bool front, const DirectLight& light, const Refinement& settings)
      : side_(side), shape_(shape), front_(front), light_(light), settings_(settings), groups_(side.all.size()) {
    room_ = kMostAdded + kMostPerVertex * side.vertices.size();
    flat_ = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Ring>(shape);
    mesh_ = std::holds_alternative<Mesh>(shape);
  }

  void run() {
    registerEdges(side_.triangles);
    measureCorners();
    if (!mayBeCut()) return;
    std::vector<std::array<std::uint32_t, 3>> active = side_.triangles, done;
    for (int pass = 0; pass < kMostCuts && !active.empty() && room_ > 0; ++pass) {
      cutEdges();
      std::vector<std::array<std::uint32_t, 3>> whole, next;
      for (const auto& t : active)
        if (!cut(t, next)) whole.push_back(t);
      cutMiddles(whole, next, done);
      registerEdges(next);
      active = std::move(next);
    }
    done.insert(done.end(), active.begin(), active.end());
    side_.triangles = std::move(done);
  }

 private:
  struct Edge {
    std::uint32_t a, b, opposite;
    bool border = true, known = false;
    std::uint32_t corner = kUncut;  // that it is cut at
  };
  /// A place of the side, and what is measured there.
  struct Place {
    MeshVertex vertex;
    Vec3 inside;              // where it is measured
    std::vector<Rgb> rest;    // light that is not measured, by group
    std::vector<Rgb> direct;  // by group
    double worth = 0;         // how far linear light is off, over what is allowed, times how far it reaches
  };
  /// How far linear light is off, over what is allowed, and of which group.
  struct Disagreement {
    float most = 0;
    std::size_t group = 0;
  };

  static std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
  }
  Vec3 at(std::uint32_t v) const { return Vec3(side_.vertices[v].position); }

  void registerEdges(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    fresh_.clear();
    for (const auto& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        const auto [edge, added] = edgeOf_.try_emplace(keyOf(a, b), static_cast<std::uint32_t>(edges_.size()));
        if (added) {
          edges_.push_back({std::min(a, b), std::max(a, b), t[(k + 2) % 3]});
          fresh_.push_back(edge->second);
        } else if (!edges_[edge->second].known) {
          edges_[edge->second].border = false;
        }
      }
  }
  Edge& edgeBetween(std::uint32_t a, std::uint32_t b) { return edges_[edgeOf_.at(keyOf(a, b))]; }

  /// On the surface itself: curved ones lie above the triangle.
  MeshVertex onSurface(MeshVertex v) const {
    if (flat_ || mesh_) return v;
    const SurfacePoint p = pointAt(shape_, parameterAt(shape_, Vec3(v.position)));
    v.position = Vec3f(p.position), v.normal = Vec3f(front_ ? p.normal : -p.normal), v.uv = glm::vec2(p.uv);
    return v;
  }
  MeshVertex vertexBetween(std::uint32_t a, std::uint32_t b, double t) const {
    const MeshVertex &p = side_.vertices[a], &q = side_.vertices[b];
    MeshVertex v = p;
    v.position = Vec3f(between(Vec3(p.position), Vec3(q.position), t));
    v.normal = glm::normalize(between(p.normal, q.normal, static_cast<float>(t)));
    v.uv = between(p.uv, q.uv, static_cast<float>(t));
    return onSurface(v);
  }
  Vec3 moved(const MeshVertex& v, const Vec3& inwards) const {
    const Vec3 way = inwards - Vec3(v.position);
    const double length = glm::length(way);
    if (!(length > 0)) return Vec3(v.position);
    MeshVertex to = v;
    to.position = Vec3f(Vec3(v.position) + std::min(settings_.border / length, kLeastWay) * way);
    return Vec3(onSurface(to).position);
  }

  Rgb restAt(std::size_t g, std::uint32_t v) const { return side_.all[g][v] - side_.direct[g][v]; }
  float totalOf(const std::vector<Rgb>& rest, const std::vector<Rgb>& direct) const {
    float sum = 0;
    for (std::size_t g = 0; g < groups_; ++g) sum += sumOf(rest[g]) + sumOf(direct[g]);
    return sum;
  }

  float floorOf(std::size_t g) const {
    return settings_.floors.empty() ? 0.0f : static_cast<float>(settings_.floors[g]);
  }
  /// Of one group; `rest` is all groups' there.
  Rgb measured(std::size_t g, const Place& place) const {
    float all = 0;
    for (const Rgb& r : place.rest) all += gray(r);
    const float other = std::max({gray(place.rest[g]), static_cast<float>(settings_.share) * all, floorOf(g)});
    return light_.at(g, place.inside, Vec3(place.vertex.normal), other, settings_.error);
  }
  void measure(Place& place) const {
    place.direct.assign(groups_, Rgb(0.0f));
    for (std::size_t g = 0; g < groups_; ++g)
      if (light_.measures(g)) place.direct[g] = measured(g, place);
  }

  void measureCorners() {
    // What is not measured is light like all other.
    for (std::size_t g = 0; g < groups_; ++g)
      if (!light_.measures(g)) std::ranges::fill(side_.direct[g], Rgb(0.0f));
    std::vector<char> border(side_.vertices.size(), 0);
    for (const Edge& e : edges_)
      if (e.border) border[e.a] = border[e.b] = 1;
    std::vector<Vec3> middles(side_.vertices.size(), Vec3(0));
    std::vector<int> counts(side_.vertices.size(), 0);
    for (const auto& t : side_.triangles)
      for (const std::uint32_t v : t) middles[v] += (at(t[0]) + at(t[1]) + at(t[2])) / 3.0, ++counts[v];
    std::vector<std::vector<Rgb>> found(groups_, std::vector<Rgb>(side_.vertices.size(), Rgb(0.0f)));
    parallelFor(side_.vertices.size(), kMeasured, [&](std::size_t v) {
      Place place{side_.vertices[v], Vec3(side_.vertices[v].position), {}, {}};
      if (border[v] && counts[v] > 0) place.inside = moved(place.vertex, middles[v] / double(counts[v]));
      for (std::size_t g = 0; g < groups_; ++g) place.rest.push_back(restAt(g, static_cast<std::uint32_t>(v)));
      measure(place);
      for (std::size_t g = 0; g < groups_; ++g) found[g][v] = place.direct[g];
    });
    for (std::size_t g = 0; g < groups_; ++g)
      for (std::size_t v = 0; v < side_.vertices.size() && light_.measures(g); ++v)
        side_.all[g][v] += found[g][v] - side_.direct[g][v], side_.direct[g][v] = found[g][v];
  }

  /// Not where normals bend between corners, which light does with them, and shadows do not.
  bool mayBeCut() const {
    if (settings_.keepsShape) return false;
    return !mesh_ || std::ranges::all_of(side_.triangles, [&](const std::array<std::uint32_t, 3>& t) {
      const Vec3 n = glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
      return std::ranges::all_of(
          t, [&](std::uint32_t v) { return glm::dot(Vec3(side_.vertices[v].normal), n) > kOnePlane * glm::length(n); });
    });
  }

  Place placeOn(const Edge& e, double t) const {
    Place place{vertexBetween(e.a, e.b, t), {}, {}, {}};
    place.inside = e.border ? moved(place.vertex, at(e.opposite)) : Vec3(place.vertex.position);
    for (std::size_t g = 0; g < groups_; ++g)
      place.rest.push_back(between(restAt(g, e.a), restAt(g, e.b), static_cast<float>(t)));
    return place;
  }
  /// Light of a group at a place or at corners around it, whichever is most: what is next to it is what an eye
  /// compares.
  float lightAround(std::size_t g, std::span<const std::uint32_t> corners) const {
    float most = 0;
    for (const std::uint32_t v : corners) most = std::max(most, sumOf(side_.all[g][v]));
    return most;
  }
  float allowedFor(std::size_t g, std::span<const std::uint32_t> corners, float there, float total) const {
    return static_cast<float>(settings_.error) *
           std::max(
               {there, lightAround(g, corners), static_cast<float>(settings_.share) * total, kChannels * floorOf(g)});
  }
  Disagreement disagreement(const Place& place, std::span<const std::uint32_t> corners, const auto& linear) const {
    Disagreement worst;
    const float total = totalOf(place.rest, place.direct);
    for (std::size_t g = 0; g < groups_; ++g) {
      const float off = differenceOf(place.direct[g], linear(g));
      if (!(off > 0)) continue;
      // Rays tell light in a shadow to so much of what would be there without it, and an eye sees no less beside it.
      const auto open = static_cast<float>(light_.open(g, place.inside, Vec3(place.vertex.normal)));
      const float there = std::max(sumOf(place.rest[g]) + sumOf(place.direct[g]), kChannels * 0.5f * open);
      const float allowed = allowedFor(g, corners, there, total);
      if (off / allowed > worst.most) worst = {off / allowed, g};
    }
    return worst;
  }

  /// How far off light has to be for an edge of that length to be cut, over what is allowed: of short ones, only what
  /// stands out is worth it, and what rays are off by would never end.
  double threshold(double length) const { return std::max(1.0, kVisible * settings_.smallest / length); }
  /// Whether corners tell light apart by so much that there is something to look for between them.
  bool mayStep(std::span<const std::uint32_t> corners, double length) const {
    float total = 0;
    for (std::size_t g = 0; g < groups_; ++g) total += sumOf(side_.all[g][corners[0]]);
    for (std::size_t g = 0; g < groups_; ++g)
      for (const std::uint32_t v : corners)
        if (differenceOf(side_.direct[g][v], side_.direct[g][corners[0]]) >
            threshold(length) * allowedFor(g, corners, 0, total))
          return true;
    return false;
  }

  /// Where an edge is to be cut for this group: at a step, or where its light is furthest from linear.
  double cutFor(std::size_t g, const Edge& e, double length) const {
    const Rgb first = side_.direct[g][e.a], last = side_.direct[g][e.b];
    const auto lookAt = [&](double t) { return measured(g, placeOn(e, t)); };
    const auto off = [&](const Rgb& E, double t) {
      return differenceOf(E, between(first, last, static_cast<float>(t)));
    };
    std::array<Rgb, kLooks + 1> E;
    float variation = 0, step = 0, furthest = -1;
    int stepsAt = 0, bentAt = kLooks / 2;
    for (int k = 0; k <= kLooks; ++k) {
      const double t = double(k) / kLooks;
      E[static_cast<std::size_t>(k)] = k == 0 ? first : k == kLooks ? last : lookAt(t);
      if (k == 0) continue;
      const float change = differenceOf(E[std::size_t(k)], E[std::size_t(k) - 1]);
      variation += change;
      if (change > step) step = change, stepsAt = k - 1;
      if (k < kLooks && off(E[std::size_t(k)], t) > furthest) furthest = off(E[std::size_t(k)], t), bentAt = k;
    }
    if (!(2 * step > variation)) return double(bentAt) / kLooks;
    double low = double(stepsAt) / kLooks, high = double(stepsAt + 1) / kLooks;
    Rgb before = E[std::size_t(stepsAt)], after = E[std::size_t(stepsAt) + 1];
    while ((high - low) * length > 0.5 * settings_.smallest) {
      const double middle = 0.5 * (low + high);
      const Rgb there = lookAt(middle);
      if (differenceOf(there, before) > differenceOf(there, after))
        high = middle, after = there;
      else
        low = middle, before = there;
    }
    return off(before, low) > off(after, high) ? low : high;
  }

  std::optional<Place> cutOf(const Edge& e) const {
    const double length = glm::length(at(e.b) - at(e.a));
    if (length < 2 * settings_.smallest) return std::nullopt;
    if (!mayStep(std::array{e.a, e.b}, length)) return std::nullopt;
    Place middle = placeOn(e, 0.5);
    measure(middle);
    const Disagreement worst = disagreement(middle, std::array{e.a, e.b}, [&](std::size_t g) {
      return between(side_.direct[g][e.a], side_.direct[g][e.b], 0.5f);
    });
    if (!(worst.most > threshold(length))) return std::nullopt;
    const double least = 0.5 * settings_.smallest / length;
    Place place = placeOn(e, std::clamp(cutFor(worst.group, e, length), least, 1 - least));
    measure(place);
    place.worth = worst.most * length;
    return place;
  }

  /// Leaves those out that are worth least where there are more than there is room for.
  void fitIntoRoom(std::vector<std::optional<Place>>& places) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (places[i]) order.push_back(i);
    if (order.size() > room_) {
      std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return places[i]->worth; });
      for (std::size_t k = room_; k < order.size(); ++k) places[order[k]].reset();
      order.resize(room_);
    }
    room_ -= order.size();
  }

  std::uint32_t add(const Place& place) {
    side_.vertices.push_back(place.vertex);
    for (std::size_t g = 0; g < groups_; ++g)
      side_.all[g].push_back(place.rest[g] + place.direct[g]), side_.direct[g].push_back(place.direct[g]);
    return static_cast<std::uint32_t>(side_.vertices.size() - 1);
  }

  void cutEdges() {
    std::vector<std::optional<Place>> cuts(fresh_.size());
    parallelFor(fresh_.size(), kMeasured, [&](std::size_t i) { cuts[i] = cutOf(edges_[fresh_[i]]); });
    fitIntoRoom(cuts);
    for (std::size_t i = 0; i < fresh_.size(); ++i) {
      edges_[fresh_[i]].known = true;
      if (cuts[i]) edges_[fresh_[i]].corner = add(*cuts[i]);
    }
  }

  /// False: none of its edges is cut.
  bool cut(const std::array<std::uint32_t, 3>& t, std::vector<std::array<std::uint32_t, 3>>& out) {
    std::array<std::uint32_t, 3> on;
    std::size_t cuts = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      on[k] = edgeBetween(t[k], t[(k + 1) % 3]).corner;
      cuts += on[k] != kUncut;
    }
    if (cuts == 0) return false;
    if (cuts == 3) {
      out.insert(out.end(), {{t[0], on[0], on[2]}, {on[0], t[1], on[1]}, {on[2], on[1], t[2]}, {on[0], on[1], on[2]}});
      return true;
    }
    // From the corner on: the first edge is cut, and of two cuts the other is the second.
    std::size_t k = 0;
    while (on[k] == kUncut || (cuts == 2 && on[(k + 1) % 3] == kUncut)) ++k;
    const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], p = on[k], q = on[(k + 1) % 3];
    if (cuts == 1) {
      out.insert(out.end(), {{a, p, c}, {p, b, c}});
    } else {
      out.push_back({p, b, q});
      if (glm::length(at(a) - at(q)) < glm::length(at(p) - at(c)))
        out.insert(out.end(), {{a, p, q}, {a, q, c}});
      else
        out.insert(out.end(), {{a, p, c}, {p, q, c}});
    }
    return true;
  }

  /// Of a triangle whose edges are as they should be: nullopt where its middle is, too, or it is too small.
  std::optional<Place> middleOf(const std::array<std::uint32_t, 3>& t) const {
    const Vec3 a = at(t[0]), b = at(t[1]), c = at(t[2]);
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    if (glm::length(glm::cross(b - a, c - a)) < 2 * settings_.smallest * longest) return std::nullopt;
    if (!mayStep(t, longest)) return std::nullopt;
    Place place{side_.vertices[t[0]], {}, {}, {}};
    place.vertex.position = Vec3f((a + b + c) / 3.0);
    const auto mean = [&](const auto& of) { return (of(t[0]) + of(t[1]) + of(t[2])) / 3.0f; };
    place.vertex.normal = glm::normalize(mean([&](std::uint32_t v) { return side_.vertices[v].normal; }));
    place.vertex.uv = mean([&](std::uint32_t v) { return side_.vertices[v].uv; });
    place.vertex = onSurface(place.vertex);
    place.inside = Vec3(place.vertex.position);
    for (std::size_t g = 0; g < groups_; ++g) place.rest.push_back(mean([&](std::uint32_t v) { return restAt(g, v); }));
    measure(place);
    const Disagreement worst = disagreement(
        place, t, [&](std::size_t g) { return mean([&](std::uint32_t v) { return side_.direct[g][v]; }); });
    if (!(worst.most > threshold(longest))) return std::nullopt;
    place.worth = worst.most * longest;
    return place;
  }
  void cutMiddles(const std::vector<std::array<std::uint32_t, 3>>& whole,
                  std::vector<std::array<std::uint32_t, 3>>& next, std::vector<std::array<std::uint32_t, 3>>& done) {
    std::vector<std::optional<Place>> middles(whole.size());
    parallelFor(whole.size(), kMeasured, [&](std::size_t i) { middles[i] = middleOf(whole[i]); });
    fitIntoRoom(middles);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const auto& t = whole[i];
      if (!middles[i]) {
        done.push_back(t);
        continue;
      }
      const std::uint32_t m = add(*middles[i]);
      next.insert(next.end(), {{t[0], t[1], m}, {t[1], t[2], m}, {t[2], t[0], m}});
    }
  }

  LitSide& side_;
  const Shape& shape_;
  const bool front_;
  const DirectLight& light_;
  const Refinement& settings_;
  const std::size_t groups_;
  bool flat_ = false, mesh_ = false;
  std::size_t room_ = 0;  // for corners that may be added yet
  std::vector<Edge> edges_;
  std::unordered_map<std::uint64_t, std::uint32_t> edgeOf_;
  std::vector<std::uint32_t> fresh_;  // edges that nobody has looked at yet
};

}  // namespace

Refinement Refinement::of(const Scene& scene, double error) {
  Refinement out;
  out.error = error, out.smallest = kShadowEdge / scene.metresPerUnit, out.border = kBorderInset / scene.metresPerUnit;
  return out;
}

void LightFloors::add(const LitSide& side) {
  for (const auto& t : side.triangles) {
    const auto at = [&](std::size_t k) { return Vec3(side.vertices[t[k]].position); };
    const double area = 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    area_ += area;
    for (std::size_t g = 0; g < light_.size(); ++g)
      for (const std::uint32_t v : t) light_[g] += area / 3 * double(gray(side.all[g][v]));
  }
}

std::vector<double> LightFloors::floors() const {
  std::vector<double> out;
  for (const double light : light_) out.push_back(area_ > 0 ? direct::tuning::kFloor * light / area_ : 0);
  return out;
}

void refine(LitSide& side, const Shape& shape, bool front, const DirectLight& light, const Refinement& settings) {
  SideRefiner(side, shape, front, light, settings).run();
}

}  // namespace deltalux::exporting
