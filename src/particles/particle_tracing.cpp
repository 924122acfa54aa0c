#include "particles/particle_tracing.hpp"

#include <algorithm>
#include <map>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "particles/plan_particles.hpp"
#include "particles/segment_box.hpp"
#include "particles/trace.hpp"

namespace deltalux {

namespace {

constexpr double kMargin = 1e-5;  // of the far distance: rays start and end a little off the points they join

/// Whether a change from one to the other leaves all particles as they are.
bool emitAlike(const Material& a, const Material& b) {
  const auto sendAlike = [&](bool front) {
    return isBlack(diffuseReflectance(a, front)) == isBlack(diffuseReflectance(b, front));
  };
  if (a.emission != b.emission || a.surface.index() != b.surface.index()) return false;
  if (isBlack(diffuseTransmittance(a)) != isBlack(diffuseTransmittance(b)) || !sendAlike(true) || !sendAlike(false))
    return false;
  if (const auto* x = std::get_if<Opaque>(&a.surface)) return x->specular == std::get<Opaque>(b.surface).specular;
  if (const auto* x = std::get_if<Trans>(&a.surface)) {
    const auto& y = std::get<Trans>(b.surface);
    return x->reflection == y.reflection && x->transmission == y.transmission;
  }
  return a.surface == b.surface;
}

/// Where things were and where they are now.
class Motions {
 public:
  Motions(const Scene& scene, std::span<const SceneChange::Moved> moved) {
    const double margin = kMargin * farDistance(scene);
    const auto add = [&](const Box& box, std::vector<SegmentBox>& boxes) {
      if (!box.empty()) boxes.emplace_back(box, margin);
    };
    for (const SceneChange::Moved& m : moved) panes_ = panes_ || isThinGlass(scene.materialOf(m.primitive));
    if (moved.size() <= kOwnBoxes) {
      for (const SceneChange::Moved& m : moved) add(m.before, before_), add(m.after, after_);
      return;
    }
    const std::vector<std::uint32_t> top = topObjects(scene);
    std::map<std::uint32_t, std::pair<Box, Box>> byObject;
    for (const SceneChange::Moved& m : moved) {
      auto& [before, after] = byObject[top[m.primitive.index()]];
      before.extend(m.before), after.extend(m.after);
    }
    for (const auto& [object, both] : byObject) add(both.first, before_), add(both.second, after_);
  }

  /// Whether a path can go otherwise now.
  bool touch(std::span<const Vec3f> v, std::uint8_t fate) const {
    for (const SegmentBox& box : after_)
      for (std::size_t i = 0; i + 1 < v.size(); ++i)
        if (box.meets(v[i], v[i + 1])) return true;
    // Where a segment ended it met something first, so nothing that moved stood on the way but for panes.
    const bool throughOnly = (fate & kFirstEnd) && !panes_;
    for (const SegmentBox& box : before_) {
      if (!throughOnly && v.size() > 1 && box.meets(v[0], v[1])) return true;
      for (std::size_t i = 1; i < v.size(); ++i)
        if (box.holds(v[i])) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kOwnBoxes = 8;  // more things share one box
  std::vector<SegmentBox> before_, after_;
  bool panes_ = false;
};

}  // namespace

ParticleTracing::Ends::Ends(const Scene& scene, const RayTracer& tracer)
    : lights(scene), senders(scene, lights), receivers(scene), emission(scene, tracer, senders, receivers) {}

ParticleTracing::Look::Look(const Scene& scene)
    : materials(scene.materials), lights(scene.lights), primitives(scene.primitives.size()), far(farDistance(scene)) {}

ParticleTracing::ParticleTracing(const Scene& scene, const RayTracer& tracer, const ParticleSettings& settings)
    : scene_(scene), tracer_(tracer), settings_(settings), ends_(std::make_unique<Ends>(scene, tracer)), look_(scene) {}

Particles ParticleTracing::trace() {
  Particles p = planParticles(scene_, tracer_, settings_);
  if (p.paths() == 0) return p;
  weigh(p);
  tracePaths(scene_, tracer_, ends_->emission, settings_.maxDepth, p);
  return p;
}

void ParticleTracing::weigh(const Particles& p) {
  Senders& senders = ends_->senders;
  std::vector<float> strengths = skyStrengths(scene_, senders);
  DELTALUX_CHECK(strengths.size() == p.nominal.size(), "particles of this scene");
  const auto surfaces = static_cast<std::ptrdiff_t>(senders.surfaceCells());
  std::copy(p.nominal.begin() + surfaces, p.nominal.end(), strengths.begin() + surfaces);
  senders.weigh(strengths);
  weighed_ = true;
}

bool ParticleTracing::looksAsBefore(const SceneChange& change) const {
  if (look_.primitives != scene_.primitives.size() || look_.lights.size() != scene_.lights.size() ||
      look_.materials.size() != scene_.materials.size() || look_.far != farDistance(scene_))
    return false;
  const auto lightAsBefore = [&](LightId l) { return look_.lights[l.index()].emitter == scene_[l].emitter; };
  const auto materialAsBefore = [&](MaterialId m) { return emitAlike(look_.materials[m.index()], scene_[m]); };
  return std::all_of(change.lights.begin(), change.lights.end(), lightAsBefore) &&
         std::all_of(change.materials.begin(), change.materials.end(), materialAsBefore);
}

std::vector<std::uint32_t> ParticleTracing::touchedPaths(const Particles& p,
                                                         std::span<const SceneChange::Moved> moved) {
  std::vector<PrimitiveId> primitives;
  for (const SceneChange::Moved& m : moved) primitives.push_back(m.primitive);
  const std::vector<char> senderMoved = ends_->senders.follow(primitives);
  using Motion = Receivers::Motion;
  const std::vector<Motion> motion = ends_->receivers.follow(primitives);
  const Motions motions(scene_, moved);
  const auto touched = [&](std::size_t path) {
    const Motion m = motion[p.links[p.link[path]].ends.receiver];
    const std::span<const Vec3f> v = p.verticesOf(path);
    // A path that was never begun may be possible now.
    if (senderMoved[p.sender[path]] || m == Motion::Bound || (m == Motion::Below && v.empty())) return true;
    return motions.touch(v, p.fate[path]);
  };
  constexpr std::size_t kBlock = 8192;
  std::vector<std::vector<std::uint32_t>> found((p.paths() + kBlock - 1) / kBlock);
  parallelBlocks(p.paths(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t path = begin; path < end; ++path)
      if (touched(path)) found[begin / kBlock].push_back(static_cast<std::uint32_t>(path));
  });
  std::vector<std::uint32_t> all;
  for (const auto& block : found) all.insert(all.end(), block.begin(), block.end());
  return all;
}

ParticleUpdate ParticleTracing::follow(Particles& p, const SceneChange& change) {
  ParticleUpdate update;
  if (!looksAsBefore(change)) {
    update.all = true;
    ends_ = std::make_unique<Ends>(scene_, tracer_);
    look_ = Look(scene_);
    p = trace();
    update.rays = p.rays + p.looks, update.particles = p.arrived();
    return update;
  }
  if (p.paths() == 0) return update;
  if (!weighed_) weigh(p);
  const std::vector<std::uint32_t> paths = touchedPaths(p, change.moved);
  update.paths.reserve(paths.size());
  for (const std::uint32_t path : paths)
    update.paths.push_back({path, p.sender[path], p.originTriangle[path], p.range[path]});
  std::vector<std::uint8_t> arrived;
  for (const std::uint32_t path : paths) arrived.push_back(p.fate[path] & kArrived);
  const std::uint64_t before = p.rays;
  retracePaths(scene_, tracer_, ends_->emission, settings_.maxDepth, p, paths);
  update.rays = p.rays - before;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (arrived[i] || (p.fate[paths[i]] & kArrived)) ++update.particles;
  return update;
}

Particles traceParticles(const Scene& scene, const RayTracer& tracer, const ParticleSettings& settings) {
  return ParticleTracing(scene, tracer, settings).trace();
}

}  // namespace deltalux
