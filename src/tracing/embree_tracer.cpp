// Embree behind the interface: one Embree scene per group, joined as instances once there is more than one.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "tracing/embree_group.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::tracing {

namespace {

constexpr unsigned kOpaqueMask = static_cast<unsigned>(Passage::Opaque);  // [layout]
constexpr unsigned kAnyMask = ~0u;                                        // [layout]
constexpr std::size_t kBatchBlock = 1024;                                 // rays per task [task]
constexpr std::size_t kInFlight = 8;  // rays traced before the first is finished [task]

RTCRay embreeRay(const Ray& ray, unsigned mask) {
  RTCRay r;
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.tNear, r.tfar = ray.tFar, r.time = 0, r.mask = mask, r.id = 0, r.flags = 0;
  return r;
}

/// A closest-hit query on its way.
struct Pending {
  explicit Pending(const Ray& ray) : query(ray) {
    found.ray = embreeRay(ray, kAnyMask);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
  bool hit() const { return found.hit.geomID != RTC_INVALID_GEOMETRY_ID; }
  unsigned group() const { return found.hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? 0 : found.hit.instID[0]; }

  ClosestQuery query;
  RTCRayHit found;
};

class EmbreeTracer final : public RayTracer {
 public:
  explicit EmbreeTracer(const Scene& scene) : scene_(scene), device_(makeEmbreeDevice()) {
    groups_.emplace_back();
    build(0);
    join();
  }

  Hit closestHit(const Ray& ray) const override {
    count(1);
    Pending pending(ray);
    rtcIntersect1(top_, &pending.query, &pending.found);
    return finish(pending);
  }

  void closestHits(std::span<const Ray> rays, std::span<Hit> hits) const override {
    DELTALUX_CHECK(rays.size() == hits.size(), "one hit per ray");
    count(rays.size());
    const auto block = [&](std::size_t begin, std::size_t end) {
      for (std::size_t first = begin; first < end; first += kInFlight)
        traceFew(rays.subspan(first, std::min(kInFlight, end - first)), &hits[first]);
    };
    // A few rays are done before a task would have begun.
    if (rays.size() > kBatchBlock) return parallelBlocks(rays.size(), kBatchBlock, block);
    block(0, rays.size());
  }

  bool occluded(const Ray& ray) const override {
    count(1);
    RTCRay r = embreeRay(ray, kOpaqueMask);
    PassageQuery query(scene_, ray);
    rtcOccluded1(top_, &query, &r);
    return r.tfar < 0;
  }

  Rgb transmittance(const Ray& ray) const override { return passing(ray, top_).share; }
  Passing passing(const Ray& ray) const override { return passing(ray, top_); }

  Rgb transmittance(const Ray& ray, GroupId group) const override {
    return passing(ray, groups_[group.index()]->embreeScene()).share;
  }

  GroupId separate(std::span<const PrimitiveId> primitives) override {
    std::vector<PrimitiveId> own(primitives.begin(), primitives.end());
    std::sort(own.begin(), own.end());
    const GroupId fresh(groups_.size());
    groupOf_.resize(scene_.primitives.size(), GroupId(0));
    std::vector<bool> touched(groups_.size(), false);
    for (const PrimitiveId id : own) {
      DELTALUX_CHECK(id.index() < scene_.primitives.size(), "no such primitive");
      touched[groupOf_[id.index()].index()] = true;
      groupOf_[id.index()] = fresh;
    }
    groups_.emplace_back();
    touched.push_back(true);
    for (std::size_t g = 0; g < touched.size(); ++g)
      if (touched[g]) build(g);
    join();
    return fresh;
  }

  void rebuild(GroupId group) override {
    DELTALUX_CHECK(group.index() < groups_.size(), "no such group");
    build(group.index());
    join();
  }

  void rejoin() override {
    instances_.reset();
    groupOf_.clear(), groups_.resize(1);
    build(0);
    join();
  }

 private:
  /// What hits need from the tables is under way while the next rays are traced.
  void traceFew(std::span<const Ray> rays, Hit* hits) const {
    std::array<std::optional<Pending>, kInFlight> few;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Pending& pending = few[i].emplace(rays[i]);
      rtcIntersect1(top_, &pending.query, &pending.found);
      if (pending.hit()) groups_[pending.group()]->prefetch(pending.found.hit);
    }
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = finish(*few[i]);
  }

  Hit finish(const Pending& pending) const {
    return pending.hit() ? groups_[pending.group()]->hit(pending.query, pending.found.hit) : Hit{};
  }

  Passing passing(const Ray& ray, RTCScene scene) const {
    count(1);
    RTCRay r = embreeRay(ray, kAnyMask);
    PassageQuery query(scene_, ray);
    rtcOccluded1(scene, &query, &r);
    return r.tfar < 0 ? Passing{Rgb(0.0f), query.blocker, query.blockedAt} : Passing{query.passed, {}, 0};
  }

  void build(std::size_t group) {
    groupOf_.resize(scene_.primitives.size(), GroupId(0));  // primitives added since belong to the static rest
    std::vector<PrimitiveId> members;
    Box box;
    for (std::size_t i = 0; i < groupOf_.size(); ++i) {
      if (groupOf_[i].index() != group) continue;
      members.emplace_back(i);
      if (const Shape& shape = scene_.primitives[i].shape; area(shape) > 0) box.extend(bounds(shape));
    }
    if (!box.empty())
      extent_ = std::max({extent_, largestCoordinate(Vec3f(box.lower)), largestCoordinate(Vec3f(box.upper))});
    groups_[group] = std::make_unique<EmbreeGroup>(device_.get(), scene_, std::move(members), box, extent_);
  }

  void join() {
    const auto filled = std::count_if(groups_.begin(), groups_.end(), [](const auto& g) { return !g->empty(); });
    if (filled <= 1 && !groups_[0]->empty()) {
      // A top level would cost every ray a step.
      instances_.reset();
      top_ = groups_[0]->embreeScene();
      return;
    }
    instances_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(instances_.get(), RTC_SCENE_FLAG_ROBUST);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g]->empty()) continue;
      const EmbreeGeometry instance(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
      throwEmbreeError(device_.get());
      rtcSetGeometryInstancedScene(instance.get(), groups_[g]->embreeScene());
      rtcSetGeometryMask(instance.get(), kAnyMask);
      rtcCommitGeometry(instance.get());
      rtcAttachGeometryByID(instances_.get(), instance.get(), static_cast<unsigned>(g));
    }
    rtcCommitScene(instances_.get());
    throwEmbreeError(device_.get());
    top_ = instances_.get();
  }

  const Scene& scene_;
  EmbreeDevice device_;
  float extent_ = 0;  // the largest coordinate there was
  std::vector<std::unique_ptr<EmbreeGroup>> groups_;
  std::vector<GroupId> groupOf_;  // by primitive
  EmbreeScene instances_;
  RTCScene top_ = nullptr;  // the instances, or the static group alone
};

}  // namespace

std::unique_ptr<RayTracer> makeEmbreeTracer(const Scene& scene) { return std::make_unique<EmbreeTracer>(scene); }

}  // namespace deltalux::tracing
