#include "export/refine.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
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
constexpr std::size_t kRoom = 16384;           // for corners that are added to all sides, [limit]
constexpr std::size_t kVerticesPerRoom = 64;   // and one more for so many that are there [limit]
constexpr std::size_t kMeasured = 64;          // places of a task [task]
constexpr float kChannels = 3;                 // whose sum light is compared by [layout]
constexpr int kLooks = 8;                      // parts of an edge that is cut [task]
constexpr double kLeastWay = 0.05;             // of the way inside that a border's corner is moved at most [rounding]
constexpr double kOfScene = 5e-4;              // of a scene's diagonal: finer than that nothing is cut [limit]
constexpr float kAlike = 0.5f;                 // of the most light around a corner: above it no shadow is there [task]
constexpr double kOnePlane = 0.9999;           // cosine between normals of a flat triangle [rounding]

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
  SideRefiner(const SideToRefine& to, const DirectLight& light, const Refinement& settings)
      : side_(*to.side),
        shape_(*to.shape),
        front_(to.front),
        keepsShape_(to.keepsShape),
        light_(light),
        settings_(settings),
        groups_(to.side->all.size()) {
    flat_ = std::holds_alternative<Polygon>(shape_) || std::holds_alternative<Ring>(shape_);
    mesh_ = std::holds_alternative<Mesh>(shape_);
  }

  /// Measures light at the corners that are there.
  void begin() {
    registerEdges(side_.triangles);
    measureCorners();
    if (!mayBeCut()) return;
    active_ = side_.triangles, activeFrom_.resize(active_.size());
    std::iota(activeFrom_.begin(), activeFrom_.end(), 0u);
    besides_.resize(side_.vertices.size());
    std::iota(besides_.begin(), besides_.end(), 0u);
  }
  bool done() const { return active_.empty(); }

  // A pass: first all edges that nobody has looked at yet, then the middles of triangles whose edges are as they should
  // be. Of what is proposed, those places are taken that are worth more than the least.

  void proposeEdges() {
    proposed_.assign(fresh_.size(), std::nullopt);
    if (done()) return proposed_.clear();
    parallelFor(fresh_.size(), kMeasured, [&](std::size_t i) { proposed_[i] = cutOf(edges_[fresh_[i]]); });
  }
  void takeEdges(double least) {
    for (std::size_t i = 0; i < proposed_.size(); ++i) {
      edges_[fresh_[i]].known = true;
      if (proposed_[i] && proposed_[i]->worth > least)
        edges_[fresh_[i]].corner = add(*proposed_[i], edges_[fresh_[i]].a);
    }
    whole_.clear(), next_.clear(), wholeFrom_.clear(), nextFrom_.clear();
    for (std::size_t i = 0; i < active_.size(); ++i) {
      if (!cut(active_[i], next_)) whole_.push_back(active_[i]), wholeFrom_.push_back(activeFrom_[i]);
      nextFrom_.resize(next_.size(), activeFrom_[i]);
    }
  }
  void proposeMiddles() {
    proposed_.assign(whole_.size(), std::nullopt);
    parallelFor(whole_.size(), kMeasured, [&](std::size_t i) { proposed_[i] = middleOf(whole_[i]); });
  }
  void takeMiddles(double least) {
    for (std::size_t i = 0; i < whole_.size(); ++i) {
      const auto& t = whole_[i];
      if (!proposed_[i] || !(proposed_[i]->worth > least)) {
        done_.push_back(t), doneFrom_.push_back(wholeFrom_[i]);
        continue;
      }
      const std::uint32_t m = add(*proposed_[i], t[0]);
      next_.insert(next_.end(), {{t[0], t[1], m}, {t[1], t[2], m}, {t[2], t[0], m}});
      nextFrom_.resize(next_.size(), wholeFrom_[i]);
    }
    registerEdges(next_);
    active_ = std::move(next_), activeFrom_ = std::move(nextFrom_);
  }
  void worths(std::vector<double>& out) const {
    for (const std::optional<Place>& p : proposed_)
      if (p) out.push_back(p->worth);
  }

  void end() {
    if (done_.empty() && active_.empty()) return;
    done_.insert(done_.end(), active_.begin(), active_.end());
    doneFrom_.insert(doneFrom_.end(), activeFrom_.begin(), activeFrom_.end());
    // Parts of a triangle stand where it stood: neighbours follow each other, and pack well.
    std::vector<std::uint32_t> order(done_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return doneFrom_[i]; });
    side_.triangles.clear();
    for (const std::uint32_t i : order) side_.triangles.push_back(done_[i]);
    done_.clear(), active_.clear();
    orderCorners();
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
  /// What else there is of a group's light: its own that is not measured, or what of all is worth as much.
  float ambientOf(std::size_t g, const std::vector<Rgb>& rest) const {
    float all = 0;
    for (const Rgb& r : rest) all += gray(r);
    return std::max({gray(rest[g]), static_cast<float>(settings_.share) * all, floorOf(g)});
  }
  float ambientAt(std::size_t g, std::uint32_t v) const {
    float all = 0;
    for (std::size_t i = 0; i < groups_; ++i) all += gray(restAt(i, v));
    return std::max({gray(restAt(g, v)), static_cast<float>(settings_.share) * all, floorOf(g)});
  }
  using Doubt = direct::LampMeter::Doubt;
  direct::LampMeter::Reading measured(std::size_t g, const Place& place, Doubt doubt = Doubt::Much) const {
    return light_.read(g, place.inside, Vec3(place.vertex.normal), ambientOf(g, place.rest), settings_.error, doubt);
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
    const std::vector<std::vector<Corner>> corners = cornersByGroup();
    std::vector<std::vector<Rgb>> found(groups_, std::vector<Rgb>(side_.vertices.size(), Rgb(0.0f)));
    parallelFor(side_.vertices.size(), kMeasured, [&](std::size_t v) {
      Place place{side_.vertices[v], Vec3(side_.vertices[v].position), {}, {}, 0};
      if (border[v] && counts[v] > 0) place.inside = moved(place.vertex, middles[v] / double(counts[v]));
      for (std::size_t g = 0; g < groups_; ++g) place.rest.push_back(restAt(g, static_cast<std::uint32_t>(v)));
      for (std::size_t g = 0; g < groups_; ++g)
        if (corners[g][v] != Corner::Dark)
          found[g][v] = measured(g, place, corners[g][v] == Corner::Lit ? Doubt::Little : Doubt::Much).E;
    });
    for (std::size_t g = 0; g < groups_; ++g)
      for (std::size_t v = 0; v < side_.vertices.size() && light_.measures(g); ++v)
        side_.all[g][v] += found[g][v] - side_.direct[g][v], side_.direct[g][v] = found[g][v];
  }

  /// What the solution's own rays have found of a group at a corner and at those around it: nothing, which costs no
  /// rays; light everywhere; or both, or nobody knows.
  enum class Corner : char { Dark, Lit, Mixed };
  std::vector<std::vector<Corner>> cornersByGroup() const {
    const std::size_t count = side_.vertices.size();
    std::vector<char> known(count, 0);
    for (std::size_t g = 0; g < groups_; ++g)
      for (std::size_t v = 0; v < count; ++v) known[v] |= !isBlack(side_.all[g][v]);
    std::vector<std::vector<Corner>> out(groups_, std::vector<Corner>(count, Corner::Dark));
    for (std::size_t g = 0; g < groups_; ++g) {
      if (!light_.measures(g)) continue;
      std::vector<float> least(count, std::numeric_limits<float>::infinity()), most(count, 0.0f);
      for (const auto& t : side_.triangles)
        for (const std::uint32_t v : t)
          for (const std::uint32_t w : t) {
            const float E = known[w] ? sumOf(side_.direct[g][w]) : -1;
            least[v] = std::min(least[v], E), most[v] = std::max(most[v], E);
          }
      for (std::size_t v = 0; v < count; ++v)
        if (least[v] < 0 || (most[v] > 0 && least[v] < kAlike * most[v]))
          out[g][v] = Corner::Mixed;
        else if (most[v] > 0)
          out[g][v] = Corner::Lit;
    }
    return out;
  }

  /// Not where normals bend between corners, which light does with them, and shadows do not.
  bool mayBeCut() const {
    if (keepsShape_) return false;
    return !mesh_ || std::ranges::all_of(side_.triangles, [&](const std::array<std::uint32_t, 3>& t) {
      const Vec3 n = glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
      return std::ranges::all_of(
          t, [&](std::uint32_t v) { return glm::dot(Vec3(side_.vertices[v].normal), n) > kOnePlane * glm::length(n); });
    });
  }

  /// Its light is linear between the ends.
  Place placeOn(const Edge& e, double t) const {
    Place place{vertexBetween(e.a, e.b, t), {}, {}, {}, 0};
    place.inside = insideAt(e, place.vertex);
    for (std::size_t g = 0; g < groups_; ++g) {
      place.rest.push_back(between(restAt(g, e.a), restAt(g, e.b), static_cast<float>(t)));
      place.direct.push_back(between(side_.direct[g][e.a], side_.direct[g][e.b], static_cast<float>(t)));
    }
    return place;
  }
  Vec3 insideAt(const Edge& e, const MeshVertex& v) const {
    return e.border ? moved(v, at(e.opposite)) : Vec3(v.position);
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
  /// Measures these groups at a place that has linear light: how far off that was.
  Disagreement disagreement(Place& place, std::span<const std::uint32_t> corners,
                            std::span<const std::size_t> groups) const {
    Disagreement worst;
    const float total = totalOf(place.rest, place.direct);
    for (const std::size_t g : groups) {
      const direct::LampMeter::Reading read = measured(g, place);
      const float off = differenceOf(read.E, place.direct[g]);
      place.direct[g] = read.E;
      if (!(off > 0)) continue;
      // Rays tell light in a shadow to so much of what would be there without it, and an eye sees no less beside it.
      const float there =
          std::max(sumOf(place.rest[g]) + sumOf(place.direct[g]), kChannels * 0.5f * static_cast<float>(read.open));
      const float allowed = allowedFor(g, corners, there, total);
      if (off / allowed > worst.most) worst = {off / allowed, g};
    }
    return worst;
  }

  /// How far off light has to be for an edge of that length to be cut, over what is allowed: of short ones, only what
  /// stands out is worth it, and what rays are off by would never end.
  double threshold(double length) const { return std::max(1.0, kVisible * settings_.smallest / length); }
  /// Groups whose light corners tell apart by so much that there is something to look for between them.
  std::vector<std::size_t> groupsThatMayStep(std::span<const std::uint32_t> corners, double length) const {
    float total = 0;
    for (std::size_t g = 0; g < groups_; ++g) total += sumOf(side_.all[g][corners[0]]);
    std::vector<std::size_t> found;
    for (std::size_t g = 0; g < groups_; ++g) {
      const auto least = static_cast<float>(threshold(length)) * allowedFor(g, corners, 0, total);
      if (std::ranges::any_of(corners, [&](std::uint32_t v) {
            return differenceOf(side_.direct[g][v], side_.direct[g][corners[0]]) > least;
          }))
        found.push_back(g);
    }
    return found;
  }

  /// Where an edge is to be cut for this group: at a step, or where its light is furthest from linear.
  double cutFor(std::size_t g, const Edge& e, double length) const {
    const Rgb first = side_.direct[g][e.a], last = side_.direct[g][e.b];
    const float ambient = std::max(ambientAt(g, e.a), ambientAt(g, e.b));
    const auto lookAt = [&](double t) {
      const MeshVertex v = vertexBetween(e.a, e.b, t);
      return light_.read(g, insideAt(e, v), Vec3(v.normal), ambient, settings_.error).E;
    };
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
    const std::array ends{e.a, e.b};
    const std::vector<std::size_t> groups = groupsThatMayStep(ends, length);
    if (groups.empty()) return std::nullopt;
    Place place = placeOn(e, 0.5);
    const Disagreement worst = disagreement(place, ends, groups);
    if (!(worst.most > threshold(length))) return std::nullopt;
    const double least = 0.5 * settings_.smallest / length;
    const double t = std::clamp(cutFor(worst.group, e, length), least, 1 - least);
    if (t != 0.5) {
      place = placeOn(e, t);
      for (const std::size_t g : groups) place.direct[g] = measured(g, place).E;
    }
    place.worth = worst.most * length;
    return place;
  }

  std::uint32_t add(const Place& place, std::uint32_t beside) {
    besides_.push_back(besides_[beside]);
    side_.vertices.push_back(place.vertex);
    for (std::size_t g = 0; g < groups_; ++g)
      side_.all[g].push_back(place.rest[g] + place.direct[g]), side_.direct[g].push_back(place.direct[g]);
    return static_cast<std::uint32_t>(side_.vertices.size() - 1);
  }

  /// Added corners follow those that they were added beside.
  void orderCorners() {
    std::vector<std::uint32_t> order(side_.vertices.size()), number(order.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t v) { return besides_[v]; });
    for (std::uint32_t i = 0; i < order.size(); ++i) number[order[i]] = i;
    const auto put = [&](auto& values) {
      auto now = values;
      for (std::size_t i = 0; i < order.size(); ++i) now[i] = values[order[i]];
      values = std::move(now);
    };
    put(side_.vertices);
    for (auto& layer : side_.all) put(layer);
    for (auto& layer : side_.direct) put(layer);
    for (auto& t : side_.triangles)
      for (std::uint32_t& v : t) v = number[v];
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
    const std::vector<std::size_t> groups = groupsThatMayStep(t, longest);
    if (groups.empty()) return std::nullopt;
    Place place{side_.vertices[t[0]], {}, {}, {}, 0};
    place.vertex.position = Vec3f((a + b + c) / 3.0);
    const auto mean = [&](const auto& of) { return (of(t[0]) + of(t[1]) + of(t[2])) / 3.0f; };
    place.vertex.normal = glm::normalize(mean([&](std::uint32_t v) { return side_.vertices[v].normal; }));
    place.vertex.uv = mean([&](std::uint32_t v) { return side_.vertices[v].uv; });
    place.vertex = onSurface(place.vertex);
    place.inside = Vec3(place.vertex.position);
    for (std::size_t g = 0; g < groups_; ++g) {
      place.rest.push_back(mean([&](std::uint32_t v) { return restAt(g, v); }));
      place.direct.push_back(mean([&](std::uint32_t v) { return side_.direct[g][v]; }));
    }
    const Disagreement worst = disagreement(place, t, groups);
    if (!(worst.most > threshold(longest))) return std::nullopt;
    place.worth = worst.most * longest;
    return place;
  }
  LitSide& side_;
  const Shape& shape_;
  const bool front_, keepsShape_;
  const DirectLight& light_;
  const Refinement& settings_;
  const std::size_t groups_;
  bool flat_ = false, mesh_ = false;
  std::vector<Edge> edges_;
  std::unordered_map<std::uint64_t, std::uint32_t> edgeOf_;
  std::vector<std::uint32_t> fresh_;                                        // edges that nobody has looked at yet
  std::vector<std::array<std::uint32_t, 3>> active_, whole_, next_, done_;  // triangles
  std::vector<std::uint32_t> besides_;  // by corner: the one that was there before that it follows
  std::vector<std::uint32_t> activeFrom_, wholeFrom_, nextFrom_, doneFrom_;  // the triangles that they are parts of
  std::vector<std::optional<Place>> proposed_;                               // by fresh edge, or by whole triangle
};

}  // namespace

Refinement Refinement::of(const Scene& scene, double error) {
  Refinement out;
  out.error = error, out.border = kBorderInset / scene.metresPerUnit;
  Box box;
  for (const Primitive& p : scene.primitives) {
    const Box own = bounds(p.shape);
    if (!own.empty()) box.extend(own.lower), box.extend(own.upper);
  }
  out.smallest = std::max(kShadowEdge / scene.metresPerUnit, box.empty() ? 0.0 : kOfScene * box.diagonal());
  return out;
}

void LightFloors::add(const LitSide& side) {
  for (const auto& t : side.triangles)
    add({&side.vertices[t[0]], &side.vertices[t[1]], &side.vertices[t[2]]}, t, side.all);
}

void LightFloors::add(const std::array<const MeshVertex*, 3>& corners, const std::array<std::uint32_t, 3>& numbers,
                      const std::vector<std::vector<Rgb>>& layers) {
  const auto at = [&](std::size_t k) { return Vec3(corners[k]->position); };
  const double area = 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
  area_ += area;
  for (std::size_t g = 0; g < light_.size(); ++g)
    for (const std::uint32_t v : numbers) light_[g] += area / 3 * double(gray(layers[g][v]));
}

std::vector<double> LightFloors::floors() const {
  std::vector<double> out;
  for (const double light : light_) out.push_back(area_ > 0 ? direct::tuning::kFloor * light / area_ : 0);
  return out;
}

void refine(std::span<const SideToRefine> sides, const DirectLight& light, const Refinement& settings) {
  std::vector<std::unique_ptr<SideRefiner>> work(sides.size());
  std::size_t room = kRoom;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    work[s] = std::make_unique<SideRefiner>(sides[s], light, settings);
    room += sides[s].side->vertices.size() / kVerticesPerRoom;
  }
  const auto each = [&](const auto& step) { parallelFor(work.size(), 1, [&](std::size_t s) { step(*work[s]); }); };
  // The worth of proposals that there is no room for any more.
  const auto least = [&] {
    std::vector<double> worths;
    for (const auto& side : work) side->worths(worths);
    const std::size_t taken = std::min(room, worths.size());
    room -= taken;
    if (taken == worths.size()) return -kInfinity;
    const auto first = worths.begin() + static_cast<std::ptrdiff_t>(taken);
    std::ranges::nth_element(worths, first, std::ranges::greater());
    return *first;
  };
  each([](SideRefiner& side) { side.begin(); });
  for (int pass = 0; pass < kMostCuts && room > 0; ++pass) {
    std::erase_if(work, [](const auto& side) {
      if (side->done()) side->end();
      return side->done();
    });
    if (work.empty()) break;
    each([](SideRefiner& side) { side.proposeEdges(); });
    const double edges = least();
    each([&](SideRefiner& side) { side.takeEdges(edges), side.proposeMiddles(); });
    const double middles = least();
    each([&](SideRefiner& side) { side.takeMiddles(middles); });
  }
  each([](SideRefiner& side) { side.end(); });
}

void refine(LitSide& side, const Shape& shape, bool front, const DirectLight& light, const Refinement& settings) {
  const SideToRefine one{&side, &shape, front, settings.keepsShape};
  refine(std::span(&one, 1), light, settings);
}

}  // namespace deltalux::exporting
