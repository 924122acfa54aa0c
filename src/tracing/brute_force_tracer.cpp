// The test twin: every ray against every primitive, in double precision and by other means than the Embree tracer's.
// Polygons by their outline (never their triangulation), curved primitives by the implicit equation of their surface.
//
// Cost: O(n) per ray.
#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "base/square.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::tracing {

namespace {

struct Meeting {
  double t;
  Vec3 normal;
  std::uint32_t triangle = 0;
};

/// Calls visit(t) for the real roots of a t^2 + b t + c.
template <class Visit>
void forRoots(double a, double b, double c, const Visit& visit) {
  if (a == 0) {
    if (b != 0) visit(-c / b);
    return;
  }
  const double discriminant = square(b) - 4 * a * c;
  if (discriminant < 0) return;
  // The root without cancellation first; the other by Vieta.
  const double u = b < 0 ? (-b + std::sqrt(discriminant)) / 2 : (-b - std::sqrt(discriminant)) / 2;
  visit(u / a);
  if (u != 0) visit(c / u);
}

/// Whether the outline winds around `p` an odd number of times, seen along the axis that `normal` is nearest to.
bool insideOutline(const std::vector<Vec3>& outline, const Vec3& normal, const Vec3& p) {
  const Vec3 size = glm::abs(normal);
  const int k = size.z >= size.x && size.z >= size.y ? 2 : (size.y >= size.x ? 1 : 0);
  const int x = k == 0 ? 1 : 0, y = k == 2 ? 1 : 2;
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    // Each edge in one direction only, so that the two passes along a seam agree.
    const Vec3 *a = &outline[i], *b = &outline[i + 1 < outline.size() ? i + 1 : 0];
    if ((*a)[y] > (*b)[y] || ((*a)[y] == (*b)[y] && (*a)[x] > (*b)[x])) std::swap(a, b);
    if (((*a)[y] > p[y]) == ((*b)[y] > p[y])) continue;
    const double crossing = (*a)[x] + (p[y] - (*a)[y]) / ((*b)[y] - (*a)[y]) * ((*b)[x] - (*a)[x]);
    if (p[x] < crossing) inside = !inside;
  }
  return inside;
}

template <class Visit>
void meet(const Polygon& s, const Vec3& o, const Vec3& d, const Visit& visit) {
  const double t = glm::dot(s.vertices[0] - o, s.normal) / glm::dot(d, s.normal);
  if (std::isfinite(t) && insideOutline(s.vertices, s.normal, o + t * d)) visit(Meeting{t, s.normal});
}

template <class Visit>
void meet(const Sphere& s, const Vec3& o, const Vec3& d, const Visit& visit) {
  const Vec3 f = o - s.center;
  forRoots(glm::dot(d, d), 2 * glm::dot(f, d), glm::dot(f, f) - square(s.radius), [&](double t) {
    visit(Meeting{t, (s.inward ? -1.0 : 1.0) * glm::normalize(f + t * d)});
  });
}

/// Cylinders and cones: points whose distance from the axis is r0 + (r1 - r0) h, with h in [0,1] along the axis.
template <class Visit>
void meetRound(const Vec3& p0, const Vec3& p1, double r0, double r1, bool inward, const Vec3& o, const Vec3& d,
               const Visit& visit) {
  const Vec3 axis = p1 - p0;
  const double squared = glm::dot(axis, axis);
  const auto along = [&](const Vec3& v) { return glm::dot(v, axis) / squared; };
  const Vec3 f = o - p0;
  const double hf = along(f), hd = along(d);
  const Vec3 fAcross = f - hf * axis, dAcross = d - hd * axis;
  const double rf = r0 + (r1 - r0) * hf, rd = (r1 - r0) * hd;
  forRoots(glm::dot(dAcross, dAcross) - rd * rd, 2 * (glm::dot(fAcross, dAcross) - rf * rd),
           glm::dot(fAcross, fAcross) - rf * rf, [&](double t) {
             const double h = hf + t * hd;
             if (!(h >= 0 && h <= 1)) return;
             // Gradient of distance from the axis less radius.
             const Vec3 gradient = glm::normalize(fAcross + t * dAcross) - (r1 - r0) / squared * axis;
             visit(Meeting{t, (inward ? -1.0 : 1.0) * glm::normalize(gradient)});
           });
}

template <class Visit>
void meet(const Cylinder& s, const Vec3& o, const Vec3& d, const Visit& visit) {
  meetRound(s.p0, s.p1, s.radius, s.radius, s.inward, o, d, visit);
}

template <class Visit>
void meet(const Cone& s, const Vec3& o, const Vec3& d, const Visit& visit) {
  meetRound(s.p0, s.p1, s.radius0, s.radius1, s.inward, o, d, visit);
}

template <class Visit>
void meet(const Ring& s, const Vec3& o, const Vec3& d, const Visit& visit) {
  const double t = glm::dot(s.center - o, s.normal) / glm::dot(d, s.normal);
  const double r = glm::distance(o + t * d, s.center);
  if (r >= s.innerRadius && r <= s.outerRadius) visit(Meeting{t, s.normal});
}

template <class Visit>
void meet(const Mesh& s, const Vec3& o, const Vec3& d, const Visit& visit) {
  for (std::uint32_t i = 0; i < s.triangles.size(); ++i) {
    const auto& [ia, ib, ic] = s.triangles[i];
    const Vec3 a = s.positions[ia] - o, b = s.positions[ib] - o, c = s.positions[ic] - o;
    // The ray's line passes on the same side of all three edges.
    const double va = glm::dot(d, glm::cross(b, c)), vb = glm::dot(d, glm::cross(c, a)),
                 vc = glm::dot(d, glm::cross(a, b));
    if (!((va >= 0 && vb >= 0 && vc >= 0) || (va <= 0 && vb <= 0 && vc <= 0)) || va + vb + vc == 0) continue;
    const Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    visit(Meeting{glm::dot(a, normal) / glm::dot(d, normal), normal, i});
  }
}

class BruteForceTracer final : public RayTracer {
 public:
  explicit BruteForceTracer(const Scene& scene) : scene_(scene) { rebuild(GroupId(0)); }

  Hit closestHit(const Ray& ray) const override {
    Hit best;
    double nearest = kInfinity;
    forMeetings(ray, [&](const Snapshot& from, const Meeting& m) {
      if (!(m.t < nearest)) return true;
      nearest = m.t;
      best.t = static_cast<float>(m.t);
      best.primitive = from.primitive;
      best.triangle = m.triangle;
      best.position = Vec3f(Vec3(ray.origin) + m.t * Vec3(ray.direction));
      best.normal = Vec3f(m.normal);
      best.front = glm::dot(m.normal, Vec3(ray.direction)) < 0;
      return true;
    });
    return best;
  }

  bool occluded(const Ray& ray) const override {
    return !forMeetings(ray, [&](const Snapshot& from, const Meeting&) { return isPane(from); });
  }

  Rgb transmittance(const Ray& ray) const override {
    return passed(ray, [](const Snapshot&) { return true; }).share;
  }
  Passing passing(const Ray& ray) const override {
    return passed(ray, [](const Snapshot&) { return true; });
  }
  Rgb transmittance(const Ray& ray, GroupId group) const override {
    return passed(ray, [&](const Snapshot& from) { return from.group == group; }).share;
  }

  GroupId separate(std::span<const PrimitiveId> primitives) override {
    const GroupId fresh(groups_++);
    addNew();
    for (Snapshot& s : snapshots_)
      if (std::find(primitives.begin(), primitives.end(), s.primitive) != primitives.end()) s.group = fresh;
    rebuild(fresh);
    return fresh;
  }

  void rebuild(GroupId group) override {
    DELTALUX_CHECK(group.index() < groups_, "no such group");
    addNew();
    for (Snapshot& s : snapshots_)
      if (s.group == group) s.shape = scene_[s.primitive].shape;
  }

  void rejoin() override {
    groups_ = 1;
    for (Snapshot& s : snapshots_) s.group = GroupId(0);
    rebuild(GroupId(0));
  }

 private:
  struct Snapshot {
    PrimitiveId primitive;
    GroupId group;
    Shape shape;
  };

  void addNew() {
    for (std::size_t i = snapshots_.size(); i < scene_.primitives.size(); ++i)
      snapshots_.push_back({PrimitiveId(i), GroupId(0), {}});
  }

  bool isPane(const Snapshot& s) const { return passesStraight(scene_.materialOf(s.primitive)); }

  /// visit(snapshot, meeting) for everything on the segment, until one call returns false; false then.
  template <class Visit>
  bool forMeetings(const Ray& ray, const Visit& visit) const {
    count(1);
    const Vec3 origin(ray.origin), direction(ray.direction);
    bool goOn = true;
    for (const Snapshot& s : snapshots_) {
      if (!(area(s.shape) > 0)) continue;
      const auto onSegment = [&](const Meeting& m) {
        const auto t = static_cast<float>(m.t);
        if (goOn && t >= ray.tNear && t <= ray.tFar) goOn = visit(s, m);
      };
      std::visit([&](const auto& shape) { meet(shape, origin, direction, onSegment); }, s.shape);
      if (!goOn) return false;
    }
    return true;
  }

  template <class Counts>
  Passing passed(const Ray& ray, const Counts& counts) const {
    Rgb product(1.0f);
    PrimitiveId blocker;
    float t = 0;
    const bool through = forMeetings(ray, [&](const Snapshot& from, const Meeting& m) {
      if (!counts(from)) return true;
      blocker = from.primitive, t = static_cast<float>(m.t);
      if (!isPane(from)) return false;
      const double cosine = std::abs(glm::dot(m.normal, Vec3(ray.direction)));
      product *= straightTransmittance(scene_.materialOf(from.primitive), std::clamp(cosine, 1e-6, 1.0));
      return true;
    });
    return through ? Passing{product, isBlack(product) ? blocker : PrimitiveId(), t} : Passing{Rgb(0.0f), blocker, t};
  }

  const Scene& scene_;
  std::size_t groups_ = 1;
  std::vector<Snapshot> snapshots_;
};

}  // namespace

std::unique_ptr<RayTracer> makeBruteForceTracer(const Scene& scene) {
  return std::make_unique<BruteForceTracer>(scene);
}

}  // namespace deltalux::tracing
