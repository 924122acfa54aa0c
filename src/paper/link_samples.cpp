#include "paper/link_samples.hpp"

#include <algorithm>
#include <optional>

#include "base/random.hpp"
#include "hierarchy/direction_window.hpp"
#include "hierarchy/outline.hpp"
#include "paper/kernel.hpp"

namespace deltalux::paper {

namespace {

/// Of what is not negative.
double fraction(double x) { return x - static_cast<double>(static_cast<std::int64_t>(x)); }

/// The child that holds the share `a` of the area, in [0,1); `a` is used up in part. Invalid when nothing has area.
hierarchy::ElementId childByArea(const hierarchy::Elements& elements, hierarchy::ElementId e, double& a) {
  double rest = a * elements.shape(e).area;
  hierarchy::ElementId picked;
  double part = 0;
  for (std::size_t i = 0; i < elements.at(e).childCount; ++i) {
    const hierarchy::ElementId c = elements.child(e, i);
    const double area = elements.at(c).blocker ? 0.0 : double(elements.shape(c).area);
    if (area <= 0) continue;
    picked = c, part = area;
    if (rest < area) break;
    rest -= area;
  }
  if (picked.valid()) a = std::clamp(rest / part, 0.0, 0x1.fffffep-1);
  return picked;
}

}  // namespace

Stratified4::Stratified4(std::uint64_t key) {
  for (std::size_t k = 0; k < 4; ++k) start_[k] = toUnit(mix64(key + k));
}

std::array<double, 4> Stratified4::operator[](int i) const {
  static constexpr std::array<double, 4> step = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                                 0.5385972572236101};
  std::array<double, 4> u;
  for (std::size_t k = 0; k < 4; ++k) u[k] = fraction(start_[k] + (i + 1) * step[k]);
  return u;
}

ElementPoints::ElementPoints(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId e)
    : elements_(elements), scene_(scene), element_(e), domain_(&elements.domain[e.index()]) {
  const hierarchy::ElementTopology& t = elements.at(e);
  if (t.kind != hierarchy::ElementKind::Patch || !t.flat || !(elements.shape(e).area > 0)) return;
  du_ = domain_->u1 - domain_->u0, dv_ = domain_->v1 - domain_->v0;
  if (!hierarchy::outlineFills(elements.outline(e), du_ * dv_)) return;
  frame_ = &elements.frames[domain_->frame];
  normal_ = Vec3f(t.front ? frame_->normal : -frame_->normal);
}

hierarchy::PatchPoint ElementPoints::onAny(double a, double b) const {
  hierarchy::ElementId e = element_;
  while (elements_.isCluster(e)) {
    const hierarchy::ElementId next = childByArea(elements_, e, a);
    if (!next.valid()) break;
    e = next;
  }
  // What was removed keeps its elements, but has no surface.
  if (elements_.isPatch(e) && elements_.shape(e).area > 0) return hierarchy::samplePatch(elements_, scene_, e, a, b);
  return {elements_.shape(e).center, Vec3f(0.0f)};
}

LinkSamples::LinkSamples(const hierarchy::Elements& elements, const Scene& scene, hierarchy::ElementId receiver,
                         hierarchy::ElementId sender)
    : elements_(elements),
      scene_(scene),
      receiver_(receiver),
      sender_(sender),
      sequence_(combineKeys(elements.key[receiver.index()], elements.key[sender.index()])),
      from_(elements, scene, receiver),
      to_(elements, scene, sender) {}

LinkSample LinkSamples::at(const std::array<double, 4>& u) const {
  const hierarchy::PatchPoint x = from_.at(u[0], u[1]);
  LinkSample s;
  s.quadrant = (u[0] < 0.5 ? 0u : 1u) + (u[1] < 0.5 ? 0u : 2u);
  if (elements_.isDistant(sender_)) {
    const Vec3f w = hierarchy::directionOf(elements_, scene_, sender_, u[2], u[3]);
    s.weight = pointKernel(elements_, scene_, x.position, x.normal, sender_, w, Vec3f(0.0f));
    s.ray.origin = tracing::offsetOrigin(x.position, x.normal, w);
    s.ray.direction = w;
    return s;
  }
  const hierarchy::PatchPoint y = to_.at(u[2], u[3]);
  s.weight = elements_.isPoint(sender_) || elements_.isPatch(sender_)
                 ? pointKernel(elements_, scene_, x.position, x.normal, sender_, y.position, y.normal)
                 : std::max(0.0f, glm::dot(x.normal, y.position - x.position)) *
                       std::max(0.0f, glm::dot(y.normal, x.position - y.position));
  if (elements_.isCluster(sender_)) {
    const Vec3f between = y.position - x.position;
    const double squared = glm::dot(between, between);
    s.weight = squared > 0 ? s.weight / (squared * squared) : 0.0;
  }
  if (s.weight > 0) s.ray = tracing::segment(x.position, x.normal, y.position, y.normal);
  return s;
}

/// Whether the ray of a sample, by its numbers, may meet something moving: told by what its points are on, down from
/// the ends of the link.
bool LinkSamples::mayMeet(std::array<double, 4> u, const SpaceChange& space) const {
  hierarchy::ElementId receiver = receiver_, sender = sender_;
  const bool distant = elements_.isDistant(sender);
  const Vec3f w = distant ? hierarchy::directionOf(elements_, scene_, sender, u[2], u[3]) : Vec3f(0.0f);
  for (;;) {
    const hierarchy::ElementGeometry &r = elements_.shape(receiver), &s = elements_.shape(sender);
    if (distant ? !space.meetsBeam(r, w, 0.0f) : !space.meets(r.center, r.radius, s.center, s.radius)) return false;
    const bool split = elements_.isCluster(receiver), other = elements_.isCluster(sender);
    if (!split && !other) return true;
    const bool atReceiver = split && (!other || r.radius >= s.radius);
    hierarchy::ElementId& end = atReceiver ? receiver : sender;
    end = childByArea(elements_, end, atReceiver ? u[0] : u[2]);
    if (!end.valid()) return true;
  }
}

std::uint32_t LinkSamples::meeting(int count, std::uint32_t passed, const SpaceChange& all,
                                   const SpaceChange& before) const {
  const hierarchy::ElementGeometry &r = elements_.shape(receiver_), &s = elements_.shape(sender_);
  const bool clusters = elements_.isCluster(receiver_) || elements_.isCluster(sender_);
  std::optional<hierarchy::DirectionWindow> window;
  if (elements_.isDistant(sender_)) {
    Vec3 axis;
    if (const auto angle = all.seenFrom(r.center, r.radius, axis))
      window.emplace(elements_, scene_, sender_, axis, *angle);
  } else if (!clusters && !all.meets(r.center, r.radius, s.center, s.radius)) {
    return 0;
  }
  std::uint32_t met = 0;
  for (int i = 0; i < count; ++i) {
    const auto u = sequence_[i];
    if (window && !window->holds(u[2], u[3])) continue;
    const SpaceChange& space = passed >> i & 1u ? all : before;
    if (space.empty() || (clusters && !mayMeet(u, space))) continue;
    const LinkSample sample = at(u);
    if (sample.weight > 0 && space.meets(sample.ray)) met |= 1u << i;
  }
  return met;
}

}  // namespace deltalux::paper
