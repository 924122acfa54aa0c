#include "particles/particle_tracing.hpp"

#include <algorithm>
#include <optional>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "particles/moved_shapes.hpp"
#include "particles/plan_particles.hpp"
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

/// Finds what a motion can touch. A path is asked for what it met; where things are now, its segments are held against.
class Motions {
 public:
  using Motion = Receivers::Motion;

  Motions(const Scene& scene, std::span<const SceneChange::Moved> moved, const Particles& p,
          const std::vector<Motion>& nodes, std::vector<char> senderMoved)
      : particles_(p),
        moved_(scene.primitives.size(), 0),
        senderMoved_(std::move(senderMoved)),
        after_(shapesOf(scene, moved), kMargin * farDistance(scene)) {
    const double margin = kMargin * farDistance(scene);
    Box before;
    for (const SceneChange::Moved& m : moved) {
      moved_[m.primitive.index()] = 1;
      if (m.before.empty()) continue;
      before.extend(m.before);
      if (isThinGlass(scene.materialOf(m.primitive))) panes_.emplace_back(m.before, margin);
    }
    if (!before.empty()) before_.emplace(before, margin);
    for (const ParticleLink& l : p.links) receiver_.push_back(nodes[l.ends.receiver]);
  }

  bool touch(std::size_t path) const {
    const Motion receiver = receiver_[particles_.link[path]];
    if (receiver == Motion::Bound || senderMoved_[particles_.sender[path]]) return true;
    const std::span<const Vec3f> v = particles_.verticesOf(path);
    // What was never begun may be possible now.
    if (v.empty()) return receiver != Motion::None;
    const PrimitiveId* met = particles_.metBy(path).data();
    const bool blocked = particles_.fate[path] == 0 && met[1].valid();
    if (blocked) return moved_[met[1].index()] || (receiver != Motion::None && (before_ && before_->holds(v[1])));
    for (std::size_t i = 1; i < v.size(); ++i)
      if (met[i].valid() && moved_[met[i].index()]) return true;
    for (std::size_t i = 0; i + 1 < v.size(); ++i)
      if (after_.near(v[i], v[i + 1]) && after_.meets(v[i], v[i + 1])) return true;
    return std::any_of(panes_.begin(), panes_.end(), [&](const SegmentBox& box) { return box.meets(v[0], v[1]); });
  }

 private:
  static std::vector<const Shape*> shapesOf(const Scene& scene, std::span<const SceneChange::Moved> moved) {
    std::vector<PrimitiveId> ids;
    for (const SceneChange::Moved& m : moved) ids.push_back(m.primitive);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::vector<const Shape*> shapes;
    for (const PrimitiveId id : ids) shapes.push_back(&scene[id].shape);
    return shapes;
  }

  const Particles& particles_;
  std::vector<char> moved_;        // by primitive
  std::vector<char> senderMoved_;  // by cell
  std::vector<Motion> receiver_;   // by link
  MovedShapes after_;
  std::optional<SegmentBox> before_;  // all of it
  std::vector<SegmentBox> panes_;     // where they were
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
  std::vector<char> senderMoved = ends_->senders.follow(primitives);
  const std::vector<Receivers::Motion> nodes = ends_->receivers.follow(primitives);
  const Motions motions(scene_, moved, p, nodes, std::move(senderMoved));
  constexpr std::size_t kBlock = 8192;
  std::vector<std::vector<std::uint32_t>> found((p.paths() + kBlock - 1) / kBlock);
  parallelBlocks(p.paths(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t path = begin; path < end; ++path)
      if (motions.touch(path)) found[begin / kBlock].push_back(static_cast<std::uint32_t>(path));
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
