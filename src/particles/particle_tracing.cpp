#include "particles/particle_tracing.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <optional>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/sort_unique.hpp"
#include "particles/flux_estimate.hpp"
#include "particles/moved_shapes.hpp"
#include "particles/plan_particles.hpp"
#include "particles/trace.hpp"

namespace deltalux::particles {

namespace {

constexpr double kMargin =
    1e-5;  // of the far distance: rays start and end a little off the points they join [rounding]

/// Whether a change from one to the other leaves all particles as they are.
bool emitAlike(const Material& a, const Material& b) {
  const auto sendAlike = [&](bool front) {
    return isBlack(diffuseReflectance(a, front)) == isBlack(diffuseReflectance(b, front));
  };
  if (a.emission != b.emission || a.surface.index() != b.surface.index()) return false;
  if (a.coverage != b.coverage || a.filter != b.filter) return false;
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
          const std::vector<Motion>& nodes, const std::vector<char>& senderMoved)
      : particles_(p),
        nodes_(nodes),
        senderMoved_(senderMoved),
        moved_(scene.primitives.size(), 0),
        after_(shapesOf(scene, moved), kMargin * farDistance(scene)) {
    const double margin = kMargin * farDistance(scene);
    Box before;
    for (const SceneChange::Moved& m : moved) {
      moved_[m.primitive.index()] = 1;
      if (m.before.empty()) continue;
      before.extend(m.before);
      if (passesStraight(scene.materialOf(m.primitive))) panes_.emplace_back(m.before, margin);
    }
    if (!before.empty()) before_.emplace(before, margin);
  }

  /// Whether all paths of the link are touched.
  bool touchesAll(const ParticleLink& link) const { return nodes_[link.ends.receiver] == Motion::Bound; }
  bool touch(std::size_t path) const {
    const Motion receiver = nodes_[particles_.links[particles_.link[path]].ends.receiver];
    if (receiver == Motion::Bound || senderMoved_[particles_.sender[path]]) return true;
    const std::span<const Vec3f> v = particles_.verticesOf(path);
    // What was never begun may be possible now.
    if (v.empty()) return receiver != Motion::None;
    const PrimitiveId* met = particles_.metBy(path).data();
    const bool blocked = particles_.termination[path] == 0 && met[1].valid();
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
    sortUnique(ids);
    std::vector<const Shape*> shapes;
    for (const PrimitiveId id : ids) shapes.push_back(&scene[id].shape);
    return shapes;
  }

  const Particles& particles_;
  const std::vector<Motion>& nodes_;      // of receivers
  const std::vector<char>& senderMoved_;  // by cell
  std::vector<char> moved_;               // by primitive
  MovedShapes after_;
  std::optional<SegmentBox> before_;  // all of it
  std::vector<SegmentBox> panes_;     // where they were
};

}  // namespace

ParticleTracing::Ends::Ends(const Scene& scene, const tracing::RayTracer& tracer)
    : lights(scene), senders(scene, lights), receivers(scene), emission(scene, tracer, senders, receivers) {}

ParticleTracing::Look::Look(const Scene& scene)
    : materials(scene.materials), lights(scene.lights), far(farDistance(scene)) {
  for (const Primitive& p : scene.primitives) materialOf.push_back(p.material);
}

ParticleTracing::ParticleTracing(const Scene& scene, const tracing::RayTracer& tracer, const ParticleSettings& settings)
    : scene_(scene), tracer_(tracer), settings_(settings), ends_(std::make_unique<Ends>(scene, tracer)), look_(scene) {}

Particles ParticleTracing::trace() { return trace(planParticles(scene_, tracer_, settings_)); }

Particles ParticleTracing::trace(const ParticlePlan& plan) {
  Particles p = counted(plan, settings_.count);
  if (p.paths() == 0) return p;
  weigh(p);
  tracePaths(scene_, tracer_, ends_->emission, settings_.maxDepth, p);
  return p;
}

Particles ParticleTracing::traceWithin(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const Clock::time_point start = Clock::now();
  const ParticlePlan plan = planParticles(scene_, tracer_, settings_);
  const std::uint64_t wanted = settings_.count;
  settings_.count = std::min<std::uint64_t>(wanted, kMostLooks);
  while (true) {
    const Clock::time_point tracing = Clock::now();
    Particles p = trace(plan);
    const double left = seconds - since(start), each = since(tracing) / static_cast<double>(settings_.count);
    const double affordable = std::min(left / std::max(each, 1e-12), static_cast<double>(wanted));
    const auto next = std::min(wanted, static_cast<std::uint64_t>(std::max(affordable, 0.0)));
    // Tracing anew for less than twice as many is not worth it.
    if (next < std::min(wanted, 2 * settings_.count) || settings_.count == wanted) return p;
    settings_.count = next;
  }
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
  if (look_.materialOf.size() != scene_.primitives.size() || look_.lights.size() != scene_.lights.size() ||
      look_.materials.size() != scene_.materials.size() || look_.far != farDistance(scene_))
    return false;
  const auto lightAsBefore = [&](LightId l) { return look_.lights[l.index()].emitter == scene_[l].emitter; };
  const auto materialAsBefore = [&](MaterialId m) { return emitAlike(look_.materials[m.index()], scene_[m]); };
  // A lamp that turns gets a material of its own, and its old one back.
  const auto surfacesAsBefore = [&] {
    for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
      const MaterialId before = look_.materialOf[i], now = scene_.primitives[i].material;
      if (before != now && !emitAlike(look_.materials[before.index()], scene_[now])) return false;
    }
    return true;
  };
  return std::all_of(change.lights.begin(), change.lights.end(), lightAsBefore) &&
         std::all_of(change.materials.begin(), change.materials.end(), materialAsBefore) &&
         (change.materials.empty() || surfacesAsBefore());
}

/// Watches a region around what moves, with room to move on.
void ParticleTracing::watch(const Particles& p, std::span<const SceneChange::Moved> moved) {
  Box all;
  bool covered = watch_.has_value();
  for (const SceneChange::Moved& m : moved) {
    const Box after = bounds(scene_[m.primitive].shape);
    for (const Box& box : {m.before, after}) {
      if (!box.empty()) all.extend(box);
      covered = covered && watch_->covers(box);
    }
  }
  if (!covered && !all.empty()) watchAround(p, all);
}

void ParticleTracing::watchAround(const Particles& p, const Box& box) {
  const double room = box.diagonal();
  watch_.emplace(p, Box{box.lower - room, box.upper + room}, margin());
}

double ParticleTracing::margin() const { return 2 * kMargin * farDistance(scene_); }

ParticleTracing::MovedEnds ParticleTracing::moveEnds(const Particles& p, std::span<const PrimitiveId> moved) {
  if (p.paths() > 0 && !weighed_) weigh(p);
  return {ends_->senders.follow(moved), ends_->receivers.follow(moved)};
}

void ParticleTracing::expectMotion(const Particles& p, const Box& ofObject) {
  if (p.paths() > 0 && !weighed_) weigh(p);
  if (!ofObject.empty() && !(watch_ && watch_->covers(ofObject))) watchAround(p, ofObject);
}

std::vector<std::uint32_t> ParticleTracing::touched(const Particles& p, std::span<const SceneChange::Moved> moved) {
  watch(p, moved);
  if (!watch_) return {};
  std::vector<PrimitiveId> primitives;
  for (const SceneChange::Moved& m : moved) primitives.push_back(m.primitive);
  const auto [senderMoved, nodes] = moveEnds(p, primitives);
  const Motions motions(scene_, moved, p, nodes, senderMoved);
  std::vector<std::uint32_t> paths;
  if (std::find(nodes.begin(), nodes.end(), Receivers::Motion::Bound) != nodes.end())
    for (const ParticleLink& l : p.links)
      if (motions.touchesAll(l))
        for (std::uint32_t path = l.firstPath; path < l.firstPath + l.paths; ++path) paths.push_back(path);

  const std::vector<std::uint64_t>& words = watch_->words();
  constexpr std::size_t kBlock = 128;  // [task]
  std::vector<std::vector<std::uint32_t>> found((words.size() + kBlock - 1) / kBlock);
  parallelFor(words.size(), kBlock, [&](std::size_t w) {
    for (std::uint64_t rest = words[w]; rest; rest &= rest - 1) {
      const std::size_t path = w * PathWatch::kPathsOfWord + static_cast<std::size_t>(std::countr_zero(rest));
      if (motions.touch(path)) found[w / kBlock].push_back(static_cast<std::uint32_t>(path));
    }
  });
  for (const auto& block : found) paths.insert(paths.end(), block.begin(), block.end());
  sortUnique(paths);
  return paths;
}

ParticleUpdate ParticleTracing::retrace(Particles& p, const std::vector<std::uint32_t>& paths) {
  ParticleUpdate update;
  update.paths.reserve(paths.size());
  std::vector<std::uint8_t> arrived;
  for (const std::uint32_t path : paths) {
    update.paths.push_back({path, p.sender[path], p.originTriangle[path], p.range[path]});
    arrived.push_back(p.termination[path] & kArrived);
  }
  const std::uint64_t before = p.rays;
  retracePaths(scene_, tracer_, ends_->emission, settings_.maxDepth, p, paths);
  update.rays = p.rays - before;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (arrived[i] || (p.termination[paths[i]] & kArrived)) ++update.particles;
  if (watch_) watch_->renew(p, paths);
  return update;
}

ParticleUpdate ParticleTracing::traceAnew(Particles& p) {
  ends_ = std::make_unique<Ends>(scene_, tracer_);
  look_ = Look(scene_);
  watch_.reset();
  p = trace();
  ParticleUpdate update;
  update.all = true, update.rays = p.rays + p.pilots, update.particles = p.arrived();
  return update;
}

ParticleUpdate ParticleTracing::follow(Particles& p, const SceneChange& change) {
  if (!looksAsBefore(change)) return traceAnew(p);
  if (p.paths() == 0 || change.moved.empty()) return {};
  if (!weighed_) weigh(p);
  return retrace(p, touched(p, change.moved));
}

Particles traceParticles(const Scene& scene, const tracing::RayTracer& tracer, const ParticleSettings& settings) {
  return ParticleTracing(scene, tracer, settings).trace();
}

}  // namespace deltalux::particles
