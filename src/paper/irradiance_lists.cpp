#include "paper/irradiance_lists.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/parallel.hpp"
#include "paper/gather.hpp"
#include "paper/push_pull.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::paper {

namespace {

using hierarchy::DirectionalRgb;
using hierarchy::ElementId;
using hierarchy::Elements;
using hierarchy::Link;
using hierarchy::LinkId;
using hierarchy::Links;

/// visit(id) of a link and of all below it.
template <class Visit>
void forSubtree(const Links& links, LinkId top, const Visit& visit) {
  std::vector<LinkId> open{top};
  while (!open.empty()) {
    const LinkId id = open.back();
    open.pop_back();
    visit(id);
    for (std::size_t c = 0; c < links[id].childCount; ++c) open.push_back(links.child(id, c));
  }
}

/// Area that light can reach.
double receivingArea(const Elements& elements) {
  double area = 0;
  for (const ElementId e : elements.inputs)
    if (elements.receives(e)) area += elements.shape(e).litArea();
  return area;
}

/// Whether light falls through it on the other side, whose change does not mark it.
bool isTranslucent(const Elements& elements, std::size_t i) { return !isBlack(elements.radiometry[i].tau); }

/// Writes the particles' irradiance, and marks leaves where it is another.
void placeParticles(const Parts& x, const particles::ParticleTransfer& onMesh, std::vector<char>& marked) {
  std::vector<Rgb> before(x.elements.size());
  for (std::size_t i = 0; i < before.size(); ++i) before[i] = x.elements.radiometry[i].particle;
  onMesh.apply(x.elements, scene::scalesOf(x.scene));
  for (std::size_t i = 0; i < before.size(); ++i)
    if (x.elements.radiometry[i].particle != before[i]) marked[i] = 1;
}

void require(bool holds, std::size_t element) {
  if (!holds)
    throw std::logic_error("irradiance lists: element " + std::to_string(element) +
                           " has gathered something else than its links bring");
}

}  // namespace

/// Links that bring light, by sender; those of one in their order.
class IrradianceLists::Outgoing {
 public:
  Outgoing(const Links& links, std::size_t elements) : first_(elements + 1, 0) {
    for (const Link& l : links.all)
      if (bringsLight(l)) ++first_[l.sender.index() + 1];
    for (std::size_t e = 0; e < elements; ++e) first_[e + 1] += first_[e];
    links_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < links.size(); ++i)
      if (bringsLight(links.all[i])) links_[next[links.all[i].sender.index()]++] = LinkId(i);
  }
  std::span<const LinkId> of(ElementId sender) const {
    return std::span(links_).subspan(first_[sender.index()], first_[sender.index() + 1] - first_[sender.index()]);
  }

 private:
  std::vector<std::uint32_t> first_;  // by element
  std::vector<LinkId> links_;
};

IrradianceLists::IrradianceLists(const Elements& elements) {
  follow(elements);
  placed_ = elements.size();
}

/// New elements send what they have from the ones that were split.
void IrradianceLists::follow(const Elements& elements) {
  for (std::size_t i = B_.size(); i < elements.size(); ++i) {
    B_.push_back(elements.radiometry[i].B);
    center_.push_back(elements.geometry[i].center);
  }
  for (std::size_t slot = intensity_.size(); slot < elements.clusters.size(); ++slot)
    intensity_.push_back(elements.clusters[slot].intensity);
}

Rgb IrradianceLists::propagated(const Elements& elements, ElementId sender, const Vec3f& w) const {
  return elements.isCluster(sender) ? intensity_[elements.slot[sender.index()]].at(-w) : B_[sender.index()];
}

/// `sent(w)`: of the sender, towards -w.
template <class Sent>
IrradianceLists::Operation IrradianceLists::brought(const Elements& elements, const Link& l, const Sent& sent) const {
  Operation o;
  o.receiver = l.receiver, o.direct = elements.at(l.sender).emitter;
  const Vec3f &r = center_[l.receiver.index()], &s = center_[l.sender.index()];
  if (elements.isCluster(l.receiver) || elements.isCluster(l.sender))
    o.w = elements.isDistant(l.sender) ? s : glm::normalize(s - r);
  o.E = l.K * l.V * sent(o.w);  // E += K V B [GD01 2.1]
  return o;
}

void IrradianceLists::list(const Elements& elements, const Link& l, float sign) {
  if (!bringsLight(l)) return;
  operations_.push_back(brought(elements, l, [&](const Vec3f& w) { return propagated(elements, l.sender, w); }));
  operations_.back().E *= sign;
}

void IrradianceLists::takeOut(const Elements& elements, const Links& links, LinkId id) {
  if (removed_[id.index()]) return;
  removed_.at(id.index()) = 1;
  list(elements, links[id], -1.0f);
}

void IrradianceLists::remove(const Elements& elements, const Links& links, const LinkMarks& marks) {
  follow(elements);
  removed_ = PagedArray<char>(links.size());
  const auto takeOutMarked = [&](LinkId id) {
    if (links[id].state == hierarchy::LinkState::Interior || removed_[id.index()]) return;
    takeOut(elements, links, id);
    again_.push_back(id);
  };
  for (const DisturbedLink& d : marks.between) takeOutMarked(d.link);
  for (const LinkId id : marks.moved) takeOutMarked(id);
  for (const LinkId id : marks.shifted) takeOutMarked(id);
  again_.insert(again_.end(), marks.made.begin(), marks.made.end());
}

void IrradianceLists::removeBelow(const Elements& elements, const Links& links, LinkId id) {
  forSubtree(links, id, [&](LinkId below) {
    if (below == id || below.index() >= removed_.size()) return;
    takeOut(elements, links, below);
    removed_.at(below.index()) = 2;  // and gone: its id may come to name another link
  });
  again_.push_back(id);
}

void IrradianceLists::add(const Elements& elements, const Links& links) {
  follow(elements);
  for (std::size_t i = 0; i < center_.size(); ++i) center_[i] = elements.geometry[i].center;
  for (const LinkId top : again_)
    if (removed_[top.index()] != 2) forSubtree(links, top, [&](LinkId id) { list(elements, links[id], 1.0f); });
  again_.clear();
  removed_ = {};
}

/// Performs what is listed in place, at the receivers, and marks these. [GD01 5]
void IrradianceLists::apply(Elements& elements, std::vector<char>& marked) {
  for (const Operation& o : operations_) {
    marked[o.receiver.index()] = 1;
    if (elements.isCluster(o.receiver)) {
      hierarchy::ClusterLight& c = elements.cluster(o.receiver);
      (o.direct ? c.directGathered : c.indirectGathered).addLobe(o.w, o.E);
    } else {
      hierarchy::ElementLight& l = elements.radiometry[o.receiver.index()];
      Rgb& E = o.direct ? l.directGathered : l.indirectGathered;
      E = glm::max(E + o.E, Rgb(0.0f));
    }
  }
  operations_.clear();
}

/// Whether an element sends something else than it last propagated, by more than a radiosity [W/m2].
bool IrradianceLists::differs(const Elements& elements, std::size_t i, double threshold) const {
  const ElementId e(i);
  if (!elements.isCluster(e)) {
    const bool surface = elements.isPatch(e);  // of other senders, which edits change alone, all counts
    return gray(glm::abs(elements.radiometry[i].B - B_[i])) > (surface ? threshold : 0.0);
  }
  const DirectionalRgb &now = elements.cluster(e).intensity, &then = intensity_[elements.slot[i]];
  const double intensity = threshold * elements.shape(e).area / kPi / hierarchy::kConstantHarmonic;
  for (int k = 0; k < hierarchy::kHarmonics; ++k)
    if (gray(glm::abs(now.c[k] - then.c[k])) > intensity) return true;
  return false;
}

/// Lists what changes over the links of these senders.
void IrradianceLists::propagate(const Elements& elements, const Links& links, const Outgoing& outgoing,
                                std::span<const ElementId> senders) {
  constexpr std::size_t kBlock = 32;  // [task]
  std::vector<std::vector<Operation>> blocks((senders.size() + kBlock - 1) / kBlock);
  parallelFor(senders.size(), kBlock, [&](std::size_t i) {
    const ElementId s = senders[i];
    const auto difference = [&](const Vec3f& w) {
      const Rgb now = elements.isCluster(s) ? elements.cluster(s).intensity.at(-w) : elements.radiometry[s.index()].B;
      return now - propagated(elements, s, w);
    };
    for (const LinkId id : outgoing.of(s)) blocks[i / kBlock].push_back(brought(elements, links[id], difference));
  });
  for (const auto& block : blocks) operations_.insert(operations_.end(), block.begin(), block.end());
  for (const ElementId s : senders) {
    B_[s.index()] = elements.radiometry[s.index()].B;
    if (elements.isCluster(s)) intensity_[elements.slot[s.index()]] = elements.cluster(s).intensity;
  }
}

/// Power of leaves that is not propagated.
RgbSum IrradianceLists::pendingPower(const Elements& elements) const {
  RgbSum sum(0.0);
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements.isReceivingLeaf(ElementId(i)))
      sum += double(elements.geometry[i].litArea()) * RgbSum(glm::abs(elements.radiometry[i].B - B_[i]));
  return sum;
}

IterationReport IrradianceLists::iterate(const Parts& x, const particles::ParticleTransfer& onMesh,
                                         std::span<const ElementId> changed, double converged) {
  follow(x.elements);
  std::vector<char> marked(x.elements.size(), 0);
  for (const ElementId e : changed) marked[e.index()] = 1;
  std::fill(marked.begin() + static_cast<std::ptrdiff_t>(placed_), marked.end(), 1);
  placed_ = marked.size();
  std::vector<std::uint32_t> translucent;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (isTranslucent(x.elements, i)) translucent.push_back(static_cast<std::uint32_t>(i));

  const double area = receivingArea(x.elements);
  std::optional<Outgoing> outgoing;
  std::vector<ElementId> senders;
  IterationReport s;
  while (s.iterations < kMaxIterations) {
    apply(x.elements, marked);
    placeParticles(x, onMesh, marked);
    for (const std::uint32_t i : translucent) marked[i] = 1;
    pushPull(x.elements, marked);
    s.emitted = directPower(x.elements);
    const double threshold = area > 0 ? converged * gray(s.emitted) / area : 0.0;
    senders.clear();
    for (std::size_t i = 0; i < marked.size(); ++i)
      if ((marked[i] || s.iterations == 0) && differs(x.elements, i, threshold)) senders.emplace_back(i);
    ++s.iterations;
    s.whole = senders.empty();
    if (s.whole) break;
    if (!outgoing) outgoing.emplace(x.links, x.elements.size());
    propagate(x.elements, x.links, *outgoing, senders);
    std::fill(marked.begin(), marked.end(), 0);
  }
  s.residual = pendingPower(x.elements);
  return s;
}

std::size_t IrradianceLists::memoryBytes() const {
  return B_.capacity() * sizeof B_[0] + center_.capacity() * sizeof center_[0] +
         intensity_.capacity() * sizeof intensity_[0] + operations_.capacity() * sizeof operations_[0];
}

void IrradianceLists::validate(const Elements& elements, const Links& links) const {
  constexpr float kRounding = 1e-3f;  // of the largest that any element gathers [rounding]
  std::vector<Rgb> direct(elements.size(), Rgb(0.0f)), indirect = direct;
  std::vector<hierarchy::ClusterLight> clusters(elements.clusters.size());
  float most = 0;
  for (const Link& l : links.all) {
    if (!bringsLight(l)) continue;
    const Operation o = brought(elements, l, [&](const Vec3f& w) { return propagated(elements, l.sender, w); });
    if (!elements.isCluster(o.receiver)) {
      Rgb& E = (o.direct ? direct : indirect)[o.receiver.index()];
      E += o.E, most = std::max(most, maxChannel(E));
    } else {
      hierarchy::ClusterLight& c = clusters[elements.slot[o.receiver.index()]];
      (o.direct ? c.directGathered : c.indirectGathered).addLobe(o.w, o.E);
    }
  }
  const auto near = [&](const Rgb& a, const Rgb& b) { return maxChannel(glm::abs(a - b)) <= kRounding * most; };
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isCluster(ElementId(i))) {
      const hierarchy::ElementLight& l = elements.radiometry[i];
      require(near(l.directGathered, direct[i]) && near(l.indirectGathered, indirect[i]), i);
      continue;
    }
    const hierarchy::ClusterLight &is = elements.clusters[elements.slot[i]], &as = clusters[elements.slot[i]];
    for (int k = 0; k < hierarchy::kHarmonics; ++k)
      require(near(is.directGathered.c[k], as.directGathered.c[k]) &&
                  near(is.indirectGathered.c[k], as.indirectGathered.c[k]),
              i);
  }
}

}  // namespace deltalux::paper
