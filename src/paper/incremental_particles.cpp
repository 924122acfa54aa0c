#include "paper/incremental_particles.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/sort_unique.hpp"

namespace deltalux::paper {

namespace {

using particles::Particles;
using particles::RetracedPath;
using Motion = particles::Receivers::Motion;

/// Links that lead to what moved, and those with paths that were never begun and may be possible now.
std::vector<std::uint32_t> linksOfEnds(const Particles& p, const particles::ParticleTracing::MovedEnds& ends) {
  std::vector<std::uint32_t> links;
  for (std::uint32_t l = 0; l < p.links.size(); ++l) {
    const particles::ParticleLink& link = p.links[l];
    const Motion receiver = ends.receivers[link.ends.receiver];
    bool affected = receiver == Motion::Bound;
    for (std::size_t path = link.firstPath; !affected && path < link.firstPath + std::size_t(link.paths); ++path)
      affected = p.verticesOf(path).empty() && (receiver != Motion::None || ends.senders[p.sender[path]]);
    if (affected) links.push_back(l);
  }
  return links;
}

template <class T>
bool sameEntries(const T& array, std::uint32_t a, std::uint32_t b, std::size_t count) {
  const auto at = [&](std::uint32_t i) { return array.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::equal(at(a), at(a) + static_cast<std::ptrdiff_t>(count), at(b));
}

/// Whether a path is what it was before it was traced again.
bool sameAsBefore(const Particles& p, const RetracedPath& r) {
  const particles::PathRange &now = p.range[r.path], &was = r.range;
  if (now.vertices != was.vertices || now.impacts != was.impacts || p.sender[r.path] != r.sender ||
      p.originTriangle[r.path] != r.originTriangle)
    return false;
  const auto same = [&](const auto&... arrays) {
    return (sameEntries(arrays, now.impact, was.impact, now.impacts) && ...);
  };
  return sameEntries(p.vertices, now.vertex, was.vertex, now.vertices) &&
         sameEntries(p.met, now.vertex, was.vertex, now.vertices) &&
         same(p.primitive, p.triangleAndSide, p.uv, p.throughput);
}

/// Moves `count` entries to the front, to `to`.
template <class... Arrays>
void moveEntries(std::uint32_t from, std::uint32_t to, std::size_t count, Arrays&... arrays) {
  const auto move = [&](auto& array) {
    const auto begin = array.begin() + static_cast<std::ptrdiff_t>(from);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(count), array.begin() + static_cast<std::ptrdiff_t>(to));
  };
  (move(arrays), ...);
}

/// Paths that came out as they were keep their place, and leave the update; the others close up behind `vertex` and
/// `impact`, from where on all were put.
void keepUnchanged(Particles& p, particles::ParticleUpdate& update, std::uint32_t vertex, std::uint32_t impact) {
  std::vector<RetracedPath> changed;
  for (const RetracedPath& r : update.paths) {
    particles::PathRange& now = p.range[r.path];
    if (sameAsBefore(p, r)) {
      now = r.range;
      continue;
    }
    moveEntries(now.vertex, vertex, now.vertices, p.vertices, p.met);
    moveEntries(now.impact, impact, now.impacts, p.primitive, p.triangleAndSide, p.uv, p.throughput);
    now.vertex = vertex, now.impact = impact;
    vertex += now.vertices, impact += now.impacts;
    changed.push_back(r);
  }
  p.vertices.resize(vertex), p.met.resize(vertex);
  p.primitive.resize(impact), p.triangleAndSide.resize(impact), p.uv.resize(impact), p.throughput.resize(impact);
  update.paths = std::move(changed);
}

Box around(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& b : boxes)
    if (!b.empty()) all.extend(b);
  return all;
}

}  // namespace

void IncrementalParticles::select(const Particles& p, std::span<const PrimitiveId> object) {
  std::vector<PrimitiveId> sorted(object.begin(), object.end());
  sortUnique(sorted);
  if (octree_ && sorted == object_) return;
  Boxes boxes;
  for (const PrimitiveId id : sorted) boxes.push_back(bounds(scene_[id].shape));
  object_ = std::move(sorted);
  grow(p, boxes, {});
}

/// Makes the octree around the object, with room for more.
void IncrementalParticles::grow(const Particles& p, const Boxes& object, const Boxes& more) {
  Box all = bounds(scene_);
  if (const Box box = around(more); !box.empty()) all.extend(box);
  octree_.emplace(p, all, object, tracing_.margin());
}

particles::ParticleUpdate IncrementalParticles::follow(Particles& p, const SceneChange& change, double share) {
  if (!tracing_.looksAsBefore(change)) {
    octree_.reset(), queue_.clear();
    return tracing_.traceAnew(p);
  }
  if (p.paths() == 0) return {};
  if (!change.moved.empty()) collect(p, change.moved);
  return emit(p, queue_.take(share));
}

/// Links of cells that the object has come into, left, or moved in, and of ends that moved: they wait from now on.
void IncrementalParticles::collect(const Particles& p, const std::vector<SceneChange::Moved>& moved) {
  std::vector<PrimitiveId> primitives;
  Boxes before, now;
  for (const SceneChange::Moved& m : moved) {
    primitives.push_back(m.primitive);
    before.push_back(m.before), now.push_back(bounds(scene_[m.primitive].shape));
  }
  sortUnique(primitives);
  if (!octree_ || primitives != object_) {
    object_ = primitives;
    grow(p, around(before).empty() ? now : before, now);
  }
  OctreeChange change;
  if (!octree_->hold(p, now, change)) {
    grow(p, before, now);
    octree_->hold(p, now, change);
  }
  queue_.add(change.links);
  queue_.add(linksOfEnds(p, tracing_.moveEnds(p, primitives)));
}

/// All particles of these links are taken back and emitted again. [GD01 4.2]
particles::ParticleUpdate IncrementalParticles::emit(Particles& p, const std::vector<std::uint32_t>& links) {
  std::vector<std::uint32_t> paths;
  for (const std::uint32_t link : links)
    for (std::uint32_t i = 0; i < p.links[link].paths; ++i) paths.push_back(p.links[link].firstPath + i);
  const auto vertices = static_cast<std::uint32_t>(p.vertices.size()),
             impacts = static_cast<std::uint32_t>(p.impactSlots());
  particles::ParticleUpdate update = tracing_.retrace(p, paths);
  keepUnchanged(p, update, vertices, impacts);
  registerAgain(p, update.paths);
  return update;
}

/// Links with changed paths, in the cells that they cross now.
void IncrementalParticles::registerAgain(const Particles& p, const std::vector<RetracedPath>& changed) {
  if (!octree_) return;
  std::vector<std::uint32_t> links;
  for (const RetracedPath& r : changed) {
    octree_->erase(p, p.link[r.path], std::span(p.vertices).subspan(r.range.vertex, r.range.vertices));
    links.push_back(p.link[r.path]);
  }
  sortUnique(links);
  for (const std::uint32_t link : links)
    for (std::uint32_t i = 0; i < p.links[link].paths; ++i)
      octree_->insert(p, link, p.verticesOf(p.links[link].firstPath + std::size_t(i)));
  DELTALUX_VALIDATED(octree_->validate(p));
}

}  // namespace deltalux::paper
